// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/hesai.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::uint8_t kFactory = 0x42;

// Numbers of models: tier4/nebula, hesai_cmd_response.hpp. Block times: tier4/nebula,
// pandar_64.hpp, pandar_qt64.hpp, pandar_xt32.hpp. Its firing times of the QT64 are 10 us later
// than those of the preset, which the offset of its blocks contains here.
constexpr std::array<HesaiModel, 3> kHesaiModels = {{
    {"Pandar64", 64, 6, 3, 8, 26, {0xEE, 0xFF, 64, 6}, 55'560.0, -42'580.0, true, 2},
    {"PandarQT", 64, 4, 4, 12, 28, {0xEE, 0xFF, 3, 1}, 500'000.0 / 3.0, 35'710.0, false, 15},
    {"XT32", 32, 8, 4, 12, 28, {0xEE, 0xFF, 6, 1}, 50'000.0, 0.0, true, 25},
}};

/// Offsets in the tail.
struct TailPlaces {
  std::size_t mode = 0;
  std::size_t motor = 0;
  std::size_t date = 0;
  std::size_t microseconds = 0;
  std::size_t factory = 0;
  int first_year = 2000;
};

TailPlaces places_of(const HesaiModel& model) {
  if (model.channels == 32) return {10, 11, 13, 19, 23, 1900};
  if (model.point_bytes == 3) return {14, 8, 16, 10, 15, 2000};
  return {16, 10, 18, 12, 17, 1900};
}

std::size_t block_bytes(const HesaiModel& model) {
  return 2 + model.channels * model.point_bytes;
}

/// Whether the name contains that of the model and not a longer one, such as XT32M of XT32.
bool names_model(std::string_view name, std::string_view model) {
  const std::size_t begin = name.find(model);
  if (begin == std::string_view::npos) return false;
  const std::string_view rest = name.substr(begin + model.size());
  return rest.empty() || std::isalnum(static_cast<unsigned char>(rest.front())) == 0;
}

void set_little(Bytes& bytes, std::size_t at, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
}

}  // namespace

const HesaiModel* find_hesai_model(const Sensor& sensor) {
  for (const HesaiModel& model : kHesaiModels)
    if (names_model(sensor.name, model.name)) return &model;
  return nullptr;
}

double sequence_start_ns(const HesaiModel& model, std::size_t sequence, std::size_t sequences) {
  const double after = static_cast<double>(sequence);
  const double from = model.counts_from_last ? static_cast<double>(sequences) - 1.0 : 0.0;
  return model.block_offset_ns + (after - from) * model.block_period_ns;
}

std::vector<std::byte> encode(const HesaiPacket& packet, const HesaiModel& model) {
  Bytes bytes = packet.head;
  for (const HesaiPacket::Block& block : packet.blocks) {
    put_little(bytes, block.azimuth, 2);
    for (const HesaiPacket::Point& point : block.points) {
      put_little(bytes, point.distance, 2);
      put_little(bytes, point.reflectivity, 1);
      if (model.point_bytes == 4) put_little(bytes, point.confidence, 1);
    }
  }
  bytes.insert(bytes.end(), packet.tail.begin(), packet.tail.end());
  return bytes;
}

HesaiPacket decode_hesai_packet(std::span<const std::byte> payload, const HesaiModel& model) {
  const std::size_t body = model.blocks * block_bytes(model);
  require_packet_size(payload, model.head_bytes + body + model.tail_bytes, "Hesai data packet");
  for (std::size_t i = 0; i < 2; ++i) {
    if (get<std::uint8_t>(payload, i) == model.version[i]) continue;
    throw Error({"Hesai data packet", "another first number", "EE FF"});
  }
  HesaiPacket packet;
  packet.head.assign(payload.begin(),
                     payload.begin() + static_cast<std::ptrdiff_t>(model.head_bytes));
  packet.tail.assign(payload.end() - static_cast<std::ptrdiff_t>(model.tail_bytes), payload.end());
  for (std::size_t b = 0; b < model.blocks; ++b) {
    const ByteView bytes =
        payload.subspan(model.head_bytes + b * block_bytes(model), block_bytes(model));
    HesaiPacket::Block block{get<std::uint16_t>(bytes, 0), {}};
    for (std::size_t i = 0; i < model.channels; ++i) {
      const std::size_t at = 2 + i * model.point_bytes;
      HesaiPacket::Point point{get<std::uint16_t>(bytes, at), get<std::uint8_t>(bytes, at + 2)};
      if (model.point_bytes == 4) point.confidence = get<std::uint8_t>(bytes, at + 3);
      block.points.push_back(point);
    }
    packet.blocks.push_back(std::move(block));
  }
  return packet;
}

