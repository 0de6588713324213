// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/optics_yaml.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>

namespace glidar {
namespace {

constexpr std::size_t kMaxChannels = 4096;
constexpr std::size_t kMaxAngles = 65536;
constexpr std::uint32_t kMaxColumns = 1U << 20U;
constexpr NumberRule kElevation = {-90.0, 90.0, false, "degrees from -90 to 90"};
constexpr NumberRule kTurn = {-360.0, 360.0, false, "degrees from -360 to 360"};
constexpr NumberRule kSector_rad = {-20.0, 20.0, false, "radians from -20 to 20"};
constexpr NumberRule kSectorWidth_rad = {0.0, 6.2832, true,
                                         "radians above 0, up to a whole turn (6.2832)"};
constexpr NumberRule kSequence_us = {1e-3, 1e6, false, "microseconds from 0.001 to 1e6"};
constexpr NumberRule kFireTime_us = {-1e6, 1e6, false, "microseconds from -1e6 to 1e6"};
constexpr NumberRule kPoint_us = {0.0, 1e6, false, "microseconds from 0 to 1e6"};
constexpr NumberRule kOffset_mm = {-1e4, 1e4, false, "millimetres from -1e4 to 1e4"};
constexpr NumberRule kApex = {0.0, 89.0, false, "degrees from 0 to 89"};
constexpr NumberRule kIndex = {1.0, 10.0, false, "a number from 1 to 10"};
constexpr NumberRule kSine = {-1.0, 1.0, true, "a number above -1 and below 1"};
constexpr NumberRule kPulses = {0.0, 1e9, true, "a number above 0, below 1e9"};

/// One number for all channels or one for each; 0 for all when the key is missing.
std::vector<double> per_channel(const YamlField& optics, const char* key, const NumberRule& rule,
                                std::size_t channels) {
  const auto field = find(optics, key);
  if (!field) return std::vector<double>(channels, 0.0);
  if (field->node.IsScalar()) return std::vector<double>(channels, number(*field, rule));
  std::vector<double> values = numbers(*field, rule, kMaxChannels);
  if (values.size() == channels) return values;
  reject(*field, describe(*field),
         "one number, or " + std::to_string(channels) + ": one for each of elevation_deg");
}

/// Offsets from where the head points, positive to the left whichever way the file counts them.
std::vector<double> azimuth_offsets_deg(const YamlField& optics, std::size_t channels) {
  const auto right = find(optics, "azimuth_right_deg");
  if (!right) return per_channel(optics, "azimuth_left_deg", kTurn, channels);
  if (find(optics, "azimuth_left_deg")) {
    reject(*right, "given beside 'azimuth_left_deg'", "one of the two", "remove one of them");
  }
  std::vector<double> offsets = per_channel(optics, "azimuth_right_deg", kTurn, channels);
  for (double& offset : offsets) offset = -offset;
  return offsets;
}

/// The numbers that channels go by: their places in the table or by rising elevation.
void number_rings(const YamlField& optics, std::vector<SpinningChannel>& channels) {
  for (std::size_t i = 0; i < channels.size(); ++i)
    channels[i].ring = static_cast<std::uint16_t>(i);
  const auto ring = find(optics, "ring");
  if (!ring || one_of(*ring, {"as_listed", "rising_elevation"}) == 0) return;
  for (SpinningChannel& channel : channels) {
    channel.ring = static_cast<std::uint16_t>(std::count_if(
        channels.begin(), channels.end(),
        [&](const SpinningChannel& other) { return other.elevation_rad < channel.elevation_rad; }));
  }
}

std::vector<SpinningChannel> read_channels(const YamlField& optics) {
  const std::vector<double> elevations =
      numbers(need(optics, "elevation_deg"), kElevation, kMaxChannels);
  const std::size_t count = elevations.size();
  const std::vector<double> azimuths = azimuth_offsets_deg(optics, count);
  const std::vector<double> times = per_channel(optics, "fire_time_us", kFireTime_us, count);
  const std::vector<double> out = per_channel(optics, "origin_out_mm", kOffset_mm, count);
  const std::vector<double> left = per_channel(optics, "origin_left_mm", kOffset_mm, count);
  const std::vector<double> up = per_channel(optics, "origin_up_mm", kOffset_mm, count);
  std::vector<SpinningChannel> channels(count);
  for (std::size_t i = 0; i < count; ++i) {
    channels[i].elevation_rad = elevations[i] * kDegree;
    channels[i].azimuth_offset_rad = azimuths[i] * kDegree;
    channels[i].fire_time_ns = times[i] * kMicrosecond_ns;
    channels[i].origin_m = kMillimetre_m * Eigen::Vector3d(out[i], left[i], up[i]);
  }
  number_rings(optics, channels);
  return channels;
}

/// What starts a firing sequence: the encoder or a clock.
void read_column_timing(const YamlField& optics, Spinning& s) {
  const auto columns = find(optics, "columns_per_turn");
  const auto sequence = find(optics, "firing_period_us");
  if (columns.has_value() == sequence.has_value()) {
    reject(sequence ? *sequence : optics,
           sequence ? "given beside 'columns_per_turn'" : "the time between columns is missing",
           "one of columns_per_turn and firing_period_us",
           sequence ? "remove one of them" : "add 'columns_per_turn: ...'");
  }
  if (columns) s.columns_per_turn = whole_number(*columns, 1, kMaxColumns);
  if (sequence) s.sequence_ns = number(*sequence, kSequence_us) * kMicrosecond_ns;
}

/// The exact form, for sectors that no two numbers in degrees give to the last bit.
void read_sector_rad(const YamlField& field, Spinning& s) {
  require_map(field, {"from_rad", "width_rad"});
  s.sector_start_rad = number(need(field, "from_rad"), kSector_rad);
  s.sector_width_rad = number(need(field, "width_rad"), kSectorWidth_rad);
}

void read_sector(const YamlField& field, Spinning& s) {
  if (field.node.IsMap() && (find(field, "from_rad") || find(field, "width_rad"))) {
    return read_sector_rad(field, s);
  }
  require_map(field, {"from_deg", "to_deg"});
  const double from_deg = number(need(field, "from_deg"), kTurn);
  const YamlField to = need(field, "to_deg");
  const double width_deg = number(to, kTurn) - from_deg;
  if (!(width_deg > 0.0 && width_deg <= 360.0)) {
    reject(to, describe(to), "from_deg to from_deg + 360, counted to the left",
           "add 360 when the sector reaches over the back");
  }
  s.sector_start_rad = from_deg * kDegree;
  s.sector_width_rad = width_deg * kDegree;
}

/// A list of angles, or {from, to, count} for equal steps.
std::vector<double> read_angles_rad(const YamlField& field, const NumberRule& rule) {
  std::vector<double> angles;
  if (field.node.IsMap()) {
    require_map(field, {"from", "to", "count"});
    const double from = number(need(field, "from"), rule);
    const double to = number(need(field, "to"), rule);
    const std::uint32_t count = whole_number(need(field, "count"), 2, kMaxAngles);
    for (std::uint32_t i = 0; i < count; ++i) {
      angles.push_back(from + (to - from) * i / (count - 1.0));
    }
  } else if (field.node.IsScalar()) {
    angles = {number(field, rule)};
  } else {
    angles = numbers(field, rule, kMaxAngles);
  }
  for (double& angle : angles) angle *= kDegree;
  return angles;
}

RisleyPrism read_risley(const YamlField& field) {
  require_map(field, {"rotation_hz", "apex_deg", "phase_deg", "refractive_index", "slope"});
  RisleyPrism prism;
  prism.rotation_hz = number(need(field, "rotation_hz"), kFinite);
  prism.apex_rad = number(need(field, "apex_deg"), kApex) * kDegree;
  prism.phase_rad = number_or(field, "phase_deg", kTurn, 0.0) * kDegree;
  prism.refractive_index = number(need(field, "refractive_index"), kIndex);
  const auto slope = find(field, "slope");
  const bool entry = !slope || one_of(*slope, {"entry", "exit"}) == 0;
  prism.slope = entry ? RisleyPrism::Slope::entry : RisleyPrism::Slope::exit;
  return prism;
}

}  // namespace

std::vector<double> numbers(const YamlField& field, const NumberRule& rule, std::size_t most) {
  if (!field.node.IsSequence() || field.node.size() < 1 || field.node.size() > most) {
    reject(field, describe(field), "a list of 1 to " + std::to_string(most) + " numbers");
  }
  std::vector<double> values;
  for (const YamlField& item : items(field)) values.push_back(number(item, rule));
  return values;
}

Spinning read_spinning(const YamlField& field) {
  require_map(field, {"type", "elevation_deg", "azimuth_left_deg", "azimuth_right_deg",
                      "fire_time_us", "ring", "origin_out_mm", "origin_left_mm", "origin_up_mm",
                      "beam_origin_mm", "columns_per_turn", "firing_period_us",
                      "rotation_direction", "start_azimuth_deg", "azimuth_range"});
  Spinning s;
  s.channels = read_channels(field);
  read_column_timing(field, s);
  if (const auto turn = find(field, "rotation_direction")) {
    s.turn = one_of(*turn, {"clockwise", "counterclockwise"}) == 0
                 ? Spinning::Turn::clockwise
                 : Spinning::Turn::counterclockwise;
  }
  s.start_azimuth_rad = number_or(field, "start_azimuth_deg", kTurn, 0.0) * kDegree;
  s.beam_origin_m = number_or(field, "beam_origin_mm", kOffset_mm, 0.0) * kMillimetre_m;
  if (const auto sector = find(field, "azimuth_range")) read_sector(*sector, s);
  return s;
}

LineScan read_line_scan(const YamlField& field) {
  require_map(field,
              {"type", "azimuth_deg", "elevation_deg", "point_us", "line_us", "bidirectional"});
  LineScan r;
  r.azimuths_rad = read_angles_rad(need(field, "azimuth_deg"), kTurn);
  const auto elevation = find(field, "elevation_deg");
  r.elevations_rad = elevation ? read_angles_rad(*elevation, kElevation) : std::vector<double>{0.0};
  r.point_ns = number_or(field, "point_us", kPoint_us, 0.0) * kMicrosecond_ns;
  r.line_ns = number_or(field, "line_us", kPoint_us,
                        r.point_ns * static_cast<double>(r.azimuths_rad.size()) / kMicrosecond_ns) *
              kMicrosecond_ns;
  if (const auto bidirectional = find(field, "bidirectional"))
    r.bidirectional = boolean(*bidirectional);
  return r;
}

Prism read_prism(const YamlField& field) {
  require_map(field, {"type", "prisms", "pulse_hz", "incidence_tangent"});
  constexpr std::size_t kMaxParts = 64;
  Prism prism;
  const YamlField prisms = need(field, "prisms");
  if (!prisms.node.IsSequence() || prisms.node.size() < 1 || prisms.node.size() > kMaxParts) {
    reject(prisms, describe(prisms), "a list of 1 to 64 prisms");
  }
  for (const YamlField& item : items(prisms)) prism.prisms.push_back(read_risley(item));
  prism.pulse_hz = number(need(field, "pulse_hz"), kPulses);
  if (const auto incident = find(field, "incidence_tangent")) {
    prism.incidence_tangent = numbers(*incident, kSine, kMaxParts);
  }
  return prism;
}

}  // namespace glidar
