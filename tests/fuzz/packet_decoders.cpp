// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/sensor_packets.hpp>
#include <glidar/io/packets/velodyne.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::testing {
namespace {

/// A sensor as small as its packets allow, because a fuzzer does not have the presets' files.
/// Appended sensors keep the meaning of the corpus.
struct PacketSensor {
  const char* name;
  bool is_dual;
  std::size_t lasers;
  double period_ns;  ///< 0: columns of Ouster
  std::size_t payload_bytes;
  OusterProfile profile = OusterProfile::rng19_rfl8_sig16_nir16;
};

constexpr std::array<PacketSensor, 21> kPacketSensors = {{
    {"VLP-16", false, 16, 55'296.0, 1206},
    {"VLP-16", true, 16, 55'296.0, 1206},
    {"HDL-32E", false, 32, 46'080.0, 1206},
    {"HDL-32E", true, 32, 46'080.0, 1206},
    {"Pandar64", true, 64, 55'560.0, 1198},
    {"PandarQT", false, 64, 500'000.0 / 3.0, 1072},
    {"XT32", false, 32, 50'000.0, 1080},
    {"XT32", true, 32, 50'000.0, 1080},
    {"Ouster OS1-16", false, 16, 0.0, 3328},
    {"Ouster OS1-16", true, 16, 0.0, 4352, OusterProfile::rng19_rfl8_sig16_nir16_dual},
    {"VLP-32C", false, 32, 55'296.0, 1206},
    {"VLP-32C", true, 32, 55'296.0, 1206},
    {"HDL-64E S3", false, 64, 48'000.0, 1206},
    {"HDL-64E S3", true, 64, 57'600.0, 1206},
    {"VLS-128", false, 128, 53'300.0, 1206},
    {"VLS-128", true, 128, 53'300.0, 1206},
    {"Ouster OS1-16", false, 16, 0.0, 3392, OusterProfile::legacy},
    {"Ouster OS1-16", false, 16, 0.0, 1280, OusterProfile::rng15_rfl8_nir8},
    {"Livox Avia", false, 6, 0.0, 1380},
    {"Ouster OS1-16", false, 16, 0.0, 4352, OusterProfile::rng19_rfl8_sig16_nir16_rgb16},
    {"Ouster OS1-16", true, 16, 0.0, 5376, OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual},
}};

bool is_named(const PacketSensor& from, std::string_view maker) {
  return std::string_view(from.name).starts_with(maker);
}

/// Time of a laser since the start of its firing sequence, as the model's packets imply.
double fire_time_ns(const Sensor& sensor, const PacketSensor& from, std::size_t laser) {
  if (const VelodyneModel* model = find_velodyne_model(sensor))
    return model->fire_time_ns(laser, from.is_dual);
  constexpr double kXt32Step_ns = 1512.0;
  return is_named(from, "XT32") ? kXt32Step_ns * static_cast<double>(laser) : 0.0;
}

Spinning spinning_of(const Sensor& sensor, const PacketSensor& from) {
  Spinning spinning;
  spinning.firing_period_ns = from.period_ns;
  if (from.period_ns == 0.0) spinning.columns_per_turn = 1024;
  for (std::size_t laser = 0; laser < from.lasers; ++laser) {
    SpinningChannel channel;
    channel.elevation_rad = 0.01 * static_cast<double>(laser);
    channel.fire_time_ns = fire_time_ns(sensor, from, laser);
    channel.ring = static_cast<std::uint16_t>(laser);
    spinning.channels.push_back(channel);
  }
  return spinning;
}

Sensor sensor_of(const PacketSensor& from) {
  Sensor sensor;
  sensor.name = from.name;
  sensor.rate_hz = Spinning{}.rotation_hz;
  sensor.receiver.returns = {Return{}};
  if (from.is_dual)
    sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  if (is_named(from, "Livox")) {
    sensor.optics = Prism{.prisms = {}, .incidence_rad = std::vector<double>(from.lasers, 0.01)};
  } else {
    sensor.optics = spinning_of(sensor, from);
  }
  return sensor;
}

std::uint16_t port_of(const PacketSensor& from) {
  if (is_named(from, "Ouster")) return kOusterLidarPort;
  return is_named(from, "Livox") ? kLivoxPointPort : kVelodynePort;
}

/// What users of decoded frames rely on.
void check_decoded(const std::vector<DecodedFrame>& frames) {
  for (const DecodedFrame& made : frames) {
    const std::size_t size = std::size_t{made.frame.rows} * made.frame.cols;
    demand(made.beams.size() == size && made.frame.range_m.size() == size,
           "a decoded frame has one entry per beam");
    for (const Eigen::Vector3d& direction : made.beams.directions) {
      const bool has_none = direction.array().isNaN().all();  // Livox: points without a return
      demand(has_none || std::abs(direction.squaredNorm() - 1.0) < 1e-9,
             "directions have unit length");
    }
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
  PacketOptions options;
  options.ouster.profile = from.profile;
  const auto decoder = make_packet_decoder(sensor_of(from), options);
  std::vector<DecodedFrame> frames;
  std::size_t valid = 0;
  for (std::size_t at = 1; at < text.size(); at += from.payload_bytes) {
    const auto bytes = std::as_bytes(std::span(text)).subspan(at);
    const auto payload = bytes.first(std::min(bytes.size(), from.payload_bytes));
    const UdpPacket packet{0, port_of(from), port_of(from), {payload.begin(), payload.end()}};
    valid += decode_one(*decoder, packet, frames) ? 1 : 0;
  }
  decoder->finish(frames);
  check_decoded(frames);
  if (valid == 0)
    throw Error({"packets", "no valid packet", std::string("packets of ") + from.name});
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
