// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/packet_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kMaxEntries = std::size_t{1} << 22U;  // of a revolution, to bound memory
constexpr double kMaxStepBack_rad = 0.01;  // by which rounded azimuths can decrease

[[noreturn]] void fail_of_beams(const Sensor& sensor, std::string found, std::string allowed) {
  throw Error({"packets of " + sensor.name, std::move(found), std::move(allowed),
               "encode the frames of the sensor that the encoder was made for"});
}

/// The laser of every row of make_beams().
std::vector<std::size_t> lasers_of_rows(const Sensor& sensor, std::span<const std::uint16_t> rings,
                                        std::size_t cols) {
  const Spinning& spinning = std::get<Spinning>(sensor.optics);
  std::vector<std::size_t> laser_of_ring;
  std::vector<std::size_t> lasers;
  for (const SpinningChannel& channel : spinning.channels) {
    if (channel.ring >= laser_of_ring.size()) laser_of_ring.resize(channel.ring + 1U, SIZE_MAX);
    std::size_t& laser = laser_of_ring[channel.ring];
    if (laser != SIZE_MAX) fail_of_beams(sensor, "two channels of one ring", "a ring per channel");
    laser = static_cast<std::size_t>(&channel - spinning.channels.data());
  }
  for (std::size_t row = 0; row < spinning.channels.size(); ++row) {
    const std::uint16_t ring = rings[row * cols];
    const std::size_t laser = ring < laser_of_ring.size() ? laser_of_ring[ring] : SIZE_MAX;
    if (laser == SIZE_MAX) fail_of_beams(sensor, "beams of another ring", "the sensor's rings");
    lasers.push_back(laser);
  }
  return lasers;
}

void check_beams(const Sensor& sensor, const Frame& frame, const Beams& beams) {
  const std::size_t lasers = std::get<Spinning>(sensor.optics).channels.size();
  const std::size_t rows = lasers * sensor.receiver.returns.size();
  if (beams.rows != rows || beams.returns != sensor.receiver.returns.size()) {
    fail_of_beams(sensor, std::to_string(beams.rows) + " rows of beams",
                  std::to_string(rows) + ": lasers times returns");
  }
  const std::size_t size = std::size_t{beams.rows} * beams.cols;
  if (beams.size() != size || beams.times_ns.size() != size || beams.rings.size() != size ||
      frame.range_m.size() != size || frame.intensity.size() != size) {
    fail_of_beams(sensor, "a frame of other size than its beams", "one entry per beam");
  }
}

/// The byte of calibrated reflectivity of every entry, as the layout `velodyne` has it.
std::vector<float> reflectivity_bytes(const Sensor& sensor, const Frame& frame,
                                      const Beams& beams) {
  std::vector<double> ranges_m = frame.range_m;
  for (double& range_m : ranges_m) range_m += beams.range_offset_m;
  PointCloud cloud;
  cloud.rows = beams.rows;
  cloud.cols = beams.cols;
  cloud.columns = {{"intensity", {"intensity"}, frame.intensity},
                   {"range", {"range"}, std::move(ranges_m)}};
  return unit_intensities(cloud, sensor, beams);
}

std::uint8_t byte_of(float unit) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(unit, 0.0F, 1.0F)));
}

}  // namespace

const Spinning& spinning_optics(const Sensor& sensor, const char* packets) {
  if (const auto* spinning = std::get_if<Spinning>(&sensor.optics)) return *spinning;
  throw Error(
      {sensor.name, "optics that do not spin", std::string("a spinning LiDAR for ") + packets});
}

double turn_rate_rad_per_ns(const Spinning& spinning) {
  const bool is_clockwise = spinning.rotation_direction == Spinning::RotationDirection::clockwise;
  return (is_clockwise ? -kTwoPi : kTwoPi) * spinning.rotation_hz / kSecond_ns;
}

