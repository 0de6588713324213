// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/livox.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/velodyne.hpp>
#include <glidar/sensor/imu.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// Options of packets that only some manufacturers have.
struct PacketOptions {
  std::optional<GeoPosition> position;  ///< Velodyne
  OusterOptions ouster;
  LivoxDataType livox_type = LivoxDataType::cartesian_mm;  ///< of points
};

/// The cloud columns that packets need.
std::vector<std::string> packet_columns(const PacketOptions& options);

/// Whether the sensor is named after a model whose packets are known.
bool has_packets(const Sensor& sensor);

/// Whether the ROS driver of the sensor's manufacturer publishes its packets in messages that are
/// known: those of Ouster and Velodyne.
bool has_packet_messages(const Sensor& sensor);

/// Whether the sensor also sends the samples of its IMU: those of Ouster and Livox.
bool has_imu_packets(const Sensor& sensor);

/// The encoder of the sensor's manufacturer, by the sensor's name. Throws Error, naming the sensor,
/// when it has none or its beams do not fit.
std::unique_ptr<PacketEncoder> make_packet_encoder(const Sensor& sensor,
                                                   const PacketOptions& options = {});

/// The decoder for the packets of make_packet_encoder(). Throws Error like make_packet_encoder.
std::unique_ptr<PacketDecoder> make_packet_decoder(const Sensor& sensor,
                                                   const PacketOptions& options = {});

/// The samples of a sensor's IMU with from_ns <= t < until_ns.
using PacketImuSampler = std::function<ImuSamples(std::int64_t from_ns, std::int64_t until_ns)>;

/// Everything that a sensor sends: the packets of its frames, and those of its IMU if its
/// manufacturer has such (Ouster, Livox), in the order of their times.
class SensorPackets {
 public:
  /// `imu_samples` empty: no packets of an IMU. Throws Error like make_packet_encoder.
  explicit SensorPackets(const Sensor& sensor, const PacketOptions& options = {},
                         PacketImuSampler imu_samples = {});

  /// Appends the packets until the end of a frame. Frames are in the order of time. Throws Error
  /// when they are not of the sensor.
  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets);
  /// Appends the last packet, filled with firings without returns.
  void finish(std::vector<UdpPacket>& packets);

 private:
  void encode_imu(std::int64_t from_ns, std::int64_t until_ns, std::vector<UdpPacket>& packets);

  Sensor sensor_;
  std::unique_ptr<PacketEncoder> encoder_;
  PacketImuSampler imu_samples_;
  bool is_livox_ = false;
  std::uint16_t imu_port_ = 0;
  std::optional<std::int64_t> imu_ns_;  ///< end of the encoded samples; empty: none yet
};

/// True for the names of packet captures: with the suffix .pcap.
bool is_capture_name(const std::filesystem::path& path);

/// Writes the frames of a sensor, one after the other, as packets to a pcap file, and for Ouster
/// the metadata beside it (scan.pcap: scan.json). The files appear together in finish().
class PacketWriter {
 public:
  /// Throws Error like make_packet_encoder and PcapWriter.
  PacketWriter(const std::filesystem::path& path, const Sensor& sensor,
               const PacketOptions& options = {}, PacketImuSampler imu_samples = {});

  /// Frames in the order of time. Throws Error when they are not of the sensor, or the disk is
  /// full.
  void write(const Frame& frame, const Beams& beams);
  /// Writes the last packet and gives the files their names. Without it no file remains.
  void finish();

  [[nodiscard]] std::uint64_t packets() const { return count_; }
  /// All files that finish() makes.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  void write_packets();

  SensorPackets packets_;
  PcapWriter pcap_;
  std::filesystem::path path_;
  std::string metadata_;  ///< empty: none
  std::vector<UdpPacket> made_;
  std::uint64_t count_ = 0;
};

}  // namespace glidar