std::vector<std::byte> encode(const HesaiTail& tail, const HesaiModel& model) {
  using std::chrono::days;
  const TailPlaces at = places_of(model);
  const std::chrono::sys_time<std::chrono::nanoseconds> time{
      std::chrono::nanoseconds(tail.stamp_ns)};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{std::chrono::floor<std::chrono::seconds>(time) - day};
  const auto in_second = (time - std::chrono::floor<std::chrono::seconds>(time)).count();
  Bytes bytes(model.tail_bytes);
  set_little(bytes, at.mode, tail.return_mode, 1);
  set_little(bytes, at.motor, tail.motor_rpm, 2);
  const std::array<std::uint64_t, 6> numbers = {
      static_cast<std::uint64_t>(static_cast<int>(date.year()) - at.first_year),
      static_cast<unsigned>(date.month()),
      static_cast<unsigned>(date.day()),
      static_cast<std::uint64_t>(clock.hours().count()),
      static_cast<std::uint64_t>(clock.minutes().count()),
      static_cast<std::uint64_t>(clock.seconds().count())};
  for (std::size_t i = 0; i < numbers.size(); ++i) set_little(bytes, at.date + i, numbers[i], 1);
  set_little(bytes, at.microseconds, static_cast<std::uint64_t>(in_second / 1000), 4);
  set_little(bytes, at.factory, kFactory, 1);
  set_little(bytes, model.tail_bytes - 4, tail.sequence, 4);
  return bytes;
}

HesaiTail decode_hesai_tail(std::span<const std::byte> tail, const HesaiModel& model) {
  require_packet_size(tail, model.tail_bytes, "tail of a Hesai packet");
  const TailPlaces at = places_of(model);
  std::array<unsigned, 6> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = get<std::uint8_t>(tail, at.date + i);
  const std::chrono::year_month_day date{
      std::chrono::year(at.first_year + static_cast<int>(numbers[0])),
      std::chrono::month(numbers[1]), std::chrono::day(numbers[2])};
  const auto us = get<std::uint32_t>(tail, at.microseconds);
  if (!date.ok() || numbers[3] > 23 || numbers[4] > 59 || numbers[5] > 60 || us >= 2'000'000)
    throw Error({"Hesai data packet", "a time that is no date", ""});
  const std::int64_t day = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = ((day * 24 + numbers[3]) * 60 + numbers[4]) * 60 + numbers[5];
  return {get<std::uint8_t>(tail, at.mode), get<std::uint16_t>(tail, at.motor),
          seconds * kNanosecondsPerSecond + std::int64_t{us} * 1000,
          get<std::uint32_t>(tail, model.tail_bytes - 4)};
}