std::vector<FiringSequence> firing_sequences(const Sensor& sensor, const Frame& frame,
                                             const Beams& beams, double unit_m) {
  check_beams(sensor, frame, beams);
  std::vector<FiringSequence> sequences(beams.cols);
  if (beams.cols == 0) return sequences;
  const Spinning& spinning = std::get<Spinning>(sensor.optics);
  const std::size_t lasers = spinning.channels.size();
  const std::vector<std::size_t> laser_of_row = lasers_of_rows(sensor, beams.rings, beams.cols);
  const std::vector<float> unit = reflectivity_bytes(sensor, frame, beams);
  for (FiringSequence& sequence : sequences) sequence.returns.resize(beams.rows);
  for (std::size_t row = 0; row < beams.rows; ++row) {
    const std::size_t laser = laser_of_row[row % lasers];
    const std::size_t at = row / lasers * lasers + laser;
    const double correction_m = spinning.channels[laser].distance_correction_m;
    const double added_m = beams.range_offset_m - correction_m;
    Limits limits = sensor.limits;  // of what is sent
    limits.near_m -= correction_m;
    limits.far_m -= correction_m;
    for (std::size_t col = 0; col < beams.cols; ++col) {
      const std::size_t entry = row * beams.cols + col;
      if (!(frame.range_m[entry] > 0.0)) continue;
      const double units =
          to_whole_units(limits, Limits::Along::range, frame.range_m[entry] + added_m, unit_m);
      PacketReturn& sent = sequences[col].returns[at];
      sent = {units * unit_m, frame.intensity[entry], byte_of(unit[entry])};
      if (frame.ground_truth.colour.empty()) continue;
      const Eigen::Vector3f& colour = frame.ground_truth.colour[entry];
      sent.colour = {colour.x(), colour.y(), colour.z()};
    }
  }
  // the row that fires first: the least error of the rotation until it fires
  const auto fires_before = [&](std::size_t a, std::size_t b) {
    return std::abs(spinning.channels[a].fire_time_ns) <
           std::abs(spinning.channels[b].fire_time_ns);
  };
  const auto first_row = static_cast<std::size_t>(
      std::min_element(laser_of_row.begin(), laser_of_row.end(), fires_before) -
      laser_of_row.begin());
  const SpinningChannel& first = spinning.channels[laser_of_row[first_row]];
  for (std::size_t col = 0; col < beams.cols; ++col) {
    const std::size_t entry = first_row * beams.cols + col;
    const Eigen::Vector3d& direction = beams.directions[entry];
    sequences[col].stamp_ns =
        frame.stamp_ns + beams.times_ns[entry] - std::llround(first.fire_time_ns);
    sequences[col].azimuth_rad = portable_atan2(direction.y(), direction.x()) -
                                 first.azimuth_offset_rad -
                                 turn_rate_rad_per_ns(spinning) * first.fire_time_ns;
  }
  return sequences;
}

RevolutionAssembler::RevolutionAssembler(const Sensor& sensor, bool follow_rotation,
                                         bool has_colour)
    : sensor_(sensor),
      spinning_(spinning_optics(sensor, "packets")),
      follow_rotation_(follow_rotation),
      hit_columns_{.colour = has_colour} {
  const auto period_ns = static_cast<std::int64_t>(std::ceil(sequence_period_ns(spinning_)));
  Spinning whole_turn = spinning_;
  whole_turn.azimuth_width_rad = kTwoPi;
  const Beams beams = make_beams(whole_turn, {0, 2 * period_ns});
  laser_of_row_ = lasers_of_rows(sensor_, beams.rings, beams.cols);
  max_sequences_ = kMaxEntries / (spinning_.channels.size() * sensor_.receiver.returns.size());
}

double RevolutionAssembler::phase(double azimuth_rad) const {
  const double sign = turn_rate_rad_per_ns(spinning_) < 0.0 ? -1.0 : 1.0;
  const double turned = std::fmod(sign * (azimuth_rad - azimuth_at_start_rad(spinning_)), kTwoPi);
  return turned < 0.0 ? turned + kTwoPi : turned;
}

