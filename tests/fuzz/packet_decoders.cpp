// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace glidar::testing {
namespace {

/// A sensor as small as its packets allow, because a fuzzer does not have the presets' files.
struct PacketSensor {
  const char* name;
  bool is_dual;
  std::size_t lasers;
  double period_ns;
  double step_ns;  ///< from laser to laser
  std::size_t payload_bytes;
};

constexpr std::array<PacketSensor, 10> kPacketSensors = {{
    {"VLP-16", false, 16, 55'296.0, 2304.0, 1206},
    {"VLP-16", true, 16, 55'296.0, 2304.0, 1206},
    {"HDL-32E", false, 32, 46'080.0, 1152.0, 1206},
    {"HDL-32E", true, 32, 46'080.0, 1152.0, 1206},
    {"Pandar64", true, 64, 55'560.0, 0.0, 1198},
    {"PandarQT", false, 64, 500'000.0 / 3.0, 0.0, 1072},
    {"XT32", false, 32, 50'000.0, 1512.0, 1080},
    {"XT32", true, 32, 50'000.0, 1512.0, 1080},
    {"Ouster OS1-16", false, 16, 0.0, 0.0, 3328},
    {"Ouster OS1-16", true, 16, 0.0, 0.0, 4352},
}};

Sensor sensor_of(const PacketSensor& from) {
  Spinning spinning;
  spinning.firing_period_ns = from.period_ns;
  if (from.period_ns == 0.0) spinning.columns_per_turn = 1024;
  for (std::size_t laser = 0; laser < from.lasers; ++laser) {
    SpinningChannel channel;
    channel.elevation_rad = 0.01 * static_cast<double>(laser);
    channel.fire_time_ns = from.step_ns * static_cast<double>(laser);
    channel.ring = static_cast<std::uint16_t>(laser);
    spinning.channels.push_back(channel);
  }
  Sensor sensor;
  sensor.name = from.name;
  sensor.rate_hz = spinning.rotation_hz;
  sensor.optics = std::move(spinning);
  sensor.receiver.returns = {Return{}};
  if (from.is_dual)
    sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  return sensor;
}

/// What users of decoded frames rely on.
void check_decoded(const std::vector<DecodedFrame>& frames) {
  for (const DecodedFrame& made : frames) {
    const std::size_t size = std::size_t{made.frame.rows} * made.frame.cols;
    demand(made.beams.size() == size && made.frame.range_m.size() == size,
           "a decoded frame has one entry per beam");
    for (const Eigen::Vector3d& direction : made.beams.directions)
      demand(std::abs(direction.squaredNorm() - 1.0) < 1e-9, "directions have unit length");
  }
}

/// True if the packet is valid.
bool decode_one(PacketDecoder& decoder, const UdpPacket& packet,
                std::vector<DecodedFrame>& frames) {
  try {
    decoder.decode(packet, frames);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void read_packets(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  if (text.empty()) throw Error({"packets", "no sensor", "at least one byte"});
  const PacketSensor& from =
      kPacketSensors[static_cast<unsigned char>(text[0]) % kPacketSensors.size()];
  const auto decoder = make_packet_decoder(sensor_of(from));
  const std::string name = from.name;
  std::vector<DecodedFrame> frames;
  std::size_t valid = 0;
  for (std::size_t at = 1; at < text.size(); at += from.payload_bytes) {
    const auto bytes = std::as_bytes(std::span(text)).subspan(at);
    const auto payload = bytes.first(std::min(bytes.size(), from.payload_bytes));
    const std::uint16_t port = name.starts_with("Ouster") ? kOusterLidarPort : kVelodynePort;
    valid +=
        decode_one(*decoder, {0, port, port, {payload.begin(), payload.end()}}, frames) ? 1 : 0;
  }
  decoder->finish(frames);
  check_decoded(frames);
  if (valid == 0) throw Error({"packets", "no valid packet", "packets of " + name});
}

void read_capture(const std::filesystem::path& file) {
  PcapReader reader(file);
  const auto decoder = make_packet_decoder(sensor_of(kPacketSensors.front()));
  std::vector<DecodedFrame> frames;
  for (UdpPacket packet; reader.next(packet);) {
    demand(packet.payload.size() <= kMaxUdpPayload, "a payload fits a datagram");
    decode_one(*decoder, packet, frames);
    if (packet.payload.size() == kVelodynePositionBytes) decode_velodyne_position(packet.payload);
    if (packet.payload.size() == kOusterImuBytes) decode_ouster_imu(packet.payload);
  }
  decoder->finish(frames);
  check_decoded(frames);
}

}  // namespace glidar::testing
