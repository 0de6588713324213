// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/spinning_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/unit_conversion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidar {
namespace {

constexpr NumberRule kTurn = {-360.0, 360.0, false, "degrees from -360 to 360"};
constexpr NumberRule kOffset = {-1e4, 1e4, false, "millimetres from -1e4 to 1e4"};

/// How many channels are below this one.
std::size_t channels_below(const std::vector<SpinningChannel>& channels,
                           const SpinningChannel& channel) {
  return static_cast<std::size_t>(std::count_if(
      channels.begin(), channels.end(),
      [&](const SpinningChannel& other) { return other.elevation_rad < channel.elevation_rad; }));
}

void visit_order(FieldVisitor& visitor, std::vector<SpinningChannel>& channels) {
  constexpr std::array<Named<ChannelOrder>, 2> kNames = {
      {{"as_listed", ChannelOrder::as_listed},
       {"rising_elevation", ChannelOrder::rising_elevation}}};
  if (visitor.is_report()) {
    std::vector<std::uint32_t> rings;
    for (const SpinningChannel& channel : channels) rings.push_back(channel.ring);
    return visitor.whole_numbers({"ring", "number of each channel"}, rings);
  }
  const auto found = channel_order_of(channels);
  if (visitor.is_document() && !found)
    visitor.reject("optics.channel_order", "channels numbered in an order of their own",
                   "as_listed, rising_elevation");
  ChannelOrder order = visitor.is_document() ? *found : ChannelOrder::as_listed;
  visit_choice(visitor, {"channel_order", "numbering of the channels"}, kNames, order);
  if (visitor.is_reading()) number_rings(order, channels);
}

/// One number for all channels or one for each.
NumberListRule per_channel(const NumberRule& number, std::size_t count,
                           const FieldVisitor& visitor) {
  if (!visitor.is_reading()) return {number, 1, kMaxChannels, true, false, {}};
  return {number, count,
          count,  true,
          false,  "one number, or " + std::to_string(count) + ": one for each of elevation_deg"};
}

/// A list of one number of each channel.
template <class Number>
void visit_per_channel(FieldVisitor& visitor, const FieldInfo& field, const NumberRule& rule,
                       std::vector<SpinningChannel>& channels, Number number_of) {
  std::vector<double> values;
  for (SpinningChannel& channel : channels) values.push_back(number_of(channel));
  visitor.numbers(field, per_channel(rule, channels.size(), visitor), values);
  if (!visitor.is_reading()) return;
  for (std::size_t i = 0; i < channels.size(); ++i) number_of(channels[i]) = values[i];
}

void visit_elevations(FieldVisitor& visitor, std::vector<SpinningChannel>& channels) {
  const bool is_required = visitor.is_reading() && channels.empty();  // not after a calibration
  const FieldInfo field = {"elevation_deg", "elevation of each channel", kUnitDegree, is_required,
                           "this or `calibration_file`"};
  if (visitor.mode() == FieldVisitor::Mode::schema)
    visitor.at_most_one({.keys = {field.key},
                         .allowed = "",
                         .missing = "the elevations are missing",
                         .supplier = "calibration_file"});
  const NumberRule rule = {-90.0, 90.0, false, "degrees from -90 to 90"};
  std::vector<double> values;
  for (const SpinningChannel& channel : channels) values.push_back(channel.elevation_rad);
  visitor.numbers(field, {.number = rule, .max_size = kMaxChannels}, values);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  channels.assign(values.size(), {});
  for (std::size_t i = 0; i < values.size(); ++i) channels[i].elevation_rad = values[i];
}

/// Offsets to the left, or in files also to the right.
void visit_azimuths(FieldVisitor& visitor, std::vector<SpinningChannel>& channels) {
  const char* text = "azimuth relative to the direction of the head";
  const auto offset = [](SpinningChannel& channel) -> double& {
    return channel.azimuth_offset_rad;
  };
  visit_per_channel(visitor, {"azimuth_left_deg", text, kUnitDegree, false, "0"}, kTurn, channels,
                    offset);
  if (visitor.is_writing()) return;
  visitor.at_most_one({{"azimuth_left_deg", "azimuth_right_deg"}, "one of the two"});
  visit_per_channel(
      visitor, {"azimuth_right_deg", "the same, counted to the right", kUnitDegree, false, "0"},
      kTurn, channels, offset);
  if (!visitor.has("azimuth_right_deg") || !visitor.is_reading()) return;
  for (SpinningChannel& channel : channels) {
    channel.azimuth_offset_rad = -channel.azimuth_offset_rad;
  }
}

struct SectorDegrees {
  double from = 0.0;
  double to = 0.0;
};

/// The numbers in degrees that a reader converts into exactly this sector.
std::optional<SectorDegrees> exact_degrees(const Spinning& s) {
  const auto from_deg = find_exact_in(s.azimuth_start_rad, kDegree);
  const auto width_deg = find_exact_in(s.azimuth_width_rad, kDegree);
  if (!from_deg || !width_deg) return std::nullopt;
  const SectorDegrees sector = {*from_deg, *from_deg + *width_deg};
  const double read_deg = sector.to - sector.from;
  const bool is_allowed = std::abs(sector.from) <= kTurn.max && std::abs(sector.to) <= kTurn.max &&
                          read_deg <= kTurn.max;
  if (!is_allowed || read_deg * kDegree != s.azimuth_width_rad) return std::nullopt;
  return sector;
}

void visit_sector_rad(FieldVisitor& visitor, bool is_required, Spinning& s) {
  constexpr NumberRule kFrom = {-20.0, 20.0, false, "radians from -20 to 20"};
  constexpr NumberRule kWidth = {0.0, 6.2832, true, "radians above 0, up to a whole turn (6.2832)"};
  visitor.number(
      {"from_rad", "first azimuth, where `from_deg` is not exact", {"radians"}, is_required, ""},
      kFrom, s.azimuth_start_rad);
  visitor.number({"width_rad", "width of the sector", {"radians"}, is_required, ""}, kWidth,
                 s.azimuth_width_rad);
}

void visit_sector_deg(FieldVisitor& visitor, bool is_required, Spinning& s) {
  constexpr FieldUnit kPlainDegree = {"degrees"};
  SectorDegrees sector = exact_degrees(s).value_or(SectorDegrees{});
  visitor.number({"from_deg", "first azimuth", kPlainDegree, is_required, ""}, kTurn, sector.from);
  visitor.number({"to_deg",
                  "last azimuth, counted to the left; add 360 if the sector includes the "
                  "direction straight back",
                  kPlainDegree, is_required, ""},
                 kTurn, sector.to);
  if (!visitor.is_reading()) return;
  const double width_deg = sector.to - sector.from;
  if (!(width_deg > 0.0 && width_deg <= kTurn.max)) {
    visitor.reject("to_deg", "{}", "from_deg to from_deg + 360, counted to the left",
                   "add 360 when the sector reaches over the back");
  }
  s.azimuth_start_rad = sector.from * kDegree;
  s.azimuth_width_rad = width_deg * kDegree;
}

void visit_sector(FieldVisitor& visitor, Spinning& s) {
  if (visitor.is_report()) {
    visitor.number({"from_deg", "", kUnitDegree}, kTurn, s.azimuth_start_rad);
    return visitor.number({"width_deg", "", kUnitDegree}, kTurn, s.azimuth_width_rad);
  }
  if (visitor.mode() == FieldVisitor::Mode::schema) {
    visitor.at_most_one({.keys = {"from_deg", "from_rad"},
                         .allowed = "",
                         .missing = "the first azimuth is missing"});
    for (const auto& [key, needed] : {std::pair{"from_deg", "to_deg"},
                                      {"to_deg", "from_deg"},
                                      {"from_rad", "width_rad"},
                                      {"width_rad", "from_rad"}})
      visitor.needs({key, needed, "", ""});
    visit_sector_deg(visitor, false, s);
    return visit_sector_rad(visitor, false, s);
  }
  const bool is_exact = visitor.has("from_rad") || visitor.has("width_rad") ||
                        (visitor.is_document() && !exact_degrees(s));
  if (is_exact) return visit_sector_rad(visitor, true, s);
  visit_sector_deg(visitor, true, s);
}

}  // namespace

