// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/spinning.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/unit_conversion.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace glidar {
namespace {

constexpr double kMaxTurns_hz = 1e4;
constexpr std::uint32_t kMaxFiringLoops = 64;

void validate(const SpinningChannel& channel) {
  require_number(std::abs(channel.elevation_rad) <= 0.5 * std::numbers::pi, "optics, elevation",
                 channel.elevation_rad, "-pi/2 to pi/2");
  require_number(std::isfinite(channel.azimuth_offset_rad), "optics, azimuth offset",
                 channel.azimuth_offset_rad, "a finite angle");
  require_number(std::abs(channel.fire_time_ns) <= kSecond_ns, "optics, fire time",
                 channel.fire_time_ns, "-1e9 to 1e9 ns");
  require_number(channel.origin_m.allFinite(), "optics, origin offset", channel.origin_m.norm(),
                 "finite metres");
}

void validate(const FiringLoop& loop, std::size_t channels) {
  require_number(!loop.channels.empty() && loop.channels.size() == loop.fire_times_ns.size(),
                 "optics, firing_loops", static_cast<double>(loop.fire_times_ns.size()),
                 "one fire time for each channel of the loop");
  std::vector<bool> is_used(channels, false);
  for (std::size_t i = 0; i < loop.channels.size(); ++i) {
    const std::uint32_t channel = loop.channels[i];
    require_number(channel < channels && !is_used[channel], "optics, firing_loops, channel",
                   channel, "the index of a channel, each at most once in a loop");
    is_used[channel] = true;
    require_number(std::abs(loop.fire_times_ns[i]) <= kSecond_ns, "optics, fire time",
                   loop.fire_times_ns[i], "-1e9 to 1e9 ns");
  }
}

void validate(const Spinning& s) {
  require_number(!s.channels.empty() && s.channels.size() <= kMaxChannels,
                 "optics, number of channels", static_cast<double>(s.channels.size()), "1 to 4096");
  require_number(s.rotation_hz > 0.0 && s.rotation_hz <= kMaxTurns_hz, "optics, rotation",
                 s.rotation_hz, "above 0, up to 1e4 turns per second");
  require_number(std::isfinite(s.start_azimuth_rad.value_or(0.0)), "optics, start azimuth",
                 s.start_azimuth_rad.value_or(0.0), "a finite angle");
  require_number(std::abs(s.beam_origin_m) <= 1e3, "optics, beam origin", s.beam_origin_m,
                 "-1000 to 1000 m");
  require_number(std::isfinite(s.azimuth_start_rad) && s.azimuth_width_rad > 0.0,
                 "optics, azimuth_range", s.azimuth_width_rad,
                 "a finite start and a width above 0");
  require_number(std::abs(s.beam_origin_height_m) <= 1e3, "optics, beam origin height",
                 s.beam_origin_height_m, "-1000 to 1000 m");
  for (const SpinningChannel& channel : s.channels) validate(channel);
  require_number(s.firing_loops.size() <= kMaxFiringLoops, "optics, number of firing loops",
                 static_cast<double>(s.firing_loops.size()), "up to 64");
  for (const FiringLoop& loop : s.firing_loops) validate(loop, s.channels.size());
}

/// Channels by decreasing elevation; equal ones in the order of the table.
std::vector<std::size_t> rows_of(const Spinning& s) {
  std::vector<std::size_t> rows(s.channels.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return s.channels[a].elevation_rad > s.channels[b].elevation_rad;
  });
  return rows;
}

/// Fraction of a turn from time 0 to the start of sequence k, without whole turns, so that columns
/// stay exact at any time.
double turn_fraction(const Spinning& s, std::int64_t k) {
  if (s.columns_per_turn > 0) {
    const auto columns = std::int64_t{s.columns_per_turn};
    return static_cast<double>(k % columns) / static_cast<double>(columns);
  }
  return std::fmod(static_cast<double>(k) * s.firing_period_ns * s.rotation_hz / kSecond_ns, 1.0);
}

