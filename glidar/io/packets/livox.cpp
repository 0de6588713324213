// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/livox.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <zlib.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kLivoxHead = 36;
constexpr std::size_t kChecksumAt = 24;
constexpr std::size_t kStampAt = 28;
constexpr std::size_t kImuSample = 24;

/// Bytes of the three numbers of a point.
std::array<std::size_t, 3> number_bytes(LivoxDataType type) {
  if (type == LivoxDataType::cartesian_mm) return {4, 4, 4};
  if (type == LivoxDataType::cartesian_cm) return {2, 2, 2};
  return {4, 2, 2};
}

std::size_t livox_point_bytes(LivoxDataType type) {
  const std::array<std::size_t, 3> numbers = number_bytes(type);
  return numbers[0] + numbers[1] + numbers[2] + 2;
}

std::int64_t signed_number(std::uint64_t bits, std::size_t bytes) {
  if (bytes == 4) return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

LivoxPoint get_point(ByteView bytes, LivoxDataType type) {
  LivoxPoint point;
  std::size_t at = 0;
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::uint64_t bits = get_little(bytes, at, sizes[i]);
    const bool is_signed = type != LivoxDataType::spherical;
    point.numbers[i] = is_signed ? signed_number(bits, sizes[i]) : static_cast<std::int64_t>(bits);
    at += sizes[i];
  }
  point.reflectivity = get<std::uint8_t>(bytes, at);
  point.tag = get<std::uint8_t>(bytes, at + 1);
  return point;
}

void put_point(Bytes& bytes, const LivoxPoint& point, LivoxDataType type) {
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    put_little(bytes, static_cast<std::uint64_t>(point.numbers[i]), sizes[i]);
  put_little(bytes, point.reflectivity, 1);
  put_little(bytes, point.tag, 1);
}

[[noreturn]] void fail_of_packet(std::string found, std::string allowed) {
  throw Error({"Livox packet", std::move(found), std::move(allowed)});
}

void check_head(ByteView payload) {
  if (payload.size() < kLivoxHead)
    fail_of_packet(std::to_string(payload.size()) + " bytes", "at least 36 bytes");
  if (get<std::uint8_t>(payload, 0) != 0)
    fail_of_packet("version " + std::to_string(get<std::uint8_t>(payload, 0)), "0");
  if (get<std::uint16_t>(payload, 1) != payload.size())
    fail_of_packet("a length of " + std::to_string(get<std::uint16_t>(payload, 1)),
                   std::to_string(payload.size()) + ", the bytes received");
  if (get<std::uint8_t>(payload, 10) > static_cast<std::uint8_t>(LivoxDataType::spherical))
    fail_of_packet("data type " + std::to_string(get<std::uint8_t>(payload, 10)), "0 to 3");
  if (get<std::uint32_t>(payload, kChecksumAt) != livox_crc32(payload.subspan(kStampAt)))
    throw Error({"Livox packet", "a wrong CRC-32", "", "discard the packet: it is damaged"});
}

}  // namespace

bool fits(const LivoxPoint& point, LivoxDataType type) {
  const std::array<std::size_t, 3> sizes = number_bytes(type);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::int64_t values = std::int64_t{1} << (8 * sizes[i]);
    const bool is_signed = type != LivoxDataType::spherical;
    const std::int64_t min = is_signed ? -values / 2 : 0;
    if (point.numbers[i] < min || point.numbers[i] >= min + values) return false;
  }
  return true;
}

std::uint32_t livox_crc32(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()),
                                              static_cast<z_size_t>(bytes.size())));
}

