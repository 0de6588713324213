// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/velodyne_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/firing_sequence.hpp>
#include <glidar/io/packets/hdl64_status.hpp>
#include <glidar/io/packets/velodyne_model.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr std::array<std::uint16_t, 4> kBankFlags = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
constexpr std::uint16_t kTurn_cdeg = 36'000;
constexpr std::int64_t kPositionPeriod_ns = 6'800'000;  // as a VLP-16 sends them

std::uint16_t azimuth_cdeg(double azimuth_rad) {
  const double clockwise = std::fmod(-azimuth_rad * kDegreesPerRadian * 100.0, kTurn_cdeg);
  const long rounded = std::lround(clockwise < 0.0 ? clockwise + kTurn_cdeg : clockwise);
  return static_cast<std::uint16_t>(rounded % kTurn_cdeg);
}

std::uint16_t distance_units(double range_m, double unit_m) {
  return static_cast<std::uint16_t>(std::clamp(std::round(range_m / unit_m), 0.0, 65535.0));
}

void put(const PacketReturn& found, const VelodyneSlot& slot, double unit_m,
         VelodynePacket& packet) {
  VelodynePacket::Block& block = packet.blocks[slot.block];
  block.distance[slot.point] = distance_units(found.range_m, unit_m);
  block.reflectivity[slot.point] = block.distance[slot.point] > 0 ? found.reflectivity : 0;
}

/// Both returns of a laser, in two blocks with the azimuth of the first.
void put_both(const VelodyneLayout& layout, std::size_t sequence, std::size_t laser,
              const LastAndStrongest& found, VelodynePacket& packet) {
  const VelodyneSlot slot = velodyne_slot(layout, sequence, laser, false);
  const VelodyneSlot other = velodyne_slot(layout, sequence, laser, true);
  packet.blocks[other.block].azimuth = packet.blocks[slot.block].azimuth;
  packet.blocks[other.block].flag = packet.blocks[slot.block].flag;
  put(found.strongest, slot, layout.model.unit_m, packet);
  put(found.last, other, layout.model.unit_m, packet);
}

VelodynePacket make_packet(const VelodyneLayout& layout, std::span<const FiringSequence> firings) {
  VelodynePacket packet;
  const std::size_t lasers = layout.model.lasers;
  for (std::size_t s = 0; s < firings.size(); ++s) {
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const VelodyneSlot slot = velodyne_slot(layout, s, laser, false);
      VelodynePacket::Block& block = packet.blocks[slot.block];
      if (slot.point == 0) block.azimuth = azimuth_cdeg(firings[s].azimuth_rad);
      block.flag = kBankFlags[velodyne_bank(layout, slot.block)];
      if (layout.is_dual())
        put_both(layout, s, laser, last_and_strongest(firings[s], lasers, laser), packet);
      else
        put(firings[s].returns[laser], slot, layout.model.unit_m, packet);
    }
  }
  packet.hour_us = hour_us(firings.front().stamp_ns + std::llround(layout.model.stamp_offset_ns));
  packet.mode = static_cast<std::uint8_t>(layout.returns.mode);
  packet.model = layout.model.factory_byte;
  return packet;
}

class VelodyneEncoder final : public PacketEncoder {
 public:
  VelodyneEncoder(const Sensor& sensor, const std::optional<GeoPosition>& position)
      : sensor_(sensor), layout_(velodyne_layout(sensor)), position_(position) {
    if (layout_.model.factory_byte != 0) return;
    status_.emplace(std::get<Spinning>(sensor_.optics), layout_.returns.mode,
                    position_.has_value());
  }

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    for (FiringSequence& sequence : firing_sequences(sensor_, frame, beams, layout_.model.unit_m)) {
      // a gap in time, as between frames that do not join: the packet ends before it
      if (!waiting_.empty() && std::abs(static_cast<double>(sequence.stamp_ns - next_stamp_ns())) >
                                   0.5 * layout_.period_ns())
        finish(packets);
      waiting_.push_back(std::move(sequence));
      if (waiting_.size() == layout_.sequences) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (waiting_.empty()) return;
    const double turn_rad =
        turn_rate_rad_per_ns(std::get<Spinning>(sensor_.optics)) * layout_.period_ns();
    while (waiting_.size() < layout_.sequences) {
      FiringSequence next{next_stamp_ns(), waiting_.back().azimuth_rad + turn_rad, {}};
      next.returns.resize(waiting_.back().returns.size());
      waiting_.push_back(std::move(next));
    }
    send(packets);
  }

 private:
  [[nodiscard]] std::int64_t next_stamp_ns() const {
    return waiting_.back().stamp_ns + std::llround(layout_.period_ns());
  }

  void send(std::vector<UdpPacket>& packets) {
    const std::int64_t end_ns = next_stamp_ns();
    VelodynePacket packet = make_packet(layout_, waiting_);
    if (status_) {
      const Hdl64Status::Entry entry = status_->at(count_, waiting_.front().stamp_ns);
      packet.mode = entry.type;
      packet.model = entry.value;
    }
    ++count_;
    packets.push_back({end_ns, kVelodynePort, kVelodynePort, glidar::encode(packet)});
    waiting_.clear();
    if (end_ns < next_position_ns_) return;
    next_position_ns_ = end_ns + kPositionPeriod_ns;
    const GeoPosition at = position_.value_or(GeoPosition{});
    const VelodynePosition report{
        hour_us(end_ns), static_cast<std::uint8_t>(position_.has_value() ? 2 : 0),
        nmea_rmc(end_ns, at.latitude_deg, at.longitude_deg, position_.has_value())};
    packets.push_back(
        {end_ns, kVelodynePositionPort, kVelodynePositionPort, glidar::encode(report)});
  }

