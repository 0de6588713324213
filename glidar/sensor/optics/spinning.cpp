// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/spinning.hpp>

#include <algorithm>
#include <cmath>
#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/spinning_keys.hpp>
#include <numeric>

namespace glidar {
namespace {

constexpr double kMaxTurns_hz = 1e4;

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

void validate(const Spinning& s) {
  require_number(!s.channels.empty() && s.channels.size() <= kMaxChannels,
                 "optics, number of channels", static_cast<double>(s.channels.size()), "1 to 4096");
  require_number(s.rotation_hz > 0.0 && s.rotation_hz <= kMaxTurns_hz, "optics, rotation",
                 s.rotation_hz, "above 0, up to 1e4 turns per second");
  require_number(std::isfinite(s.start_azimuth_rad), "optics, start azimuth", s.start_azimuth_rad,
                 "a finite angle");
  require_number(std::abs(s.beam_origin_m) <= 1e3, "optics, beam origin", s.beam_origin_m,
                 "-1000 to 1000 m");
  require_number(std::isfinite(s.azimuth_start_rad) && s.azimuth_width_rad > 0.0,
                 "optics, azimuth_range", s.azimuth_width_rad,
                 "a finite start and a width above 0");
  for (const SpinningChannel& channel : s.channels) validate(channel);
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

/// Azimuth of the head at the start of sequence k.
double head_azimuth_rad(const Spinning& s, std::int64_t k) {
  return s.start_azimuth_rad + rotation_sign(s) * kTwoPi * turn_fraction(s, k);
}

bool is_in_sector(const Spinning& s, double azimuth_rad) {
  if (s.azimuth_width_rad >= kTwoPi) return true;
  const double into = std::fmod(azimuth_rad - s.azimuth_start_rad, kTwoPi);
  return (into < 0.0 ? into + kTwoPi : into) <= s.azimuth_width_rad;
}

double first_firing_ns(const Spinning& s) {
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
    if (is_in_sector(s, head_azimuth_rad(s, k))) sequences.push_back(k);
  }
  return sequences;
}

bool has_origins(const Spinning& s) {
  return s.beam_origin_m != 0.0 ||
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
  beams.range_offset_m = s.beam_origin_m;
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

/// The beams of a row, beginning at index `first`. Sines and cosines take most of the time, so each
/// is computed once.
void set_row(const Spinning& s, const SpinningChannel& channel, const Heads& heads,
             std::size_t first, Beams& beams) {
  const double level = std::cos(channel.elevation_rad);
  const double height = std::sin(channel.elevation_rad);
  const Eigen::Vector3d& offset = channel.origin_m;
  for (std::size_t col = 0; col < heads.azimuths_rad.size(); ++col) {
    const std::size_t i = first + col;
    const Eigen::Vector3d out =
        direction_at(heads.azimuths_rad[col] + channel.azimuth_offset_rad, 0.0);
    beams.directions[i] = Eigen::Vector3d(level * out.x(), level * out.y(), height).normalized();
    beams.rings[i] = channel.ring;
    if (beams.origins_m.empty()) continue;
    const Eigen::Vector3d left(-out.y(), out.x(), 0.0);
    beams.origins_m[i] = s.beam_origin_m * heads.directions[col] + offset.x() * out +
                         offset.y() * left + offset.z() * Eigen::Vector3d::UnitZ();
  }
}

/// What starts a firing sequence: the encoder or a clock.
void visit_column_timing(FieldVisitor& visitor, Spinning& s) {
  visitor.at_most_one({{"columns_per_turn", "firing_period_us"},
                       "one of columns_per_turn and firing_period_us",
                       "the time between columns is missing",
                       "add 'columns_per_turn: ...'"});
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

double sequence_period_ns(const Spinning& s) {
  return s.columns_per_turn > 0 ? kSecond_ns / (s.rotation_hz * s.columns_per_turn)
                                : s.firing_period_ns;
}

Beams make_beams(const Spinning& s, const FrameInterval& interval) {
  validate(s);
  const std::vector<std::size_t> rows = rows_of(s);
  const std::vector<std::int64_t> sequences = sequences_in(s, interval);
  const double period_ns = sequence_period_ns(s);
  Beams beams = make_grid(s, sequences.size());
  std::vector<double> starts_rad;
  for (const std::int64_t k : sequences) starts_rad.push_back(head_azimuth_rad(s, k));
  Heads heads;
  double known_ns = kNaN;  // of `heads`; channels often fire together
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const SpinningChannel& channel = s.channels[rows[row]];
    const std::size_t first = row * sequences.size();
    if (channel.fire_time_ns != known_ns) {
      heads = find_heads(s, starts_rad, channel.fire_time_ns);
      known_ns = channel.fire_time_ns;
    }
    set_row(s, channel, heads, first, beams);
    const FiringSchedule firings = {channel.fire_time_ns, period_ns};
    for (std::size_t col = 0; col < sequences.size(); ++col) {
      beams.times_ns[first + col] =
          static_cast<std::uint32_t>(firing_time_ns(firings, sequences[col]) - interval.start_ns);
    }
  }
  return beams;
}

void describe(Spinning& s, FieldVisitor& visitor) {
  using Direction = Spinning::RotationDirection;
  constexpr std::array<Named<Direction>, 2> kDirections = {
      {{"clockwise", Direction::clockwise}, {"counterclockwise", Direction::counterclockwise}}};
  constexpr NumberRule kAzimuth = {-360.0, 360.0, false, "degrees from -360 to 360"};
  constexpr NumberRule kOffset = {-1e4, 1e4, false, "millimetres from -1e4 to 1e4"};
  if (visitor.is_report())
    visitor.number({"rotation_hz", "turns per second", kUnitHertz}, kAboveZero, s.rotation_hz);
  visit_choice(visitor, {"rotation_direction", "rotation seen from above"}, kDirections,
               s.rotation_direction);
  visitor.number({"start_azimuth_deg", "direction of the head at time 0", kUnitDegree}, kAzimuth,
                 s.start_azimuth_rad);
  visit_column_timing(visitor, s);
  visitor.number(
      {"beam_origin_mm",
       "distance from the axis to the origin of all beams; ranges are measured from the axis",
       kUnitMillimetre},
      kOffset, s.beam_origin_m);
  visit_azimuth_range(visitor, s);
  visit_channels(visitor, s.channels);
}

}  // namespace glidar