std::vector<std::byte> encode(const LivoxPacket& packet) {
  Bytes rest;
  put_little(rest, packet.stamp_ns, 8);
  if (packet.type == LivoxDataType::imu) {
    for (const float value : packet.rate_rad_s) put_float(rest, value);
    for (const float value : packet.acceleration_g) put_float(rest, value);
  }
  for (const LivoxPoint& point : packet.points) put_point(rest, point, packet.type);
  const bool is_imu = packet.type == LivoxDataType::imu;
  Bytes bytes;
  put_little(bytes, 0, 1);
  put_little(bytes, kStampAt + rest.size(), 2);
  put_little(bytes, packet.interval, 2);
  put_little(bytes, is_imu ? 1 : packet.points.size(), 2);
  put_little(bytes, packet.count, 2);
  put_little(bytes, packet.frame, 1);
  put_little(bytes, static_cast<std::uint8_t>(packet.type), 1);
  put_little(bytes, packet.time_type, 1);
  put_zeros(bytes, 12);
  put_little(bytes, livox_crc32(rest), 4);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

LivoxPacket decode_livox_packet(std::span<const std::byte> payload) {
  check_head(payload);
  LivoxPacket packet;
  packet.interval = get<std::uint16_t>(payload, 3);
  packet.count = get<std::uint16_t>(payload, 7);
  packet.frame = get<std::uint8_t>(payload, 9);
  packet.type = static_cast<LivoxDataType>(get<std::uint8_t>(payload, 10));
  packet.time_type = get<std::uint8_t>(payload, 11);
  packet.stamp_ns = get<std::uint64_t>(payload, kStampAt);
  const std::size_t points = get<std::uint16_t>(payload, 5);
  const bool is_imu = packet.type == LivoxDataType::imu;
  const std::size_t size = is_imu ? kImuSample : livox_point_bytes(packet.type);
  if (points == 0 || (is_imu && points != 1) || payload.size() != kLivoxHead + points * size)
    fail_of_packet(
        std::to_string(points) + " points in " + std::to_string(payload.size()) + " bytes",
        "36 bytes and " + std::to_string(size) + " for each point");
  for (std::size_t i = 0; i < 3 && is_imu; ++i) {
    packet.rate_rad_s[i] = get_float(payload, kLivoxHead + 4 * i);
    packet.acceleration_g[i] = get_float(payload, kLivoxHead + 12 + 4 * i);
  }
  for (std::size_t i = 0; i < points && !is_imu; ++i)
    packet.points.push_back(get_point(payload.subspan(kLivoxHead + i * size, size), packet.type));
  return packet;
}

namespace {

struct AssembledPoint {
  Eigen::Vector3d xyz_m;  ///< in the sensor frame; zero: no return
  float intensity = 0.0F;
};

/// Collects the points of firings and joins those of a frame period to a frame.
class PointAssembler {
 public:
  /// `rows`: points of a firing.
  PointAssembler(std::size_t rows, double rate_hz);

  /// Adds the next firing in time; appends the frame before it if it begins a new one.
  void add(std::int64_t stamp_ns, std::span<const AssembledPoint> points,
           std::vector<DecodedFrame>& frames);
  void finish(std::vector<DecodedFrame>& frames);

 private:
  void emit(std::vector<DecodedFrame>& frames);

  std::size_t rows_;
  double period_ns_;
  std::uint32_t number_ = 0;
  double start_ns_ = 0.0;                ///< of the frame, after the epoch
  std::int64_t epoch_ns_ = 0;            ///< a firing to which frames are aligned
  std::vector<std::int64_t> stamps_ns_;  ///< of the firings
  std::vector<AssembledPoint> points_;   ///< firings x rows
};

constexpr std::size_t kMaxPoints = std::size_t{1} << 22U;  // of a frame, to bound memory
constexpr double kMaxPeriod_ns = 4e9;  // times since the frame's start have 32 bits

void store(const AssembledPoint& point, std::size_t entry, DecodedFrame& made) {
  const double range_m = point.xyz_m.norm();
  if (range_m > 0.0) {
    made.beams.directions[entry] = point.xyz_m / range_m;
    made.frame.range_m[entry] = range_m;
    made.frame.intensity[entry] = point.intensity;
    made.frame.status[entry] = Status::hit;
    return;
  }
  made.beams.directions[entry].setConstant(std::numeric_limits<double>::quiet_NaN());
  invalidate_return(made.frame, entry, Status::miss);
}

PointAssembler::PointAssembler(std::size_t rows, double rate_hz)
    : rows_(rows), period_ns_(std::min(kSecond_ns / rate_hz, kMaxPeriod_ns)) {}

void PointAssembler::add(std::int64_t stamp_ns, std::span<const AssembledPoint> points,
                         std::vector<DecodedFrame>& frames) {
  const auto age_ns = static_cast<double>(stamp_ns - epoch_ns_) - start_ns_;
  const bool joins = !stamps_ns_.empty() && stamp_ns >= stamps_ns_.back() &&
                     age_ns < 2.0 * period_ns_ && points_.size() < kMaxPoints;
  if (joins && age_ns >= period_ns_) {
    emit(frames);
    start_ns_ += period_ns_;
  } else if (!joins) {
    finish(frames);
    epoch_ns_ = stamp_ns;
    start_ns_ = 0.0;
  }
  stamps_ns_.push_back(stamp_ns);
  points_.insert(points_.end(), points.begin(), points.end());
}

void PointAssembler::finish(std::vector<DecodedFrame>& frames) {
  if (!stamps_ns_.empty()) emit(frames);
}

void PointAssembler::emit(std::vector<DecodedFrame>& frames) {
  DecodedFrame made;
  const std::size_t cols = stamps_ns_.size();
  made.beams.rows = static_cast<std::uint32_t>(rows_);
  made.beams.cols = static_cast<std::uint32_t>(cols);
  made.beams.frame_id = "lidar_frame";
  made.beams.boresight = Eigen::Vector3d::UnitX();
  made.beams.directions.resize(points_.size());
  made.beams.times_ns.resize(points_.size());
  made.beams.rings.resize(points_.size());
  resize(made.frame, points_.size());
  resize(made.frame.ground_truth, points_.size(), {});
  write_misses({}, 0, points_.size(), made.frame.ground_truth);  // packets have none
  made.frame.rows = made.beams.rows;
  made.frame.cols = made.beams.cols;
  made.frame.frame_id = made.beams.frame_id;
  made.frame.number = number_++;
  made.frame.stamp_ns = stamps_ns_.front();
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const std::size_t entry = row * cols + col;
      made.beams.rings[entry] = static_cast<std::uint16_t>(row);
      made.beams.times_ns[entry] = static_cast<std::uint32_t>(stamps_ns_[col] - stamps_ns_.front());
      store(points_[col * rows_ + row], entry, made);
    }
  }
  stamps_ns_.clear();
  points_.clear();
  frames.push_back(std::move(made));
}

