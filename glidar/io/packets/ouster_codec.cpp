// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/ouster_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/firing_sequence.hpp>
#include <glidar/io/packets/ouster_metadata.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr std::uint64_t kMaxInitId = (1U << 24U) - 1U;

/// Number of the column: the encoder angle is 2 pi (1 - number / columns per turn).
std::uint16_t measurement_of(const Spinning& spinning, double azimuth_rad) {
  const double turned = (azimuth_at_start_rad(spinning) - azimuth_rad) / kTwoPi;
  const double share = turned - std::floor(turned);
  const long number = std::lround(share * spinning.columns_per_turn);
  return static_cast<std::uint16_t>(number % static_cast<long>(spinning.columns_per_turn));
}

OusterPixel pixel_of(const PacketReturn& found) {
  if (!(found.range_m > 0.0)) return {};
  const double signal = std::clamp(std::round(static_cast<double>(found.intensity)), 0.0, 65535.0);
  const double range_mm = std::clamp(std::round(found.range_m / kMillimetre_m), 0.0, 1e9);
  return {.range_mm = static_cast<std::uint32_t>(range_mm),
          .reflectivity = found.reflectivity,
          .signal = static_cast<std::uint16_t>(signal)};
}

class OusterEncoder final : public PacketEncoder {
 public:
  OusterEncoder(Sensor sensor, const OusterOptions& options)
      : sensor_(std::move(sensor)),
        format_(ouster_format(sensor_, options)),
        identity_(options.identity) {}

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    const double unit_m =
        (format_.profile == OusterProfile::rng15_rfl8_nir8 ? 8.0 : 1.0) * kMillimetre_m;
    for (const FiringSequence& sequence : firing_sequences(sensor_, frame, beams, unit_m)) {
      const std::uint16_t number = measurement_of(spinning(), sequence.azimuth_rad);
      const std::size_t first = number - number % format_.columns_per_packet;
      const std::int64_t gap_ns = sequence.stamp_ns - last_ns_;
      const bool joins = is_started_ && first == first_ && number > last_ && gap_ns >= 0 &&
                         gap_ns < std::int64_t{1'000'000'000};
      if (!joins) start_packet(first, number, packets);
      fill(sequence, number);
      if (number - first + 1U == format_.columns_per_packet) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (is_started_) send(packets);
  }

 private:
  [[nodiscard]] const Spinning& spinning() const { return std::get<Spinning>(sensor_.optics); }

  void start_packet(std::size_t first, std::uint16_t number, std::vector<UdpPacket>& packets) {
    finish(packets);
    if (has_frame_ && number <= last_) ++frame_;
    has_frame_ = true;
    is_started_ = true;
    first_ = first;
    packet_ = {};
    packet_.frame = frame_;
    packet_.init_id = identity_.init_id;
    packet_.serial = identity_.serial;
    packet_.columns.resize(format_.columns_per_packet);
    for (std::size_t i = 0; i < packet_.columns.size(); ++i) {
      OusterColumn& column = packet_.columns[i];
      column.measurement = static_cast<std::uint16_t>(first + i);
      column.pixels.resize(format_.rows * ouster_returns(format_.profile));
    }
  }

  void fill(const FiringSequence& sequence, std::uint16_t number) {
    OusterColumn& column = packet_.columns[number - first_];
    column.stamp_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, sequence.stamp_ns));
    column.is_valid = true;
    std::transform(sequence.returns.begin(), sequence.returns.end(), column.pixels.begin(),
                   pixel_of);
    last_ = number;
    last_ns_ = sequence.stamp_ns;
  }

  void send(std::vector<UdpPacket>& packets) {
    is_started_ = false;
    const std::uint32_t columns = spinning().columns_per_turn;
    packets.push_back({last_ns_ + std::llround(sequence_period_ns(spinning())),
                       identity_.lidar_port, identity_.lidar_port,
                       glidar::encode(packet_, format_, columns)});
  }

  Sensor sensor_;
  OusterFormat format_;
  OusterIdentity identity_;
  OusterPacket packet_;
  std::size_t first_ = 0;  ///< number of the packet's first column
  std::uint16_t last_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint16_t frame_ = 0;
  bool is_started_ = false;
  bool has_frame_ = false;
};

class OusterDecoder final : public PacketDecoder {
 public:
  explicit OusterDecoder(OusterSource source)
      : source_(std::move(source)), assembler_(source_.sensor) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    if (received.port != source_.identity.lidar_port) return;
    const OusterPacket packet = decode_ouster_packet(received.payload, source_.format);
    const bool has_id = source_.format.profile != OusterProfile::legacy;
    if (has_id && source_.identity.init_id != 0 && packet.init_id != source_.identity.init_id) {
      throw Error({"Ouster packet", "initialization_id " + std::to_string(packet.init_id),
                   std::to_string(source_.identity.init_id), "use the metadata of this recording"});
    }
    const auto& spinning = std::get<Spinning>(source_.sensor.optics);
    for (const OusterColumn& column : packet.columns) {
      if (!column.is_valid || column.measurement >= spinning.columns_per_turn) continue;
      if (column.stamp_ns > std::uint64_t{INT64_MAX} / 2) continue;
      assembler_.add(sequence_of(column, spinning), frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  [[nodiscard]] FiringSequence sequence_of(const OusterColumn& column,
                                           const Spinning& spinning) const {
    FiringSequence sequence;
    sequence.stamp_ns = static_cast<std::int64_t>(column.stamp_ns);
    sequence.azimuth_rad =
        azimuth_at_start_rad(spinning) - kTwoPi * column.measurement / spinning.columns_per_turn;
    const bool has_signal = source_.format.profile != OusterProfile::rng15_rfl8_nir8;
    const auto add = [&](const OusterPixel& pixel) {
      const double value = has_signal ? pixel.signal : pixel.reflectivity;
      sequence.returns.push_back(
          {pixel.range_mm * kMillimetre_m, static_cast<float>(value), pixel.reflectivity});
    };
    const OusterFormat& format = source_.format;
    if (format.slots.empty()) std::for_each(column.pixels.begin(), column.pixels.end(), add);
    for (std::size_t first = 0; first < column.pixels.size(); first += format.rows)
      for (const std::size_t slot : format.slots) add(column.pixels[first + slot]);
    return sequence;
  }

  OusterSource source_;
  RevolutionAssembler assembler_;
};

}  // namespace

bool is_ouster(const Sensor& sensor) {
  return sensor.name.starts_with("Ouster OS");
}

std::unique_ptr<PacketEncoder> make_ouster_encoder(const Sensor& sensor,
                                                   const OusterOptions& options) {
  if (options.identity.init_id > kMaxInitId)
    throw Error({"Ouster packets", "initialization_id " + std::to_string(options.identity.init_id),
                 "at most 16777215"});
  return std::make_unique<OusterEncoder>(sensor, options);
}

std::unique_ptr<PacketDecoder> make_ouster_decoder(const OusterSource& source) {
  return std::make_unique<OusterDecoder>(source);
}

std::unique_ptr<PacketDecoder> make_ouster_decoder(const Sensor& sensor,
                                                   const OusterOptions& options) {
  return std::make_unique<OusterDecoder>(
      OusterSource{sensor, ouster_format(sensor, options), options.identity});
}

}  // namespace glidar