double rotation_sign(const Spinning& s) {
  return s.rotation_direction == Spinning::RotationDirection::clockwise ? -1.0 : 1.0;
}

/// The angle between sequences, as a fraction of a turn.
double step_turns(const Spinning& s) {
  return sequence_period_ns(s) * s.rotation_hz / kSecond_ns;
}

/// Turns the head by a fraction of a turn from its azimuth at time 0.
double head_azimuth_rad(const Spinning& s, double turns) {
  return azimuth_at_start_rad(s) + rotation_sign(s) * kTwoPi * turns;
}

/// The loop of sequence k, which may be negative.
std::size_t loop_of(const Spinning& s, std::int64_t k) {
  const auto loops = static_cast<std::int64_t>(s.firing_loops.size());
  return static_cast<std::size_t>((k % loops + loops) % loops);
}

double first_firing_ns(const Spinning& s) {
  if (!s.firing_loops.empty()) {
    double earliest = kInfinity;
    for (const FiringLoop& loop : s.firing_loops)
      earliest = std::min(earliest, *std::ranges::min_element(loop.fire_times_ns));
    return earliest;
  }
  double first = s.channels.front().fire_time_ns;
  for (const SpinningChannel& channel : s.channels) first = std::min(first, channel.fire_time_ns);
  return first;
}

std::vector<std::int64_t> sequences_in(const Spinning& s, const FrameInterval& interval) {
  const FiringRange range = firings_in({first_firing_ns(s), sequence_period_ns(s)}, interval,
                                       kMaxBeams / s.channels.size());
  std::vector<std::int64_t> sequences;
  sequences.reserve(range.size());
  for (std::int64_t k = range.begin; k < range.end; ++k) {
    if (is_in_sector(s, k)) sequences.push_back(k);
  }
  return sequences;
}

bool has_origins(const Spinning& s) {
  return s.beam_origin_m != 0.0 || s.beam_origin_height_m != 0.0 ||
         std::any_of(s.channels.begin(), s.channels.end(),
                     [](const SpinningChannel& channel) { return !channel.origin_m.isZero(0.0); });
}

/// Beams with all arrays allocated.
Beams make_grid(const Spinning& s, std::size_t sequences) {
  Beams beams;
  beams.rows = static_cast<std::uint32_t>(s.channels.size());
  beams.cols = static_cast<std::uint32_t>(sequences);
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.range_offset_m = range_offset_m(s);
  const std::size_t size = s.channels.size() * sequences;
  beams.directions.resize(size);
  beams.times_ns.resize(size);
  beams.rings.resize(size);
  if (has_origins(s)) beams.origins_m.resize(size);
  return beams;
}

/// The head in each sequence when a channel fires.
struct Heads {
  std::vector<double> azimuths_rad;
  std::vector<Eigen::Vector3d> directions;  ///< level; empty if beams have no origins
};

/// `starts_rad`: azimuths at the start of each sequence.
Heads find_heads(const Spinning& s, const std::vector<double>& starts_rad, double fire_time_ns) {
  const double turn_rad_per_ns = rotation_sign(s) * kTwoPi * s.rotation_hz / kSecond_ns;
  Heads heads;
  heads.azimuths_rad.reserve(starts_rad.size());
  for (const double start_rad : starts_rad) {
    heads.azimuths_rad.push_back(start_rad + turn_rad_per_ns * fire_time_ns);
  }
  if (!has_origins(s)) return heads;
  heads.directions.reserve(starts_rad.size());
  for (const double azimuth_rad : heads.azimuths_rad) {
    heads.directions.push_back(direction_at(azimuth_rad, 0.0));
  }
  return heads;
}

/// FiringColumns of a frame whose sequences fire the same channels at the same times.
struct FiringColumns {
  std::vector<std::size_t> indices;
  std::vector<std::int64_t> sequences;
  std::vector<double> starts_rad;  ///< azimuths of the head at the start of each sequence
};