std::optional<ChannelOrder> channel_order_of(const std::vector<SpinningChannel>& channels) {
  for (const ChannelOrder order : {ChannelOrder::as_listed, ChannelOrder::rising_elevation}) {
    std::vector<SpinningChannel> numbered = channels;
    number_rings(order, numbered);
    const auto same = [](const auto& a, const auto& b) { return a.ring == b.ring; };
    if (std::equal(channels.begin(), channels.end(), numbered.begin(), same)) return order;
  }
  return std::nullopt;
}

void number_rings(ChannelOrder order, std::vector<SpinningChannel>& channels) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const bool is_listed = order == ChannelOrder::as_listed;
    channels[i].ring =
        static_cast<std::uint16_t>(is_listed ? i : channels_below(channels, channels[i]));
  }
}

void visit_channels(FieldVisitor& visitor, std::vector<SpinningChannel>& channels) {
  using Channel = SpinningChannel;
  visit_elevations(visitor, channels);
  visit_azimuths(visitor, channels);
  visit_per_channel(visitor,
                    {"fire_time_us", "firing time after the start of the firing sequence",
                     kUnitMicrosecond_ns, false, "0"},
                    {-1e6, 1e6, false, "microseconds from -1e6 to 1e6"}, channels,
                    [](Channel& c) -> double& { return c.fire_time_ns; });
  visit_per_channel(
      visitor,
      {"beam_origin_radial_mm", "start of the beam along its azimuth", kUnitMillimetre, false, "0"},
      kOffset, channels, [](Channel& c) -> double& { return c.origin_m.x(); });
  visit_per_channel(visitor,
                    {"beam_origin_tangential_mm", "start of the beam to the left of it",
                     kUnitMillimetre, false, "0"},
                    kOffset, channels, [](Channel& c) -> double& { return c.origin_m.y(); });
  visit_per_channel(
      visitor, {"beam_origin_axial_mm", "start of the beam upwards", kUnitMillimetre, false, "0"},
      kOffset, channels, [](Channel& c) -> double& { return c.origin_m.z(); });
  visit_per_channel(visitor,
                    {"distance_correction_mm",
                     "what drivers add to distances of packets; these have the range minus it",
                     kUnitMillimetre, false, "0"},
                    kOffset, channels,
                    [](Channel& c) -> double& { return c.distance_correction_m; });
  visit_order(visitor, channels);
}

void visit_azimuth_range(FieldVisitor& visitor, Spinning& spinning) {
  const Spinning whole_turn;
  const bool is_whole = spinning.azimuth_start_rad == whole_turn.azimuth_start_rad &&
                        spinning.azimuth_width_rad == whole_turn.azimuth_width_rad;
  const auto sector = [&](FieldVisitor& nested) { visit_sector(nested, spinning); };
  visitor.object({"azimuth_range", "measured azimuths", kNoUnit, false, "full circle"},
                 !visitor.is_document() || !is_whole, FieldVisitor::Describe(sector));
}

}  // namespace glidar
