// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_imager.hpp>

#include <glidar/sensor/optics/sub_pixels.hpp>

#include <variant>

namespace glidar {

PreparedImager prepare_imager(const Sensor& sensor, const ImagerSetup& setup) {
  const auto& pinhole = std::get<Pinhole>(sensor.optics);
  return {.setup = setup,
          .size = {pinhole.intrinsics.width, pinhole.intrinsics.height},
          .wavelength_m = sensor.wavelength_m,
          .rays = make_beams(divide_pixels(pinhole, setup.sub_rays)),
          .weights = point_spread_weights(setup.sub_rays, setup.imager.blur_px),
          .electron_rate =
              electron_rate_per_radiance(setup.imager, pinhole.intrinsics.fx, sensor.wavelength_m)};
}

}  // namespace glidar