/// The columns whose sequences fire a loop; without loops, all.
FiringColumns columns_of(const Spinning& s, const std::vector<std::int64_t>& sequences,
                         std::size_t loop) {
  FiringColumns columns;
  for (std::size_t col = 0; col < sequences.size(); ++col) {
    const std::int64_t k = sequences[col];
    if (!s.firing_loops.empty() && loop_of(s, k) != loop) continue;
    columns.indices.push_back(col);
    columns.sequences.push_back(k);
    columns.starts_rad.push_back(head_azimuth_rad(s, turn_fraction(s, k)));
  }
  return columns;
}

/// The beams of a channel in these columns; its row begins at index `first`. Sines and cosines take
/// most of the time, so each is computed once.
void set_beams(const Spinning& s, const SpinningChannel& channel, const FiringColumns& columns,
               const Heads& heads, std::size_t first, Beams& beams) {
  const double level = portable_cos(channel.elevation_rad);
  const double height = portable_sin(channel.elevation_rad);
  const Eigen::Vector3d& offset = channel.origin_m;
  for (std::size_t n = 0; n < heads.azimuths_rad.size(); ++n) {
    const std::size_t i = first + columns.indices[n];
    const Eigen::Vector3d out =
        direction_at(heads.azimuths_rad[n] + channel.azimuth_offset_rad, 0.0);
    beams.directions[i] = Eigen::Vector3d(level * out.x(), level * out.y(), height).normalized();
    if (beams.origins_m.empty()) continue;
    const Eigen::Vector3d left(-out.y(), out.x(), 0.0);
    beams.origins_m[i] = s.beam_origin_m * heads.directions[n] + offset.x() * out +
                         offset.y() * left +
                         (s.beam_origin_height_m + offset.z()) * Eigen::Vector3d::UnitZ();
  }
}

void set_times(const FiringSchedule& firings, const FiringColumns& columns, std::int64_t start_ns,
               std::uint32_t* row_times_ns) {
  for (std::size_t n = 0; n < columns.indices.size(); ++n) {
    row_times_ns[columns.indices[n]] =
        static_cast<std::uint32_t>(firing_time_ns(firings, columns.sequences[n]) - start_ns);
  }
}

/// The channels that fire in a loop, by row, with its fire times; without loops, all channels.
std::vector<std::pair<std::size_t, SpinningChannel>> firing_rows(const Spinning& s,
                                                                 std::size_t loop) {
  const std::vector<std::size_t> rows = rows_of(s);
  std::vector<std::pair<std::size_t, SpinningChannel>> fired;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    SpinningChannel channel = s.channels[rows[row]];
    if (!s.firing_loops.empty()) {
      const FiringLoop& fires = s.firing_loops[loop];
      const auto at = std::ranges::find(fires.channels, rows[row]);
      if (at == fires.channels.end()) continue;
      channel.fire_time_ns =
          fires.fire_times_ns[static_cast<std::size_t>(at - fires.channels.begin())];
    }
    fired.emplace_back(row, channel);
  }
  return fired;
}

/// The beams of a loop in its columns.
void set_loop(const Spinning& s, std::size_t loop, const FiringColumns& columns,
              const FrameInterval& interval, Beams& beams) {
  Heads heads;
  double known_ns = kNaN;  // of `heads`; channels often fire together
  for (const auto& [row, channel] : firing_rows(s, loop)) {
    const std::size_t first = row * beams.cols;
    if (channel.fire_time_ns != known_ns) {
      heads = find_heads(s, columns.starts_rad, channel.fire_time_ns);
      known_ns = channel.fire_time_ns;
    }
    set_beams(s, channel, columns, heads, first, beams);
    set_times({channel.fire_time_ns, sequence_period_ns(s)}, columns, interval.start_ns,
              beams.times_ns.data() + first);
  }
}

