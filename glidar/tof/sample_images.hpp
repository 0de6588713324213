// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/tof/tof_decode.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// Raw images with what is known about their pixels.
struct TofSample {
  TofImages images;
  TofOptions options;
  std::vector<float> depth_per_range;
  std::vector<std::uint8_t> is_illuminated;
};

/// Generated raw images of a Kinect v2 of 160x120 pixels, to try the decoder: a tilted wall, partly
/// beyond the depth limit, a disc before it, a dark and a retroreflecting patch, and corners that
/// the illuminator does not light. Every call returns the same images.
TofSample sample_tof_images();

}  // namespace glidar