constexpr double kCentimetre_m = 0.01;
constexpr double kCentidegreesPerTurn = 36'000.0;
constexpr std::int64_t kInterval_ns = 100;  // unit of LivoxPacket::interval
constexpr std::byte kCommandStart{0xAA};    // of packets on the ports of commands

[[noreturn]] void fail_of_livox(const Sensor& sensor, std::string found, std::string allowed,
                                std::string remedy) {
  throw Error(
      {"Livox packets of " + sensor.name, std::move(found), std::move(allowed), std::move(remedy)});
}

/// What packets need to know of the optics.
struct LivoxOptics {
  std::size_t beams = 0;  ///< that fire at once
  double pulse_hz = 0.0;  ///< of each beam
};

std::optional<LivoxOptics> livox_optics(const Optics& optics) {
  if (const auto* prism = std::get_if<Prism>(&optics))
    return LivoxOptics{prism->incidence_rad.size(), prism->pulse_hz};
  if (const auto* mirror = std::get_if<WedgeMirror>(&optics))
    return LivoxOptics{mirror->incidence_rad.size(), mirror->pulse_hz};
  return std::nullopt;
}

LivoxOptics checked_optics(const Sensor& sensor) {
  const std::optional<LivoxOptics> optics = livox_optics(sensor.optics);
  if (!optics)
    fail_of_livox(sensor, "optics without prisms", "rotating prisms", "use a preset of Livox");
  if (sensor.receiver.returns.size() != 1)
    fail_of_livox(sensor, std::to_string(sensor.receiver.returns.size()) + " returns", "one",
                  "add --returns first, for example");
  if (optics->beams == 0 || kLivoxPoints % optics->beams != 0)
    fail_of_livox(sensor, std::to_string(optics->beams) + " beams", "a divisor of 96",
                  "use a preset of Livox");
  return *optics;
}