/// Beams of rows that do not fire in every column: none, until they are set.
void clear_beams(Beams& beams) {
  std::ranges::fill(beams.directions, Eigen::Vector3d::Constant(kNaN));
  std::ranges::fill(beams.origins_m, Eigen::Vector3d::Zero());
  std::ranges::fill(beams.times_ns, 0U);
}

void set_rings(const Spinning& s, Beams& beams) {
  const std::vector<std::size_t> rows = rows_of(s);
  for (std::size_t i = 0; i < beams.rings.size(); ++i)
    beams.rings[i] = s.channels[rows[i / beams.cols]].ring;
}

void visit_start_azimuth(FieldVisitor& visitor, Spinning& s) {
  constexpr NumberRule kAzimuth = {-360.0, 360.0, false, "degrees from -360 to 360"};
  if (visitor.is_document() && !s.start_azimuth_rad) return;
  double azimuth_rad =
      visitor.is_report() ? azimuth_at_start_rad(s) : s.start_azimuth_rad.value_or(0.0);
  visitor.number({"start_azimuth_deg", "direction of the head at time 0", kUnitDegree, false,
                  "0; the start of the sweep with `azimuth_range`"},
                 kAzimuth, azimuth_rad);
  if (visitor.is_reading() && visitor.has("start_azimuth_deg")) s.start_azimuth_rad = azimuth_rad;
}

/// What starts a firing sequence: the encoder or a clock.
void visit_column_timing(FieldVisitor& visitor, Spinning& s) {
  const bool is_known = visitor.is_reading() && s.columns_per_turn > 0;  // by a calibration
  visitor.at_most_one({.keys = {"columns_per_turn", "firing_period_us"},
                       .allowed = "one of columns_per_turn and firing_period_us",
                       .missing = is_known ? nullptr : "the time between columns is missing",
                       .remedy = "add 'columns_per_turn: ...'",
                       .supplier = "calibration_file"});
  visitor.whole_number(
      {"columns_per_turn", "columns at equal angles", kNoUnit, false, "this or `firing_period_us`"},
      {1, kMaxColumnsPerTurn}, s.columns_per_turn);
  double period_ns = s.columns_per_turn > 0 ? 0.0 : s.firing_period_ns;
  if (visitor.is_report()) period_ns = sequence_period_ns(s);
  visitor.number({"firing_period_us", "time between firing sequences", kUnitMicrosecond_ns, false,
                  "this or `columns_per_turn`"},
                 {1e-3, 1e6, false, "microseconds from 0.001 to 1e6"}, period_ns);
  if (visitor.is_reading()) s.firing_period_ns = period_ns;
}

}  // namespace

double range_offset_m(const Spinning& s) {
  const double height_m = s.beam_origin_height_m;
  if (height_m == 0.0) return s.beam_origin_m;
  return std::sqrt(s.beam_origin_m * s.beam_origin_m + height_m * height_m);
}

double sequence_period_ns(const Spinning& s) {
  return s.columns_per_turn > 0 ? kSecond_ns / (s.rotation_hz * s.columns_per_turn)
                                : s.firing_period_ns;
}

double azimuth_at_start_rad(const Spinning& s) {
  if (s.start_azimuth_rad) return *s.start_azimuth_rad;
  if (s.azimuth_width_rad >= kTwoPi) return 0.0;
  const bool is_clockwise = s.rotation_direction == Spinning::RotationDirection::clockwise;
  const double first_rad = s.azimuth_start_rad + (is_clockwise ? s.azimuth_width_rad : 0.0);
  // a sequence at time 0 whose first channel fires earlier would be in the frame before
  const double late = std::max(0.0, std::ceil(-first_firing_ns(s) / sequence_period_ns(s)));
  return first_rad - rotation_sign(s) * kTwoPi * late * step_turns(s);
}

