// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/sub_pixels.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

#include <string>

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
          camera.distortion,
          camera.skew_px * n};
}

void check_sub_rays(const PinholeIntrinsics& image, std::uint32_t sub_rays) {
  constexpr double kMaxRays = 0x1p25;  // a few GiB with what they hit
  const double rays = static_cast<double>(image.width) * image.height * sub_rays * sub_rays;
  if (rays <= kMaxRays) return;
  throw Error({.where = "depth_camera",
               .found = "sub_rays is " + std::to_string(sub_rays) + ", so that " +
                        std::to_string(image.width) + "x" + std::to_string(image.height) +
                        " pixels have too many rays",
               .allowed = "at most " + number_text(kMaxRays) + " rays",
               .remedy = "use fewer sub_rays or pixels"});
}

}  // namespace glidar
