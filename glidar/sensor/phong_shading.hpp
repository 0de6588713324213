// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/phong_headlight.hpp>

namespace glidar {

/// Throws Error unless the attenuation coefficients are finite, non-negative and not all zero.
void validate(const PhongHeadlight& light);

/// Fills a range of frame.intensity from frame.ground_truth by equations (3) to (5) of the 2016
/// paper with h of (2), for beams whose status is hit; 0 elsewhere. Requires cos_shading and
/// reflectance in frame.ground_truth.
void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame);

}  // namespace glidar
