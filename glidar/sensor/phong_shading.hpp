// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/phong_headlight.hpp>

namespace glidar {

/// Throws Error unless the attenuation is finite, not negative and not all zero.
void validate(const PhongHeadlight& light);

/// Fills a range of frame.intensity from frame.ground_truth by the paper's equations (3) to (5)
/// with h of (2), for the beams whose status is hit; 0 elsewhere. Needs cos_shading and reflectance
/// in frame.ground_truth.
void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame);

}  // namespace glidar