  Sensor sensor_;
  VelodyneLayout layout_;
  std::optional<GeoPosition> position_;
  std::optional<Hdl64Status> status_;  ///< of an HDL-64E
  std::uint64_t count_ = 0;            ///< of data packets
  std::int64_t next_position_ns_ = INT64_MIN;
  std::vector<FiringSequence> waiting_;
};

class VelodyneDecoder final : public PacketDecoder {
 public:
  explicit VelodyneDecoder(const Sensor& sensor)
      : sensor_(sensor), layout_(velodyne_layout(sensor)), assembler_(sensor) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    if (received.payload.size() == kVelodynePositionBytes) return;
    const VelodynePacket packet = decode_velodyne_packet(received.payload);
    check(packet);
    const std::int64_t first_ns = stamp_in_hour(packet.hour_us, received.stamp_ns) -
                                  std::llround(layout_.model.stamp_offset_ns);
    for (std::size_t s = 0; s < layout_.sequences; ++s) {
      FiringSequence sequence;
      sequence.stamp_ns = first_ns + std::llround(static_cast<double>(s) * layout_.period_ns());
      sequence.azimuth_rad = azimuth_rad(packet, s);
      sequence.returns.resize(layout_.model.lasers * sensor_.receiver.returns.size());
      for (std::size_t laser = 0; laser < layout_.model.lasers; ++laser)
        read_laser(packet, s, laser, sequence);
      assembler_.add(std::move(sequence), frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  void check(const VelodynePacket& packet) const {
    const std::string where = "Velodyne packet for " + sensor_.name;
    const std::uint8_t factory = layout_.model.factory_byte;
    if (factory != 0 && packet.model != factory)
      throw Error({where, "factory byte " + std::to_string(packet.model), std::to_string(factory),
                   "decode with the sensor that sent the packets"});
    const auto mode = static_cast<std::uint8_t>(layout_.returns.mode);
    if (factory != 0 && packet.mode != mode)
      throw Error({where, "return mode " + std::to_string(packet.mode), std::to_string(mode),
                   "set receiver.returns of the sensor"});
    const std::size_t used = layout_.model.lasers == 128 && layout_.is_dual() ? 8 : kVelodyneBlocks;
    for (std::size_t block = 0; block < used; ++block) {
      if (packet.blocks[block].flag != kBankFlags[velodyne_bank(layout_, block)] ||
          packet.blocks[block].azimuth > kTurn_cdeg)
        throw Error(
            {where, "block " + std::to_string(block) + " with another flag or an azimuth above 360",
             "the blocks of its model"});
    }
  }

  /// Blocks that contain two sequences have the azimuth of the first: the second is half way to the
  /// next block.
  [[nodiscard]] double azimuth_rad(const VelodynePacket& packet, std::size_t s) const {
    const VelodyneSlot slot = velodyne_slot(layout_, s, 0, false);
    const auto at = static_cast<double>(packet.blocks[slot.block].azimuth);
    const double toward = slot.point == 0 ? 0.0 : 0.5 * block_step_cdeg(packet, slot.block);
    return -(at + toward) * 0.01 * kDegree;
  }

  [[nodiscard]] double block_step_cdeg(const VelodynePacket& packet, std::size_t block) const {
    const std::size_t step = layout_.is_dual() ? 2 : 1;
    const std::size_t from = block + step < kVelodyneBlocks ? block : block - step;
    const int turned = packet.blocks[from + step].azimuth - packet.blocks[from].azimuth;
    return turned < 0 ? turned + kTurn_cdeg : turned;
  }

  void read_laser(const VelodynePacket& packet, std::size_t s, std::size_t laser,
                  FiringSequence& sequence) const {
    const PacketReturn strongest = read(packet, velodyne_slot(layout_, s, laser, false));
    if (!layout_.is_dual()) {
      sequence.returns[laser] = strongest;
      return;
    }
    const PacketReturn last = read(packet, velodyne_slot(layout_, s, laser, true));
    store_returns({last, strongest}, layout_.returns, layout_.model.lasers, laser, sequence);
  }

  [[nodiscard]] PacketReturn read(const VelodynePacket& packet, const VelodyneSlot& slot) const {
    const VelodynePacket::Block& block = packet.blocks[slot.block];
    const std::uint8_t byte = block.reflectivity[slot.point];
    return {block.distance[slot.point] * layout_.model.unit_m, static_cast<float>(byte), byte};
  }

  Sensor sensor_;
  VelodyneLayout layout_;
  RevolutionAssembler assembler_;
};

}  // namespace

bool is_velodyne(const Sensor& sensor) {
  return find_velodyne_model(sensor) != nullptr;
}

std::unique_ptr<PacketEncoder> make_velodyne_encoder(const Sensor& sensor,
                                                     const std::optional<GeoPosition>& position) {
  return std::make_unique<VelodyneEncoder>(sensor, position);
}

std::unique_ptr<PacketDecoder> make_velodyne_decoder(const Sensor& sensor) {
  return std::make_unique<VelodyneDecoder>(sensor);
}

}  // namespace glidar
