// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/packets/capture_reader.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/io/packets/udp_datagram.hpp>

#include <cstdint>
#include <filesystem>

namespace glidar {

/// Writes datagrams as a pcap file (microseconds, Ethernet), which appears under its name when it
/// is committed.
class PcapWriter {
 public:
  /// Throws Error like AtomicFile.
  explicit PcapWriter(const std::filesystem::path& path, const UdpRoute& route = {});

  /// Throws Error when the stamp is before 1970 or after 2106, or the disk is full.
  void write(const UdpPacket& packet);
  /// Completes the temporary file, see AtomicFile.
  void finish() { file_.finish(); }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
  UdpRoute route_;
  std::uint16_t id_ = 0;
};

/// Reads the UDP datagrams of a pcap or pcapng file, with fragments joined, in this process: see
/// CapturedPackets.
class PcapReader {
 public:
  /// Throws Error like CaptureReader.
  explicit PcapReader(const std::filesystem::path& path) : records_(path) {}

  /// The next datagram; false at the end. Throws Error where the file is malformed.
  bool next(UdpPacket& packet);

 private:
  CaptureReader records_;
  DatagramReader datagrams_;
};

}  // namespace glidar
