// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/sensor_packets.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <utility>

namespace glidar {
namespace {

[[noreturn]] void fail_of_maker(const Sensor& sensor) {
  throw Error({"packets of " + sensor.name, "no manufacturer's packets are known for this sensor",
               "VLP-16, Puck Hi-Res, VLP-32C, HDL-32E, HDL-64E S3, VLS-128, sensors of Ouster and "
               "Livox, Pandar64, PandarQT and XT32",
               "write clouds"});
}

std::array<float, 3> scaled(const Eigen::Vector3d& v, double scale) {
  return {static_cast<float>(v.x() * scale), static_cast<float>(v.y() * scale),
          static_cast<float>(v.z() * scale)};
}

/// Firmware manual, "IMU Data Packet Format": one sample with the time of each of its parts.
UdpPacket ouster_imu_packet(const ImuSamples& samples, std::size_t i, std::uint16_t port) {
  const auto stamp_ns = static_cast<std::uint64_t>(samples.t_ns[i]);
  const OusterImu imu{
      .stamp_ns = stamp_ns,
      .acceleration_stamp_ns = stamp_ns,
      .rate_stamp_ns = stamp_ns,
      .acceleration_g = scaled(samples.specific_force_m_s2[i], 1.0 / kStandardGravity_m_s2),
      .rate_deg_s = scaled(samples.angular_velocity_rad_s[i], kDegreesPerRadian)};
  return {samples.t_ns[i], port, port, encode(imu)};
}

UdpPacket livox_imu_packet(const ImuSamples& samples, std::size_t i) {
  LivoxPacket packet;
  packet.type = LivoxDataType::imu;
  packet.count = static_cast<std::uint16_t>(samples.first + i);
  packet.stamp_ns = static_cast<std::uint64_t>(samples.t_ns[i]);
  packet.rate_rad_s = scaled(samples.angular_velocity_rad_s[i], 1.0);
  packet.acceleration_g = scaled(samples.specific_force_m_s2[i], 1.0 / kStandardGravity_m_s2);
  return {samples.t_ns[i], kLivoxImuSourcePort, kLivoxImuPort, encode(packet)};
}

bool is_earlier_packet(const UdpPacket& a, const UdpPacket& b) {
  return a.stamp_ns < b.stamp_ns;
}

}  // namespace

std::vector<std::string> packet_columns(const PacketOptions& options) {
  std::vector<std::string> columns = {"xyz", "intensity", "range"};
  if (options.ouster.profile && has_colour(*options.ouster.profile)) columns.emplace_back("colour");
  return columns;
}

bool has_packets(const Sensor& sensor) {
  return is_velodyne(sensor) || is_ouster(sensor) || is_hesai(sensor) || is_livox(sensor);
}

bool has_imu_packets(const Sensor& sensor) {
  return is_ouster(sensor) || is_livox(sensor);
}

bool has_packet_messages(const Sensor& sensor) {
  return is_velodyne(sensor) || is_ouster(sensor);
}

std::unique_ptr<PacketEncoder> make_packet_encoder(const Sensor& sensor,
                                                   const PacketOptions& options) {
  if (is_velodyne(sensor)) return make_velodyne_encoder(sensor, options.position);
  if (is_ouster(sensor)) return make_ouster_encoder(sensor, options.ouster);
  if (is_hesai(sensor)) return make_hesai_encoder(sensor);
  if (is_livox(sensor)) return make_livox_encoder(sensor, options.livox_type);
  fail_of_maker(sensor);
}

std::unique_ptr<PacketDecoder> make_packet_decoder(const Sensor& sensor,
                                                   const PacketOptions& options) {
  if (is_velodyne(sensor)) return make_velodyne_decoder(sensor);
  if (is_ouster(sensor)) return make_ouster_decoder(sensor, options.ouster);
  if (is_hesai(sensor)) return make_hesai_decoder(sensor);
  if (is_livox(sensor)) return make_livox_decoder(sensor);
  fail_of_maker(sensor);
}

SensorPackets::SensorPackets(const Sensor& sensor, const PacketOptions& options,
                             PacketImuSampler imu_samples)
    : sensor_(sensor),
      encoder_(make_packet_encoder(sensor, options)),
      imu_samples_(is_ouster(sensor) || is_livox(sensor) ? std::move(imu_samples)
                                                         : PacketImuSampler()),
      is_livox_(is_livox(sensor)),
      imu_port_(options.ouster.identity.imu_port) {}

void SensorPackets::encode(const Frame& frame, const Beams& beams,
                           std::vector<UdpPacket>& packets) {
  const auto first = static_cast<std::ptrdiff_t>(packets.size());
  encoder_->encode(frame, beams, packets);
  if (!imu_samples_) return;
  const auto middle = static_cast<std::ptrdiff_t>(packets.size());
  const FrameInterval interval = frame_interval(sensor_, frame.number);
  encode_imu(frame.stamp_ns, frame.stamp_ns + (interval.end_ns - interval.start_ns), packets);
  std::inplace_merge(packets.begin() + first, packets.begin() + middle, packets.end(),
                     is_earlier_packet);
}

void SensorPackets::finish(std::vector<UdpPacket>& packets) {
  encoder_->finish(packets);
}

/// The samples from the end of the encoded ones on; from the start of the first frame on.
void SensorPackets::encode_imu(std::int64_t from_ns, std::int64_t until_ns,
                               std::vector<UdpPacket>& packets) {
  const std::int64_t begin_ns = imu_ns_.value_or(from_ns);
  if (until_ns <= begin_ns) return;
  const ImuSamples samples = imu_samples_(begin_ns, until_ns);
  imu_ns_ = until_ns;
  for (std::size_t i = 0; i < samples.t_ns.size(); ++i) {
    packets.push_back(is_livox_ ? livox_imu_packet(samples, i)
                                : ouster_imu_packet(samples, i, imu_port_));
  }
}

bool is_capture_name(const std::filesystem::path& path) {
  return path.extension() == ".pcap";
}

PacketWriter::PacketWriter(const std::filesystem::path& path, const Sensor& sensor,
                           const PacketOptions& options, PacketImuSampler imu_samples)
    : packets_(sensor, options, std::move(imu_samples)),
      pcap_(path),
      path_(path),
      metadata_(is_ouster(sensor) ? ouster_metadata(sensor, options.ouster) : "") {}

void PacketWriter::write(const Frame& frame, const Beams& beams) {
  packets_.encode(frame, beams, made_);
  write_packets();
}

void PacketWriter::write_packets() {
  for (const UdpPacket& packet : made_) pcap_.write(packet);
  count_ += made_.size();
  made_.clear();
}

std::vector<std::filesystem::path> PacketWriter::files() const {
  if (metadata_.empty()) return {path_};
  return {path_, std::filesystem::path(path_).replace_extension(".json")};
}

void PacketWriter::finish() {
  packets_.finish(made_);
  write_packets();
  pcap_.finish();
  if (!metadata_.empty()) {
    AtomicFile json(files().back());
    json.write(metadata_);
    json.finish();
    pcap_.commit();
    json.commit();
    return;
  }
  pcap_.commit();
}

}  // namespace glidar
