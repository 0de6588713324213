// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/light.hpp>

namespace glidar {

/// Throws Error unless the attenuation is finite, not negative and not all zero.
void validate(const Light& light);

/// Fills a range of frame.intensity from frame.truth by the paper's equations (3) to (5) with h of
/// (2), for the beams whose status is hit; 0 elsewhere. Needs cos_shading and reflectance in
/// frame.truth.
void measure_intensity(const Light& light, BeamRange range, Frame& frame);

}  // namespace glidar