void RevolutionAssembler::add(FiringSequence sequence, std::vector<DecodedFrame>& frames) {
  if (!sequences_.empty()) {
    const double before = phase(sequences_.back().azimuth_rad);
    const bool is_new_turn = phase(sequence.azimuth_rad) < before - std::numbers::pi;
    const std::int64_t age_ns = sequence.stamp_ns - sequences_.front().stamp_ns;
    // times since the frame's start have 32 bits
    const bool fits = age_ns >= 0 && age_ns < std::int64_t{4'000'000'000};
    if (is_new_turn || !fits || sequences_.size() >= max_sequences_) emit(frames);
  }
  sequences_.push_back(std::move(sequence));
}

void RevolutionAssembler::finish(std::vector<DecodedFrame>& frames) {
  if (!sequences_.empty()) emit(frames);
}

/// Radians per nanosecond around a sequence, from the azimuths of its neighbours.
double RevolutionAssembler::turn_rate(std::size_t at) const {
  constexpr std::size_t kReach = 12;
  const FiringSequence& from = sequences_[at < kReach ? 0 : at - kReach];
  const FiringSequence& to = sequences_[std::min(at + kReach, sequences_.size() - 1)];
  const double nominal = turn_rate_rad_per_ns(spinning_);
  const auto time_ns = static_cast<double>(to.stamp_ns - from.stamp_ns);
  if (!(time_ns > 0.0)) return nominal;
  const double sign = nominal < 0.0 ? -1.0 : 1.0;
  double turned = std::fmod(sign * (to.azimuth_rad - from.azimuth_rad), kTwoPi);
  if (turned < -kMaxStepBack_rad) turned += kTwoPi;
  return sign * std::max(0.0, turned) / time_ns;
}

void RevolutionAssembler::fill_column(std::size_t col, DecodedFrame& made) const {
  const FiringSequence& sequence = sequences_[col];
  const double rate = follow_rotation_ ? turn_rate(col) : 0.0;
  const std::size_t lasers = spinning_.channels.size();
  for (std::size_t row = 0; row < made.beams.rows; ++row) {
    const std::size_t laser = laser_of_row_[row % lasers];
    const SpinningChannel& channel = spinning_.channels[laser];
    const std::size_t entry = row * made.beams.cols + col;
    const double head_rad = sequence.azimuth_rad + rate * channel.fire_time_ns;
    const double azimuth_rad = head_rad + channel.azimuth_offset_rad;
    const Eigen::Vector3d out = direction_at(azimuth_rad, 0.0);
    const Eigen::Vector3d left(-out.y(), out.x(), 0.0);
    made.beams.directions[entry] = direction_at(azimuth_rad, channel.elevation_rad);
    made.beams.origins_m[entry] =
        spinning_.beam_origin_m * direction_at(head_rad, 0.0) + channel.origin_m.x() * out +
        channel.origin_m.y() * left +
        (spinning_.beam_origin_height_m + channel.origin_m.z()) * Eigen::Vector3d::UnitZ();
    made.beams.rings[entry] = channel.ring;
    const std::int64_t time_ns =
        sequence.stamp_ns + std::llround(channel.fire_time_ns) - made.frame.stamp_ns;
    made.beams.times_ns[entry] =
        static_cast<std::uint32_t>(std::clamp<std::int64_t>(time_ns, 0, UINT32_MAX));
    const PacketReturn& found = sequence.returns[row / lasers * lasers + laser];
    if (found.range_m > 0.0) {
      made.frame.range_m[entry] =
          found.range_m + channel.distance_correction_m - made.beams.range_offset_m;
      made.frame.intensity[entry] = found.intensity;
      made.frame.status[entry] = Status::hit;
      if (hit_columns_.colour)
        made.frame.ground_truth.colour[entry] = Eigen::Vector3f(found.colour.data());
    } else {
      invalidate_return(made.frame, entry, row < lasers ? Status::miss : Status::no_return_of_rank);
    }
  }
}

void RevolutionAssembler::emit(std::vector<DecodedFrame>& frames) {
  DecodedFrame made;
  const std::size_t returns = sensor_.receiver.returns.size();
  double first_fire_ns = spinning_.channels.front().fire_time_ns;
  for (const SpinningChannel& channel : spinning_.channels)
    first_fire_ns = std::min(first_fire_ns, channel.fire_time_ns);
  made.beams.rows = static_cast<std::uint32_t>(spinning_.channels.size() * returns);
  made.beams.cols = static_cast<std::uint32_t>(sequences_.size());
  made.beams.returns = static_cast<std::uint32_t>(returns);
  made.beams.frame_id = "lidar_frame";
  made.beams.boresight = Eigen::Vector3d::UnitX();
  made.beams.range_offset_m = range_offset_m(spinning_);
  const std::size_t size = std::size_t{made.beams.rows} * made.beams.cols;
  made.beams.directions.resize(size);
  made.beams.origins_m.resize(size);
  made.beams.times_ns.resize(size);
  made.beams.rings.resize(size);
  resize(made.frame, size);
  resize(made.frame.ground_truth, size, hit_columns_);
  write_misses(hit_columns_, 0, size, made.frame.ground_truth);  // packets have no other columns
  made.frame.rows = made.beams.rows;
  made.frame.cols = made.beams.cols;
  made.frame.frame_id = made.beams.frame_id;
  made.frame.number = number_++;
  made.frame.stamp_ns = sequences_.front().stamp_ns + std::llround(first_fire_ns);
  for (std::size_t col = 0; col < sequences_.size(); ++col) fill_column(col, made);
  sequences_.clear();
  frames.push_back(std::move(made));
}

namespace {

[[noreturn]] void fail_of_returns(const std::string& packets) {
  throw Error({packets, "receiver.returns that these packets cannot have",
               "[strongest], [farthest], or both",
               "set receiver.returns in a copy of the sensor file"});
}

}  // namespace

ReturnSelection select_packet_returns(const Sensor& sensor, const std::string& packets) {
  const std::vector<Return>& returns = sensor.receiver.returns;
  if (returns.empty() || returns.size() > 2) fail_of_returns(packets);
  ReturnSelection selection;
  bool has_strongest = false;
  bool has_last = false;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const Return::Order order = returns[i].order;
    if (returns[i].rank != 0 || order == Return::Order::nearest) fail_of_returns(packets);
    bool& is_known = order == Return::Order::strongest ? has_strongest : has_last;
    if (is_known) fail_of_returns(packets);
    is_known = true;
    (order == Return::Order::strongest ? selection.strongest : selection.last) = i;
  }
  if (has_last) selection.mode = has_strongest ? PacketReturnMode::dual : PacketReturnMode::last;
  return selection;
}

LastAndStrongest last_and_strongest(const FiringSequence& sequence, std::size_t lasers,
                                    std::size_t laser) {
  LastAndStrongest found{sequence.returns[laser], sequence.returns[lasers + laser]};
  if (!(found.last.range_m > 0.0)) found.last = found.strongest;
  if (!(found.strongest.range_m > 0.0)) found.strongest = found.last;
  if (found.last.range_m < found.strongest.range_m) std::swap(found.last, found.strongest);
  return found;
}

void store_returns(const LastAndStrongest& found, const ReturnSelection& selection,
                   std::size_t lasers, std::size_t laser, FiringSequence& sequence) {
  if (found.last.range_m == found.strongest.range_m) {
    sequence.returns[laser] = found.strongest;
    return;
  }
  sequence.returns[selection.strongest * lasers + laser] = found.strongest;
  sequence.returns[selection.last * lasers + laser] = found.last;
}

}  // namespace glidar
