// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Both ends of the stream of a packet capture.

#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/packets/packet_codec.hpp>

#include <filesystem>

namespace glidar {

/// Sends all datagrams of a capture: only in the sandboxed process. Throws Error like PcapReader.
void send_packets(const std::filesystem::path& capture, RecordWriter& to);

/// Reads the UDP datagrams of a pcap or pcapng file, with fragments joined, by the sandboxed
/// process glidar-import.
class CapturedPackets {
 public:
  /// Throws Error when the file is missing.
  explicit CapturedPackets(const std::filesystem::path& capture);
  /// Reads the datagrams of a running process.
  explicit CapturedPackets(DecoderRun run) : run_(std::move(run)), budget_(run_.input_bytes) {}

  /// The next datagram; false at the end. Throws Error where the file is malformed.
  bool next(UdpPacket& packet);

 private:
  DecoderRun run_;
  InputBudget budget_;
  bool has_ended_ = false;
};

}  // namespace glidar
