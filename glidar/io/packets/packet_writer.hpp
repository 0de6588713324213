// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

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