namespace {

constexpr double kUnit_m = 0.004;
constexpr std::uint16_t kWholeTurn_cdeg = 36'000;
constexpr double kMaxPeriodError = 0.001;  // drivers' block times of the Pandar64 are rounded

[[noreturn]] void fail_of_model(const Sensor& sensor, std::string found, std::string allowed) {
  throw Error({"Hesai packets of " + sensor.name, std::move(found), std::move(allowed),
               "use the preset of the model, or write clouds"});
}

const HesaiModel& checked_model(const Sensor& sensor) {
  const Spinning& spinning = spinning_optics(sensor, "Hesai packets");
  const HesaiModel* model = find_hesai_model(sensor);
  if (model == nullptr)
    fail_of_model(sensor, "no Hesai model of this name", "Pandar64, PandarQT, XT32");
  const std::size_t channels = spinning.channels.size();
  if (channels != model->channels)
    fail_of_model(sensor, std::to_string(channels) + " channels", std::to_string(model->channels));
  if (spinning.rotation_direction != Spinning::RotationDirection::clockwise)
    fail_of_model(sensor, "counterclockwise rotation", "clockwise");
  const double period_ns = sequence_period_ns(spinning);
  if (std::abs(period_ns / model->block_period_ns - 1.0) > kMaxPeriodError)
    fail_of_model(sensor, "columns every " + number_text(period_ns * 1e-3) + " us",
                  "every " + number_text(model->block_period_ns * 1e-3) + " us");
  return *model;
}

class HesaiEncoder final : public PacketEncoder {
 public:
  explicit HesaiEncoder(const Sensor& sensor)
      : sensor_(sensor),
        model_(checked_model(sensor)),
        returns_(select_packet_returns(sensor, "Hesai packets of " + sensor.name)),
        sequences_(model_.blocks / (returns_.is_dual() ? 2 : 1)) {}

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    for (FiringSequence& sequence : firing_sequences(sensor_, frame, beams, kUnit_m)) {
      const auto late_ns =
          static_cast<double>(waiting_.empty() ? 0 : sequence.stamp_ns - waiting_.back().stamp_ns);
      // a gap in time, as between frames that do not join: the packet ends before it
      if (!waiting_.empty() && std::abs(late_ns / period_ns() - 1.0) > 0.5) finish(packets);
      waiting_.push_back(std::move(sequence));
      if (waiting_.size() == sequences_) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (waiting_.empty()) return;
    const double turn_rad = turn_rate_rad_per_ns(spinning()) * period_ns();
    while (waiting_.size() < sequences_) {
      FiringSequence next{waiting_.back().stamp_ns + std::llround(period_ns()),
                          waiting_.back().azimuth_rad + turn_rad,
                          {}};
      next.returns.resize(waiting_.back().returns.size());
      waiting_.push_back(std::move(next));
    }
    send(packets);
  }

 private:
  [[nodiscard]] const Spinning& spinning() const { return std::get<Spinning>(sensor_.optics); }
  [[nodiscard]] double period_ns() const { return sequence_period_ns(spinning()); }

  [[nodiscard]] HesaiPacket::Block block_of(const FiringSequence& sequence, bool is_last) const {
    const double clockwise =
        std::fmod(-sequence.azimuth_rad * kDegreesPerRadian * 100.0, kWholeTurn_cdeg);
    const long rounded = std::lround(clockwise < 0.0 ? clockwise + kWholeTurn_cdeg : clockwise);
    HesaiPacket::Block block{static_cast<std::uint16_t>(rounded % kWholeTurn_cdeg), {}};
    for (std::size_t laser = 0; laser < model_.channels; ++laser) {
      PacketReturn found = sequence.returns[laser];
      if (returns_.is_dual()) {
        const LastAndStrongest both = last_and_strongest(sequence, model_.channels, laser);
        found = is_last ? both.last : both.strongest;
      }
      const double units = std::clamp(std::round(found.range_m / kUnit_m), 0.0, 65535.0);
      const std::uint8_t byte = units > 0.0 ? found.reflectivity : std::uint8_t{0};
      block.points.push_back({static_cast<std::uint16_t>(units), byte, 0});
    }
    return block;
  }

  void put_head(HesaiPacket& packet) const {
    for (const std::uint8_t byte : model_.version) packet.head.push_back(std::byte{byte});
    if (model_.head_bytes == 8) {
      packet.head.insert(packet.head.end(),
                         {std::byte{0}, std::byte{4}, std::byte{0}, std::byte{0}});
      return;
    }
    const std::size_t returns = returns_.is_dual() ? 2 : 1;
    for (const std::size_t value :
         {std::size_t{0}, std::size_t{0}, model_.channels, model_.blocks, returns - 1U,
          std::size_t{4}, returns, std::size_t{1}})  // the flag: sequence numbers
      packet.head.push_back(static_cast<std::byte>(value));
  }

  void send(std::vector<UdpPacket>& packets) {
    HesaiPacket packet;
    put_head(packet);
    for (const FiringSequence& sequence : waiting_) {
      // the last return, then the strongest (Pandar64 user manual, "Return Mode")
      if (returns_.is_dual()) packet.blocks.push_back(block_of(sequence, true));
      packet.blocks.push_back(block_of(sequence, false));
    }
    const FiringSequence& reference = model_.counts_from_last ? waiting_.back() : waiting_.front();
    const double rpm = std::clamp(60.0 * spinning().rotation_hz, 0.0, 65535.0);
    packet.tail = glidar::encode(
        HesaiTail{static_cast<std::uint8_t>(returns_.mode),
                  static_cast<std::uint16_t>(std::lround(rpm)),
                  reference.stamp_ns - std::llround(model_.block_offset_ns), count_++},
        model_);
    packets.push_back({waiting_.back().stamp_ns + std::llround(period_ns()), kHesaiPort, kHesaiPort,
                       glidar::encode(packet, model_)});
    waiting_.clear();
  }

