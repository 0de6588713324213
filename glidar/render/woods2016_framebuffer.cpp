// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/woods2016_framebuffer.hpp>

#include <limits>

namespace glidar {

void decode(const Woods2016Framebuffer& picture, const Beams& beams, BeamRange range,
            std::vector<double>& range_m, std::vector<float>& intensity) {
  constexpr double kByteSteps = 65536.0;
  const double step_m = (picture.far_m - picture.near_m) / kByteSteps;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::uint8_t* rgba = &picture.rgba[4 * i];
    if (rgba[3] == 0) {
      range_m[i] = std::numeric_limits<double>::quiet_NaN();
      intensity[i] = 0.0F;
      continue;
    }
    // Equations (6) to (8) backwards. They round D down, so that the middle of its step is the best
    // guess.
    const double steps = 256.0 * rgba[1] + rgba[2] + 0.5;
    const double depth = picture.near_m + steps * step_m;
    range_m[i] = depth / beams.directions[i].z();
    intensity[i] = static_cast<float>(rgba[0]) / 255.0F;
  }
}

}  // namespace glidar
