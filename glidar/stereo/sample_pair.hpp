// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/grey_image.hpp>

#include <cstdint>

namespace glidar {

/// A rectified pair.
struct StereoPair {
  GreyImage left;
  GreyImage right;
};

inline constexpr std::uint32_t kSampleFar_px = 12;   ///< disparity of the plane
inline constexpr std::uint32_t kSampleNear_px = 36;  ///< disparity of the disc before it

/// A generated pair of 320x200 pixels, to try the matcher: random dots on a plane and on a disc
/// before it, and on the plane a patch without dots and a saturated one. Every call returns the
/// same pair.
StereoPair sample_stereo_pair();

}  // namespace glidar
