// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_structured_light.hpp>

#include <variant>

namespace glidar {

PreparedStructuredLight prepare_structured_light(const StructuredLightCamera& camera,
                                                 const Sensor& sensor) {
  const Pose camera_from_projector = camera.projector_from_camera.inverse();
  PreparedStructuredLight prepared{
      .camera = camera,
      .setup = setup_of(camera, std::get<Pinhole>(sensor.optics)),
      .imager = prepare_imager(sensor, {camera.imager, camera.illumination, camera.sub_rays}),
      .projection = PinholeProjection(camera.projector),
      .projector_m = camera_from_projector.translation(),
      .white_w_per_sr = white_intensity_w_per_sr(camera.projector, camera.light.power_w),
      .lines = {}};
  for (std::size_t i = 0; i < image_count(camera.patterns); ++i) {
    prepared.lines.push_back(projected_line(camera.patterns, camera.light, i));
  }
  return prepared;
}

std::optional<Eigen::Vector2d> projector_pixel(const PreparedStructuredLight& prepared,
                                               const Eigen::Vector3d& path) {
  const PinholeIntrinsics& image = prepared.camera.projector.intrinsics;
  const auto pixel =
      prepared.projection.pixel_of(prepared.camera.projector_from_camera.linear() * path);
  if (!pixel) return {};
  const bool is_inside = pixel->x() >= -0.5 && pixel->x() <= image.width - 0.5 &&
                         pixel->y() >= -0.5 && pixel->y() <= image.height - 0.5;
  return is_inside ? pixel : std::nullopt;
}

}  // namespace glidar
