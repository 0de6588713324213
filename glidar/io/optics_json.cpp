// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/optics_json.hpp>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMicrosecond_ns = 1e3;

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

Json json_of(const Pinhole& pinhole) {
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

Json json_of(const Spinning& s) {
  using Channel = SpinningChannel;
  Json told = {
      {"type", "spinning"},
      {"rotation_hz", s.rotation_hz},
      {"turn", s.turn == Spinning::Turn::clockwise ? "clockwise" : "counterclockwise"},
      {"start_azimuth_deg", s.start_azimuth_rad / kDegree},
      {"columns_per_turn", s.columns_per_turn},
      {"sequence_us", sequence_period_ns(s) / kMicrosecond_ns},
      {"beam_origin_mm", s.beam_origin_m * 1e3},
      {"sector",
       {{"from_deg", s.sector_start_rad / kDegree}, {"width_deg", s.sector_width_rad / kDegree}}}};
  const auto add = [&](const char* key, auto number_of) {
    told[key] = list_of(s.channels, number_of);
  };
  add("elevation_deg", [](const Channel& c) { return c.elevation_rad / kDegree; });
  add("azimuth_left_deg", [](const Channel& c) { return c.azimuth_offset_rad / kDegree; });
  add("fire_time_us", [](const Channel& c) { return c.fire_time_ns / kMicrosecond_ns; });
  add("origin_out_mm", [](const Channel& c) { return c.origin_m.x() * 1e3; });
  add("origin_left_mm", [](const Channel& c) { return c.origin_m.y() * 1e3; });
  add("origin_up_mm", [](const Channel& c) { return c.origin_m.z() * 1e3; });
  add("ring", [](const Channel& c) { return c.ring; });
  return told;
}

Json json_of(const Raster& r) {
  const auto degrees = [](double angle_rad) { return angle_rad / kDegree; };
  return {{"type", "raster"},
          {"scan_hz", r.scan_hz},
          {"elevation_deg", list_of(r.elevations_rad, degrees)},
          {"azimuth_deg", list_of(r.azimuths_rad, degrees)},
          {"point_us", r.point_ns / kMicrosecond_ns},
          {"line_us", r.line_ns / kMicrosecond_ns},
          {"to_and_fro", r.to_and_fro}};
}

Json json_of(const Prism& p) {
  Json prisms = Json::array();
  for (const RisleyPrism& prism : p.prisms) {
    prisms.push_back({{"rotation_hz", prism.rotation_hz},
                      {"apex_deg", prism.apex_rad / kDegree},
                      {"phase_deg", prism.phase_rad / kDegree},
                      {"refractive_index", prism.refractive_index},
                      {"slope", prism.slope == RisleyPrism::Slope::entry ? "entry" : "exit"}});
  }
  return {{"type", "prism"},
          {"pulse_hz", p.pulse_hz},
          {"prisms", prisms},
          {"incident_right", p.incident_right}};
}

/// The beams themselves are too many for a sidecar; clouds carry what was measured on them.
Json json_of(const BeamTable& t) {
  return {{"type", "table"},
          {"rows", t.rows},
          {"cols", t.cols},
          {"period_us", t.period_ns / kMicrosecond_ns},
          {"times", !t.times_ns.empty()},
          {"origins", !t.origins_m.empty()}};
}

}  // namespace

Json optics_json(const Optics& optics) {
  return std::visit([](const auto& o) { return json_of(o); }, optics);
}

}  // namespace glidar