  Sensor sensor_;
  HesaiModel model_;
  ReturnSelection returns_;
  std::size_t sequences_;
  std::uint32_t count_ = 0;
  std::vector<FiringSequence> waiting_;
};

class HesaiDecoder final : public PacketDecoder {
 public:
  HesaiDecoder(const Sensor& sensor, bool follow_rotation)
      : model_(checked_model(sensor)),
        returns_(select_packet_returns(sensor, "Hesai packets of " + sensor.name)),
        assembler_(sensor, follow_rotation) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    const HesaiPacket packet = decode_hesai_packet(received.payload, model_);
    const HesaiTail tail = decode_hesai_tail(packet.tail, model_);
    const auto mode = static_cast<std::uint8_t>(returns_.mode);
    if (tail.return_mode != mode)
      throw Error({"Hesai data packet", "return mode " + std::to_string(tail.return_mode),
                   std::to_string(mode), "set receiver.returns of the sensor"});
    for (const HesaiPacket::Block& block : packet.blocks)
      if (block.azimuth > kWholeTurn_cdeg)
        throw Error({"Hesai data packet", "an azimuth above 360 degrees", ""});
    const std::size_t per = returns_.is_dual() ? 2 : 1;
    const std::size_t sequences = model_.blocks / per;
    for (std::size_t s = 0; s < sequences; ++s) {
      FiringSequence sequence;
      sequence.stamp_ns = tail.stamp_ns + std::llround(sequence_start_ns(model_, s, sequences));
      sequence.azimuth_rad = -0.01 * kDegree * packet.blocks[s * per].azimuth;
      sequence.returns.resize(model_.channels * per);
      for (std::size_t laser = 0; laser < model_.channels; ++laser) {
        const PacketReturn first = read(packet.blocks[s * per].points[laser]);
        const PacketReturn second = read(packet.blocks[s * per + per - 1].points[laser]);
        store_returns({first, second}, returns_, model_.channels, laser, sequence);
      }
      assembler_.add(std::move(sequence), frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  static PacketReturn read(const HesaiPacket::Point& point) {
    return {point.distance * kUnit_m, static_cast<float>(point.reflectivity), point.reflectivity};
  }

  HesaiModel model_;
  ReturnSelection returns_;
  RevolutionAssembler assembler_;
};

}  // namespace

bool is_hesai(const Sensor& sensor) {
  return find_hesai_model(sensor) != nullptr;
}

HesaiIdentity hesai_identity(const Sensor& sensor) {
  const HesaiModel& model = checked_model(sensor);
  const Spinning& spinning = spinning_optics(sensor, "Hesai packets");
  const ReturnSelection returns = select_packet_returns(sensor, "Hesai packets of " + sensor.name);
  HesaiIdentity identity;
  identity.angle_correction = "Channel,Elevation,Azimuth\n";
  for (std::size_t i = 0; i < spinning.channels.size(); ++i) {
    const SpinningChannel& channel = spinning.channels[i];
    identity.angle_correction +=
        fmt::format("{},{:.4f},{:.4f}\n", i + 1, channel.elevation_rad * kDegreesPerRadian,
                    -channel.azimuth_offset_rad * kDegreesPerRadian);
  }
  const auto mode = static_cast<unsigned>(returns.mode);
  constexpr unsigned kStrongest = static_cast<unsigned>(PacketReturnMode::strongest);
  identity.model_number = model.number;
  identity.channels = static_cast<std::uint8_t>(model.channels);
  identity.return_mode = mode == kStrongest ? 1 : returns.is_dual() ? 2 : 0;
  identity.spin_rate_rpm = static_cast<std::uint16_t>(
      std::lround(std::clamp(60.0 * spinning.rotation_hz, 0.0, 65535.0)));
  return identity;
}

std::unique_ptr<PacketEncoder> make_hesai_encoder(const Sensor& sensor) {
  return std::make_unique<HesaiEncoder>(sensor);
}

std::unique_ptr<PacketDecoder> make_hesai_decoder(const Sensor& sensor, bool follow_rotation) {
  return std::make_unique<HesaiDecoder>(sensor, follow_rotation);
}

}  // namespace glidar