/// Duration of a packet in 0.1 us.
std::uint16_t packet_interval(const Sensor& sensor, const LivoxOptics& optics) {
  const std::size_t firings = kLivoxPoints / optics.beams;  // whole firings only
  const double interval =
      std::round(static_cast<double>(firings) * kSecond_ns / optics.pulse_hz / kInterval_ns);
  if (interval >= 1.0 && interval <= 65'535.0) return static_cast<std::uint16_t>(interval);
  fail_of_livox(sensor, std::to_string(interval * 1e-4) + " ms for 96 points", "up to 6.5 ms",
                "raise optics.pulse_hz");
}

/// The bytes of reflectivity of all entries, in the scale of Livox.
std::vector<std::uint8_t> reflectivities(const Sensor& sensor, const Frame& frame,
                                         const Beams& beams) {
  PointCloud cloud;
  cloud.rows = beams.rows;
  cloud.cols = beams.cols;
  cloud.columns = {{"intensity", {"intensity"}, frame.intensity},
                   {"range", {"range"}, frame.range_m}};
  return livox_reflectivities(cloud, sensor, beams);
}

/// A point in whole units, by a function that rounds coordinates and ranges.
LivoxPoint point_at(const Eigen::Vector3d& xyz_m, LivoxDataType type, double (*round)(double)) {
  LivoxPoint point;
  if (type == LivoxDataType::spherical) {
    const auto centidegrees = [](double y, double x) {
      return std::llround(atan2_turns(y, x) * kCentidegreesPerTurn);
    };
    point.numbers = {static_cast<std::int64_t>(round(xyz_m.norm() / kMillimetre_m)),
                     centidegrees(xyz_m.head<2>().norm(), xyz_m.z()),
                     centidegrees(xyz_m.y(), xyz_m.x()) % 36'000};
    return point;
  }
  const double unit_m = type == LivoxDataType::cartesian_mm ? kMillimetre_m : kCentimetre_m;
  for (int axis = 0; axis < 3; ++axis)
    point.numbers[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>(round(xyz_m[axis] / unit_m));
  return point;
}

Eigen::Vector3d position_of(const LivoxPoint& point, LivoxDataType type) {
  const auto number = [&](std::size_t i) { return static_cast<double>(point.numbers[i]); };
  if (type == LivoxDataType::spherical) {
    const SineCosine zenith = sincos_turns(number(1) / kCentidegreesPerTurn);
    const SineCosine azimuth = sincos_turns(number(2) / kCentidegreesPerTurn);
    const double range_m = number(0) * kMillimetre_m;
    const double level_m = range_m * zenith.sine;
    return {level_m * azimuth.cosine, level_m * azimuth.sine, range_m * zenith.cosine};
  }
  const double unit_m = type == LivoxDataType::cartesian_mm ? kMillimetre_m : kCentimetre_m;
  return unit_m * Eigen::Vector3d(number(0), number(1), number(2));
}

double round_up(double value) {
  return std::copysign(std::ceil(std::abs(value)), value);
}

/// The point of a measured range. Where rounding would take it out of the limits, it is rounded
/// towards them.
LivoxPoint point_within(const Limits& limits, const Beams& beams, std::size_t entry, double range_m,
                        LivoxDataType type) {
  const Eigen::Vector3d xyz_m = range_m * beams.directions[entry];
  LivoxPoint nearest = point_at(xyz_m, type, std::round);
  if (type == LivoxDataType::spherical) {
    nearest.numbers[0] = static_cast<std::int64_t>(
        to_whole_units(limits, Limits::Along::range, range_m, kMillimetre_m));
    return nearest;
  }
  const Status status = check_limits(limits, beams, entry, position_of(nearest, type).norm());
  if (status == Status::too_far) return point_at(xyz_m, type, std::trunc);
  if (status == Status::too_near) return point_at(xyz_m, type, round_up);
  return nearest;
}

class LivoxEncoder final : public PacketEncoder {
 public:
  LivoxEncoder(const Sensor& sensor, LivoxDataType type)
      : sensor_(sensor),
        optics_(checked_optics(sensor)),
        period_ns_(kSecond_ns / optics_.pulse_hz),
        interval_(packet_interval(sensor, optics_)),
        type_(type) {}

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    check(frame, beams);
    const std::vector<std::uint8_t> reflectivity = reflectivities(sensor_, frame, beams);
    for (std::size_t col = 0; col < beams.cols; ++col) {
      const std::int64_t stamp_ns = frame.stamp_ns + beams.times_ns[col];
      const double late = static_cast<double>(stamp_ns - last_ns_) / period_ns_;
      // a gap in time, as between frames that do not join: the packet ends before it
      if (!waiting_.points.empty() && std::abs(late - 1.0) > 0.5) finish(packets);
      if (waiting_.points.empty()) {
        waiting_.stamp_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, stamp_ns));
        waiting_.frame = static_cast<std::uint8_t>(frame.number);
      }
      last_ns_ = stamp_ns;
      for (std::size_t entry = col; entry < beams.size(); entry += beams.cols)
        waiting_.points.push_back(point(frame, beams, entry, reflectivity[entry]));
      if (waiting_.points.size() == kLivoxPoints) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (waiting_.points.empty()) return;
    waiting_.points.resize(kLivoxPoints);
    send(packets);
  }

 private:
  void check(const Frame& frame, const Beams& beams) const {
    const bool fits = beams.rows == optics_.beams && beams.returns == 1 &&
                      beams.times_ns.size() == beams.size() &&
                      beams.size() == std::size_t{beams.rows} * beams.cols &&
                      frame.range_m.size() == beams.size() &&
                      frame.intensity.size() == beams.size();
    if (!fits)
      fail_of_livox(sensor_, "a frame of other beams", "those of the sensor",
                    "encode the frames of the sensor that the encoder was made for");
  }

  [[nodiscard]] LivoxPoint point(const Frame& frame, const Beams& beams, std::size_t entry,
                                 std::uint8_t reflectivity) const {
    const double range_m = frame.range_m[entry];
    if (!(range_m > 0.0) || !beams.directions[entry].allFinite()) return {};
    LivoxPoint made = point_within(sensor_.limits, beams, entry, range_m, type_);
    if (!fits(made, type_)) return {};
    made.reflectivity = reflectivity;
    return made;
  }

  void send(std::vector<UdpPacket>& packets) {
    waiting_.type = type_;
    waiting_.interval = interval_;
    waiting_.count = count_++;
    packets.push_back({last_ns_ + std::llround(period_ns_), kLivoxPointSourcePort, kLivoxPointPort,
                       glidar::encode(waiting_)});
    waiting_ = {};
  }

  Sensor sensor_;
  LivoxOptics optics_;
  double period_ns_;
  std::uint16_t interval_;
  LivoxDataType type_;
  LivoxPacket waiting_;
  std::int64_t last_ns_ = 0;  ///< of the last firing
  std::uint16_t count_ = 0;
};

class LivoxDecoder final : public PacketDecoder {
 public:
  explicit LivoxDecoder(const Sensor& sensor)
      : rows_(checked_optics(sensor).beams), assembler_(rows_, sensor.rate_hz) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    if (!received.payload.empty() && received.payload[0] == kCommandStart) return;
    const LivoxPacket packet = decode_livox_packet(received.payload);
    if (packet.type == LivoxDataType::imu) return;
    if (packet.points.size() % rows_ != 0)
      throw Error({"Livox packet", std::to_string(packet.points.size()) + " points",
                   "a multiple of " + std::to_string(rows_) + ", the sensor's beams"});
    if (packet.stamp_ns > std::uint64_t{INT64_MAX} / 2)
      throw Error({"Livox packet", "a time after 2116", ""});
    const auto firings = static_cast<std::int64_t>(packet.points.size() / rows_);
    for (std::int64_t firing = 0; firing < firings; ++firing) {
      const std::int64_t after_ns = packet.interval * kInterval_ns * firing / firings;
      std::vector<AssembledPoint> points(rows_);
      for (std::size_t row = 0; row < rows_; ++row) {
        const LivoxPoint& point = packet.points[static_cast<std::size_t>(firing) * rows_ + row];
        points[row] = {position_of(point, packet.type), static_cast<float>(point.reflectivity)};
      }
      assembler_.add(static_cast<std::int64_t>(packet.stamp_ns) + after_ns, points, frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  std::size_t rows_;
  PointAssembler assembler_;
};

}  // namespace

bool is_livox(const Sensor& sensor) {
  return sensor.name.starts_with("Livox") && livox_optics(sensor.optics).has_value();
}

std::unique_ptr<PacketEncoder> make_livox_encoder(const Sensor& sensor, LivoxDataType type) {
  if (type == LivoxDataType::imu)
    throw Error({"Livox packets", "data type 0 for points", "1, 2 or 3"});
  return std::make_unique<LivoxEncoder>(sensor, type);
}

std::unique_ptr<PacketDecoder> make_livox_decoder(const Sensor& sensor) {
  return std::make_unique<LivoxDecoder>(sensor);
}

}  // namespace glidar
