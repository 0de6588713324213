// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

#include <vector>

namespace glidar {

/// The raw images of all patterns, "pattern_00", "pattern_01" ...: the surfaces and shadows are
/// cast once, and again for each image only where something moves between the images. The exposure
/// is that of the pixels that the projector lights, in its greatest light and at the time of the
/// first pattern.
std::vector<RawImage> take_pattern_images(const Simulation& s,
                                          const PreparedStructuredLight& prepared);

}  // namespace glidar
