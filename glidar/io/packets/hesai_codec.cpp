// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/hesai_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/firing_sequence.hpp>
#include <glidar/io/packets/hesai_packet.hpp>
#include <glidar/io/packets/return_selection.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace glidar {
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
