// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/sub_pixels.hpp>

namespace glidar {

Pinhole divide_pixels(const Pinhole& camera, std::uint32_t sub_rays) {
  const PinholeIntrinsics& pixel = camera.intrinsics;
  const double n = sub_rays;
  return {{.width = pixel.width * sub_rays,
           .height = pixel.height * sub_rays,
           .fx = pixel.fx * n,
           .fy = pixel.fy * n,
           .cx = (pixel.cx - pixel.pixel_centre + 0.5) * n,
           .cy = (pixel.cy - pixel.pixel_centre + 0.5) * n,
           .pixel_centre = 0.5},
          camera.distortion};
}

}  // namespace glidar