bool is_in_sector(const Spinning& s, std::int64_t k) {
  constexpr double kTolerance = 1e-3;  // of a step
  const double tolerance = kTolerance * step_turns(s);
  const double width = s.azimuth_width_rad / kTwoPi;
  if (width + 2.0 * tolerance >= 1.0) return true;
  const double from_start =
      (head_azimuth_rad(s, turn_fraction(s, k)) - s.azimuth_start_rad) / kTwoPi;
  const double into = from_start - std::floor(from_start);
  return into <= width + tolerance || into >= 1.0 - tolerance;
}

Beams make_beams(const Spinning& s, const FrameInterval& interval) {
  validate(s);
  const std::vector<std::int64_t> sequences = sequences_in(s, interval);
  Beams beams = make_grid(s, sequences.size());
  set_rings(s, beams);
  if (!s.firing_loops.empty()) clear_beams(beams);
  for (std::size_t loop = 0; loop < std::max<std::size_t>(1, s.firing_loops.size()); ++loop)
    set_loop(s, loop, columns_of(s, sequences, loop), interval, beams);
  return beams;
}

void describe(FiringLoop& loop, FieldVisitor& visitor) {
  constexpr NumberRule kChannel = {0.0, kMaxChannels - 1.0, false, "a channel, counted from 0"};
  constexpr NumberRule kFireTime = {-1e6, 1e6, false, "microseconds from -1e6 to 1e6"};
  std::vector<double> channels(loop.channels.begin(), loop.channels.end());
  visitor.numbers({"channels", "channels that fire, counted from 0", kNoUnit, kRequired},
                  {.number = kChannel, .max_size = kMaxChannels}, channels);
  visitor.numbers({"fire_time_us", "firing time of each of them after the start of the sequence",
                   kUnitMicrosecond_ns, kRequired},
                  {.number = kFireTime, .max_size = kMaxChannels}, loop.fire_times_ns);
  if (!visitor.is_reading()) return;
  if (channels.size() != loop.fire_times_ns.size())
    visitor.reject("fire_time_us", std::to_string(loop.fire_times_ns.size()) + " numbers",
                   std::to_string(channels.size()) + ": one for each of channels");
  loop.channels.clear();
  for (const double channel : channels) {
    if (channel != std::floor(channel))
      visitor.reject("channels", "a channel that is not a whole number", "whole numbers from 0");
    loop.channels.push_back(static_cast<std::uint32_t>(channel));
  }
}

void describe(Spinning& s, FieldVisitor& visitor) {
  using Direction = Spinning::RotationDirection;
  constexpr std::array<Named<Direction>, 2> kDirections = {
      {{"clockwise", Direction::clockwise}, {"counterclockwise", Direction::counterclockwise}}};
  constexpr NumberRule kOffset = {-1e4, 1e4, false, "millimetres from -1e4 to 1e4"};
  if (visitor.is_report())
    visitor.number({"rotation_hz", "turns per second", kUnitHertz}, kAboveZero, s.rotation_hz);
  visit_choice(visitor, {"rotation_direction", "rotation seen from above"}, kDirections,
               s.rotation_direction);
  visit_start_azimuth(visitor, s);
  visit_column_timing(visitor, s);
  visitor.number(
      {"beam_origin_mm",
       "distance from the axis to the origin of all beams; ranges are measured from the axis",
       kUnitMillimetre},
      kOffset, s.beam_origin_m);
  visitor.number({"beam_origin_height_mm",
                  "height of the origin of all beams; ranges are measured from the sensor's origin",
                  kUnitMillimetre},
                 kOffset, s.beam_origin_height_m);
  visit_azimuth_range(visitor, s);
  visit_channels(visitor, s.channels);
  if (visitor.is_document() && s.firing_loops.empty()) return;
  visit_list(visitor,
             {"firing_loops",
              "firing sequences that take turns, instead of `fire_time_us`: each fires some of the "
              "channels",
              kNoUnit, false, "none"},
             {0, kMaxFiringLoops}, "a list of up to 64 loops", s.firing_loops);
}

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
