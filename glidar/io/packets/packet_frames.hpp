// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/bags/bag.hpp>
#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/packets/packet_codec.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// Both ends of the stream of a packet capture.

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

/// A file of packets.
class PacketSource {
 public:
  PacketSource() = default;
  PacketSource(const PacketSource&) = delete;
  PacketSource& operator=(const PacketSource&) = delete;
  virtual ~PacketSource() = default;

  /// The next packet; false at the end. Throws Error where the file is damaged.
  virtual bool next(UdpPacket& packet) = 0;
};

/// The packets of a capture. Throws Error when there is no such file.
std::unique_ptr<PacketSource> open_packets(const std::filesystem::path& path);
/// Those of a topic of VelodyneScan or PacketMsg of a bag; `topic` empty: the first one that fits.
/// `path` names the bag in errors. Throws Error when there is no such topic.
std::unique_ptr<PacketSource> packets_of(std::unique_ptr<bags::BagReader> bag,
                                         const std::filesystem::path& path,
                                         const std::string& topic);

/// The metadata that Ouster's driver records in a bag: the first message of the first topic of text
/// messages named `metadata`. Empty: none, or no bag.
std::string ouster_metadata_of(const std::filesystem::path& path);
std::string ouster_metadata_of(bags::BagReader& bag);

/// The frames of a file of packets, one for each revolution.
class PacketFrames {
 public:
  PacketFrames(std::unique_ptr<PacketSource> packets, std::unique_ptr<PacketDecoder> decoder)
      : packets_(std::move(packets)), decoder_(std::move(decoder)) {}

  /// The next frame; false at the end. Packets that are malformed are left out.
  bool next(DecodedFrame& frame);
  /// Packets that were left out, and why the first of them was.
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }
  [[nodiscard]] const std::string& first_error() const { return first_error_; }

 private:
  void read();

  std::unique_ptr<PacketSource> packets_;
  std::unique_ptr<PacketDecoder> decoder_;
  std::vector<DecodedFrame> decoded_;
  std::size_t next_ = 0;  ///< of `decoded_`
  bool is_over_ = false;
  std::uint64_t malformed_ = 0;
  std::string first_error_;
};

}  // namespace glidar
