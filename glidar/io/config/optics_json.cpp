// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_json.hpp>

#include <glidar/math/constants.hpp>

#include <array>
#include <string_view>

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
  if (d.k4 == 0.0 && d.k5 == 0.0 && d.k6 == 0.0)
    return {"plumb_bob", {d.k1, d.k2, d.p1, d.p2, d.k3}};
  return {"rational_polynomial", {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6}};
}

NamedCoefficients coefficients_of(const Fisheye& d) {
  return {"equidistant", {d.k1, d.k2, d.k3, d.k4}};
}

Json distortion_json(const NoDistortion& /*none*/) {
  return {{"model", "none"}};
}

Json distortion_json(const RadialTangential& d) {
  Json json = {{"model", "radial_tangential"},
               {"k1", d.k1},
               {"k2", d.k2},
               {"p1", d.p1},
               {"p2", d.p2},
               {"k3", d.k3},
               {"k4", d.k4},
               {"k5", d.k5},
               {"k6", d.k6}};
  if (std::isfinite(d.max_radius)) json["max_radius"] = d.max_radius;
  return json;
}

Json distortion_json(const Fisheye& d) {
  return {{"model", "fisheye"}, {"k1", d.k1}, {"k2", d.k2}, {"k3", d.k3}, {"k4", d.k4}};
}

Json json_of(const Pinhole& pinhole, InUnit /*convert*/) {
  const PinholeIntrinsics& i = pinhole.intrinsics;
  return {{"type", "pinhole"},
          {"width", i.width},
          {"height", i.height},
          {"fx", i.fx},
          {"fy", i.fy},
          {"cx", i.cx},
          {"cy", i.cy},
          {"pixel_centre", i.pixel_centre},
          {"distortion",
           std::visit([](const auto& d) { return distortion_json(d); }, pinhole.distortion)}};
}

/// A list of one number for each entry.
template <class Entries, class Function>
Json list_of(const Entries& entries, Function number_of) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(number_of(entry));
  return list;
}

Json json_of(const Spinning& s, InUnit convert) {
  using Channel = SpinningChannel;
  Json told = {{"type", "spinning"},
               {"rotation_hz", s.rotation_hz},
               {"rotation_direction",
                s.turn == Spinning::Turn::clockwise ? "clockwise" : "counterclockwise"},
               {"start_azimuth_deg", convert(s.start_azimuth_rad, kDegree)},
               {"columns_per_turn", s.columns_per_turn},
               {"firing_period_us", convert(sequence_period_ns(s), kMicrosecond_ns)},
               {"beam_origin_mm", convert(s.beam_origin_m, kMillimetre_m)},
               {"azimuth_range",
                {{"from_deg", convert(s.sector_start_rad, kDegree)},
                 {"width_deg", convert(s.sector_width_rad, kDegree)}}}};
  const auto add = [&](const char* key, auto number_of) {
    told[key] = list_of(s.channels, number_of);
  };
  add("elevation_deg", [&](const Channel& c) { return convert(c.elevation_rad, kDegree); });
  add("azimuth_left_deg", [&](const Channel& c) { return convert(c.azimuth_offset_rad, kDegree); });
  add("fire_time_us", [&](const Channel& c) { return convert(c.fire_time_ns, kMicrosecond_ns); });
  add("origin_out_mm", [&](const Channel& c) { return convert(c.origin_m.x(), kMillimetre_m); });
  add("origin_left_mm", [&](const Channel& c) { return convert(c.origin_m.y(), kMillimetre_m); });
  add("origin_up_mm", [&](const Channel& c) { return convert(c.origin_m.z(), kMillimetre_m); });
  add("ring", [](const Channel& c) { return c.ring; });
  return told;
}

Json json_of(const LineScan& r, InUnit convert) {
  const auto degrees = [&](double angle_rad) { return convert(angle_rad, kDegree); };
  return {{"type", "raster"},
          {"scan_hz", r.scan_hz},
          {"elevation_deg", list_of(r.elevations_rad, degrees)},
          {"azimuth_deg", list_of(r.azimuths_rad, degrees)},
          {"point_us", convert(r.point_ns, kMicrosecond_ns)},
          {"line_us", convert(r.line_ns, kMicrosecond_ns)},
          {"bidirectional", r.bidirectional}};
}

Json json_of(const Prism& p, InUnit convert) {
  Json prisms = Json::array();
  for (const RisleyPrism& prism : p.prisms) {
    prisms.push_back({{"rotation_hz", prism.rotation_hz},
                      {"apex_deg", convert(prism.apex_rad, kDegree)},
                      {"phase_deg", convert(prism.phase_rad, kDegree)},
                      {"refractive_index", prism.refractive_index},
                      {"slope", prism.slope == RisleyPrism::Slope::entry ? "entry" : "exit"}});
  }
  return {{"type", "prism"},
          {"pulse_hz", p.pulse_hz},
          {"prisms", prisms},
          {"incidence_tangent", p.incidence_tangent}};
}

/// The beams themselves are too many for a sidecar; clouds carry what was measured on them.
Json json_of(const RayTable& t, InUnit convert) {
  return {{"type", "table"},
          {"rows", t.rows},
          {"cols", t.cols},
          {"period_us", convert(t.period_ns, kMicrosecond_ns)},
          {"times", !t.times_ns.empty()},
          {"origins", !t.origins_m.empty()}};
}

}  // namespace

Json camera_info_json(const Optics& optics) {
  const auto* pinhole = std::get_if<Pinhole>(&optics);
  if (pinhole == nullptr) return {};
  const PinholeIntrinsics& i = pinhole->intrinsics;
  const double cx = i.cx - i.pixel_centre;
  const double cy = i.cy - i.pixel_centre;
  const NamedCoefficients named =
      std::visit([](const auto& d) { return coefficients_of(d); }, pinhole->distortion);
  return {{"convention",
           "pixel centres have whole coordinates, as in OpenCV, ROS and Open3D; those of optics "
           "have optics.pixel_centre more"},
          {"width", i.width},
          {"height", i.height},
          {"distortion_model", named.model},
          {"d", named.d},
          {"k", std::array{i.fx, 0.0, cx, 0.0, i.fy, cy, 0.0, 0.0, 1.0}},
          {"r", std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}},
          {"p", std::array{i.fx, 0.0, cx, 0.0, 0.0, i.fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0}}};
}

Json optics_json(const Optics& optics, InUnit convert) {
  return std::visit([&](const auto& o) { return json_of(o, convert); }, optics);
}

}  // namespace glidar
