// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: files of others other than models are read in the sandboxed process too.

#include <glidar/io/decoder/record_stream.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace glidar {

/// What the process reads; the name is its argument.
struct DecoderKind {
  const char* name;
  std::uint64_t max_payload = 0;  ///< bytes of a record; 0: by the budget of the input
  double time_limit_s = 0.0;      ///< 0: default_time_limit_s of the input's size
};

inline constexpr DecoderKind kBagDecoder = {"bag"};
inline constexpr DecoderKind kCaptureDecoder = {"capture"};

/// A run of the process, which ends with the last copy of `records` and `request`.
struct DecoderRun {
  RecordReader records;
  /// Sends bytes to the process; it fails silently when the process has ended, which the next
  /// record reports.
  std::function<void(std::span<const std::byte>)> request;
  std::uint64_t input_bytes = 0;
};

/// Starts the program glidar-import for a file or a folder. It may read only these, and it gets a
/// limited memory and time of the processor, in proportion to their size. Whatever it does, waiting
/// for it ends after the same time: time between calls does not count. Throws Error when the
/// program cannot be found or started.
DecoderRun start_decoder(const DecoderKind& kind, const std::filesystem::path& path);

}  // namespace glidar
