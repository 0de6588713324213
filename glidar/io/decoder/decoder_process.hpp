// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/decoder/record_stream.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <sys/resource.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glidar {

/// Descriptors of the program: its standard streams are /dev/null, all others are closed.
inline constexpr int kAnswerFd = 3;   ///< it writes what it read
inline constexpr int kControlFd = 4;  ///< it writes progress, or reads requests
inline constexpr int kSharedFd = 5;   ///< memory for long records, when it does not read a model

/// The descriptors here that become those.
struct HelperFds {
  int answer = -1;
  int control = -1;
  int shared = -1;  ///< -1: none
};

/// The first argument of the program when it does not read a model; then DecoderKind::name, path,
/// memory in bytes, time in s, and id of this process.
inline constexpr const char* kDecodeOption = "--decode";

/// Exit status of the program when it has no memory left to report this in an answer.
inline constexpr int kExitNoMemory = 3;
/// The same when its answer exceeds the limit on the size of files, which holds for memory too.
inline constexpr int kExitFileSize = 4;

/// How the program ended.
enum class ImportEnd : std::uint8_t {
  answered,
  crashed,
  out_of_time,
  out_of_memory,
  over_file_size
};

struct HelperEnd {
  ImportEnd end = ImportEnd::crashed;
  int signal = 0;  ///< that ended it when crashed; 0: it exited without an answer
  rusage usage{};
};

[[noreturn]] void fail_to_start(const std::string& program, int error);

/// The descriptor duplicated above those of the program, so that it can get any of them. Closes
/// `fd`. Throws Error when it is -1, or none is free.
UniqueFd moved_up(const std::string& program, int fd);

/// Starts the program with these descriptors. Its environment contains only the search path of the
/// dynamic loader. Throws Error.
pid_t start_helper(std::vector<std::string> arguments, const HelperFds& fds);

/// True when the program has ended; it is not reaped yet. An unknown one counts as ended.
bool has_ended(pid_t helper);

/// Waits for the end of the program, after killing it if required.
HelperEnd end_helper(pid_t helper, bool is_killed);

/// "signal SIGSEGV, Segmentation fault"
std::string signal_name(int signal);

/// 20 s, plus 2 s per megabyte.
double default_time_limit_s(std::uint64_t file_bytes);

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

/// An image of whichever samples its kind of input has.
struct PixelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;  ///< channels of a texture, or the largest level of a grey image
};

void send_pixels(const PixelSize& size, std::span<const std::byte> bytes, RecordWriter& to);

struct ReceivedPixels {
  PixelSize size;
  std::vector<std::byte> bytes;
};

/// `bytes_of` returns the number of bytes that an image of this size has, or 0 when there is no
/// such image. Throws Error when the stream has others.
ReceivedPixels receive_pixels(DecoderRun run, std::uint64_t (*bytes_of)(const PixelSize& size));

}  // namespace glidar
