// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: the records of capture files.

#include <glidar/io/files/input_file.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

}  // namespace glidar
