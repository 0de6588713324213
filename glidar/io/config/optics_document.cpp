// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_document.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/exact_unit.hpp>
#include <glidar/io/config/optics_json.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

using Json = nlohmann::ordered_json;

Json exact_list(const std::vector<double>& inside, double unit) {
  Json list = Json::array();
  for (const double value : inside) list.push_back(exact_in(value, unit));
  return list;
}

/// One number of each channel.
template <class Function>
Json channel_list(const Spinning& spinning, double unit, Function number_of) {
  std::vector<double> inside;
  for (const SpinningChannel& channel : spinning.channels) inside.push_back(number_of(channel));
  return exact_list(inside, unit);
}

/// In degrees where two numbers give the sector exactly, else in radians.
Json sector_document(const Spinning& s) {
  const auto from_deg = find_exact_in(s.sector_start_rad, kDegree);
  const auto width_deg = find_exact_in(s.sector_width_rad, kDegree);
  if (from_deg && width_deg) {
    const double to_deg = *from_deg + *width_deg;
    const bool is_in_reach = std::max(std::abs(*from_deg), std::abs(to_deg)) <= 360.0;
    const double width_read_deg = to_deg - *from_deg;
    if (is_in_reach && width_read_deg <= 360.0 && width_read_deg * kDegree == s.sector_width_rad) {
      return {{"from_deg", *from_deg}, {"to_deg", to_deg}};
    }
  }
  return {{"from_rad", s.sector_start_rad}, {"width_rad", s.sector_width_rad}};
}

/// How the channels are numbered.
std::string ring_order(const std::vector<SpinningChannel>& channels) {
  std::size_t index = 0;
  const auto is_listed = [&](const SpinningChannel& c) { return c.ring == index++; };
  if (std::all_of(channels.begin(), channels.end(), is_listed)) return "as_listed";
  const auto rises = [&](const SpinningChannel& c) {
    return c.ring == std::count_if(channels.begin(), channels.end(), [&](const auto& other) {
             return other.elevation_rad < c.elevation_rad;
           });
  };
  if (std::all_of(channels.begin(), channels.end(), rises)) return "rising_elevation";
  throw Error({.where = "optics.ring",
               .found = "channels numbered in an order of their own",
               .allowed = "as_listed, rising_elevation",
               .remedy = ""});
}

Json document_of(const Pinhole& pinhole) {
  return optics_json(pinhole);  // pixels and plain numbers only
}

Json document_of(const Spinning& s) {
  using Channel = SpinningChannel;
  Json told = {{"type", "spinning"},
               {"rotation_direction",
                s.turn == Spinning::Turn::clockwise ? "clockwise" : "counterclockwise"},
               {"start_azimuth_deg", exact_in(s.start_azimuth_rad, kDegree)},
               {"beam_origin_mm", exact_in(s.beam_origin_m, kMillimetre_m)}};
  if (s.columns_per_turn > 0) told["columns_per_turn"] = s.columns_per_turn;
  if (s.columns_per_turn == 0) told["firing_period_us"] = exact_in(s.sequence_ns, kMicrosecond_ns);
  const Spinning whole_turn;
  if (s.sector_start_rad != whole_turn.sector_start_rad ||
      s.sector_width_rad != whole_turn.sector_width_rad) {
    told["azimuth_range"] = sector_document(s);
  }
  const auto add = [&](const char* key, double unit, auto number_of) {
    told[key] = channel_list(s, unit, number_of);
  };
  add("elevation_deg", kDegree, [](const Channel& c) { return c.elevation_rad; });
  add("azimuth_left_deg", kDegree, [](const Channel& c) { return c.azimuth_offset_rad; });
  add("fire_time_us", kMicrosecond_ns, [](const Channel& c) { return c.fire_time_ns; });
  add("origin_out_mm", kMillimetre_m, [](const Channel& c) { return c.origin_m.x(); });
  add("origin_left_mm", kMillimetre_m, [](const Channel& c) { return c.origin_m.y(); });
  add("origin_up_mm", kMillimetre_m, [](const Channel& c) { return c.origin_m.z(); });
  told["ring"] = ring_order(s.channels);
  return told;
}

Json document_of(const LineScan& raster) {
  Json told = optics_json(raster, exact_in);
  told.erase("scan_hz");  // follows from the rate
  return told;
}

Json document_of(const Prism& prism) {
  return optics_json(prism, exact_in);
}

Json document_of(const RayTable& /*table*/) {
  return {};
}

}  // namespace

Json optics_document(const Optics& optics) {
  return std::visit([](const auto& o) { return document_of(o); }, optics);
}

}  // namespace glidar
