// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/camera_info.hpp>

#include <algorithm>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

/// The name of a model among ROS' (sensor_msgs/distortion_models.hpp) and its coefficients in
/// OpenCV's order.
struct NamedCoefficients {
  std::string_view model;
  std::vector<double> d;
};

NamedCoefficients coefficients_of(const NoDistortion& /*none*/) {
  return {"plumb_bob", std::vector<double>(5, 0.0)};
}

NamedCoefficients coefficients_of(const RadialTangential& d) {
  const bool is_tilted = d.tau_x != 0.0 || d.tau_y != 0.0;
  if (is_tilted || d.s1 != 0.0 || d.s2 != 0.0 || d.s3 != 0.0 || d.s4 != 0.0) {
    NamedCoefficients named = {
        "rational_polynomial",
        {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6, d.s1, d.s2, d.s3, d.s4}};
    if (is_tilted) named.d.insert(named.d.end(), {d.tau_x, d.tau_y});
    return named;
  }
  if (d.k4 == 0.0 && d.k5 == 0.0 && d.k6 == 0.0)
    return {"plumb_bob", {d.k1, d.k2, d.p1, d.p2, d.k3}};
  return {"rational_polynomial", {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6}};
}

NamedCoefficients coefficients_of(const Fisheye& d) {
  return {"equidistant", {d.k1, d.k2, d.k3, d.k4}};
}

// Not among ROS' models: names and order of Kalibr.

NamedCoefficients coefficients_of(const FieldOfView& d) {
  return {"fov", {d.w}};
}

NamedCoefficients coefficients_of(const Omni& d) {
  return {"omni", {d.xi, d.lens.k1, d.lens.k2, d.lens.p1, d.lens.p2}};
}

NamedCoefficients coefficients_of(const DoubleSphere& d) {
  return {"double_sphere", {d.xi, d.alpha}};
}

NamedCoefficients coefficients_of(const ExtendedUnified& d) {
  return {"eucm", {d.alpha, d.beta}};
}

NamedCoefficients coefficients_of(const Equirectangular& /*d*/) {
  return {"equirectangular", {}};
}

}  // namespace

std::optional<CameraModel> camera_model(const Optics& optics) {
  const auto* pinhole = std::get_if<Pinhole>(&optics);
  if (pinhole == nullptr) return std::nullopt;
  const PinholeIntrinsics& i = pinhole->intrinsics;
  const double cx = i.cx - i.pixel_centre;
  const double cy = i.cy - i.pixel_centre;
  NamedCoefficients named =
      std::visit([](const auto& d) { return coefficients_of(d); }, pinhole->distortion);
  return CameraModel{
      .width = i.width,
      .height = i.height,
      .distortion_model = std::string(named.model),
      .d = std::move(named.d),
      .k = {i.fx, pinhole->skew_px, cx, 0.0, i.fy, cy, 0.0, 0.0, 1.0},
      .r = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0},
      .p = {i.fx, pinhole->skew_px, cx, 0.0, 0.0, i.fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0}};
}

bool images_have_range(const Sensor& sensor, const Beams& beams) {
  if (!std::holds_alternative<Pinhole>(sensor.optics)) return false;
  return std::any_of(beams.directions.begin(), beams.directions.end(),
                     [&](const auto& direction) { return direction.dot(beams.boresight) < 0.0; });
}

Json camera_info_json(const Optics& optics) {
  const std::optional<CameraModel> model = camera_model(optics);
  if (!model) return {};
  return {{"convention",
           "pixel centres have whole coordinates, as in OpenCV, ROS and Open3D; those of optics "
           "have optics.pixel_centre more"},
          {"width", model->width},
          {"height", model->height},
          {"distortion_model", model->distortion_model},
          {"d", model->d},
          {"k", model->k},
          {"r", model->r},
          {"p", model->p}};
}

}  // namespace glidar
