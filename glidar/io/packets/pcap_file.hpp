// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/packets/packet_codec.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace glidar {

/// How the bytes of a record begin (https://www.tcpdump.org/linktypes.html).
enum class LinkType : std::uint16_t {
  null = 0,
  ethernet = 1,
  raw = 101,
  linux_sll = 113,
  linux_sll2 = 276,
};

/// One captured frame of a network; the bytes are valid until the next record is read.
struct CaptureRecord {
  std::int64_t stamp_ns = 0;  ///< since 1970
  std::uint16_t link_type = 0;
  std::span<const std::byte> bytes;
};

/// Opens a capture file. Throws Error like open_input_file.
InputFile open_capture_file(const std::filesystem::path& path);

/// Reads pcap files of either byte order with micro- or nanoseconds (draft-ietf-opsawg-pcap) and
/// pcapng files (draft-ietf-opsawg-pcapng: section, interface, enhanced and simple packet blocks).
/// Memory is bounded whatever the file contains.
class CaptureReader {
 public:
  /// Throws Error when the file is missing or no capture file.
  explicit CaptureReader(const std::filesystem::path& path);

  /// The next record; false at the end. Throws Error, with the offset, where the file is malformed.
  /// An incomplete last record, as of an interrupted capture, is the end.
  bool next(CaptureRecord& record);

 private:
  struct Interface {
    std::uint16_t link_type = 0;
    std::uint64_t ticks_per_s = 1'000'000;
  };

  bool fill(std::size_t size);
  bool next_classic(CaptureRecord& record);
  bool next_block(CaptureRecord& record);
  bool read_block(std::uint32_t type, std::span<const std::byte> body, CaptureRecord& record);
  void start_section(std::span<const std::byte> head);
  void add_interface(std::span<const std::byte> body);
  [[nodiscard]] std::uint64_t number(std::span<const std::byte> bytes, std::size_t at,
                                     std::size_t count) const;
  [[noreturn]] void fail(const char* found, const char* allowed) const;

  std::filesystem::path path_;
  InputFile file_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;     ///< of the bytes that were read but not used
  std::uint64_t offset_ = 0;  ///< in the file, of `begin_`
  bool is_big_endian_ = false;
  bool is_next_generation_ = false;
  std::vector<Interface> interfaces_;
};

/// Sender and receiver of the datagrams in a capture file.
struct UdpRoute {
  std::array<std::uint8_t, 4> source = {192, 168, 1, 201};  ///< Velodyne's and Hesai's default
  std::array<std::uint8_t, 4> destination = {255, 255, 255, 255};
};

/// The largest payload of a datagram.
inline constexpr std::size_t kMaxUdpPayload = 65'507;

/// The Ethernet frames of a datagram, with checksums: several if it is larger than 1472 bytes
/// (RFC 791, RFC 768). `id` distinguishes the datagrams of a sender. Throws Error above
/// kMaxUdpPayload.
std::vector<std::vector<std::byte>> ethernet_frames(const UdpPacket& packet, const UdpRoute& route,
                                                    std::uint16_t id);

/// Extracts the UDP datagrams of captured IPv4 frames and joins fragments. Everything else is
/// ignored; memory is bounded.
class DatagramReader {
 public:
  /// The datagram that this record completes.
  std::optional<UdpPacket> add(const CaptureRecord& record);

 private:
  struct Partial {
    std::array<std::byte, 10> key{};  ///< source, destination and id
    std::size_t size = 0;             ///< 0: the last fragment is missing
    std::size_t received = 0;
    std::vector<bool> has_unit;  ///< units of 8 bytes
    std::vector<std::byte> bytes;
  };

  std::optional<UdpPacket> add_fragment(const Partial& found, std::size_t at, bool is_last,
                                        std::span<const std::byte> part, std::int64_t stamp_ns);

  std::deque<Partial> partials_;  ///< the oldest first
};

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
