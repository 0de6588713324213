// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/decoder_process.hpp>

#include <glidar/core/elapsed_time.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/decoder/helper_process.hpp>
#include <glidar/io/decoder/import_program.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kDecoderMiB = std::uint64_t{1} << 20U;

/// Of the file, or of the files in the folder.
std::uint64_t input_bytes_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    const std::uintmax_t size = fs::file_size(path, error);
    return error ? 0 : size;
  }
  std::uint64_t bytes = 0;
  for (fs::directory_iterator at(path, error), end; !error && at != end; at.increment(error)) {
    std::error_code ignored;
    const std::uintmax_t size = at->is_regular_file(ignored) ? at->file_size(ignored) : 0;
    if (!ignored) bytes += size;
  }
  return bytes;
}

/// Address space in bytes: the program and its libraries, three times what readers may hold, and
/// the input, of which at most 4 GiB count.
std::uint64_t decoder_memory(std::uint64_t input_bytes) {
  const std::uint64_t held = InputBudget(input_bytes).limit(Budget::held_bytes);
  return 512 * kDecoderMiB + 3 * held + std::min(input_bytes, 4096 * kDecoderMiB);
}

class DecoderProcess {
 public:
  DecoderProcess(const DecoderKind& kind, const fs::path& path, std::uint64_t input_bytes)
      : path_(path.string()),
        time_limit_s_(kind.time_limit_s > 0.0 ? kind.time_limit_s
                                              : default_time_limit_s(input_bytes)),
        memory_limit_bytes_(decoder_memory(input_bytes) + 4 * kind.max_payload) {
    const std::string program = import_program().string();
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) fail_to_start(program, errno);
    answer_ = moved_up(program, pipe[0]);
    const UniqueFd answer_end = moved_up(program, pipe[1]);
    std::array<int, 2> sockets{};  // a write to it without a reader raises no signal
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
      fail_to_start(program, errno);
    control_ = moved_up(program, sockets[0]);
    const UniqueFd control_end = moved_up(program, sockets[1]);
    const int memory = SharedRing::create();
    if (memory < 0) throw Error({"shared memory", std::generic_category().message(errno)});
    const UniqueFd shared = moved_up(program, memory);
    ring_ = std::make_shared<SharedRing>(shared.get());
    // the pipe stays smaller if the system forbids this size
    ::fcntl(answer_.get(), F_SETPIPE_SZ, static_cast<int>(kDecoderMiB));
    ::fcntl(answer_.get(), F_SETFL, O_NONBLOCK);
    helper_ =
        start_helper({program, kDecodeOption, kind.name, path_, std::to_string(memory_limit_bytes_),
                      fmt::format("{:.3f}", time_limit_s_), std::to_string(::getpid())},
                     {answer_end.get(), control_end.get(), shared.get()});
  }
  DecoderProcess(const DecoderProcess&) = delete;
  DecoderProcess& operator=(const DecoderProcess&) = delete;
  ~DecoderProcess() {
    if (helper_ != 0) end_helper(helper_, true);
  }

  std::size_t read(std::span<std::byte> to) {
    for (;;) {
      const ssize_t got = ::read(answer_.get(), to.data(), to.size());
      if (got > 0) return static_cast<std::size_t>(got);
      const bool is_closed = got == 0 || (errno != EAGAIN && errno != EINTR);
      // another process may hold the other end, so the end of the helper is checked too
      if (is_closed || (!wait() && !has_bytes())) fail();
    }
  }

  [[nodiscard]] std::shared_ptr<SharedRing> ring() const { return ring_; }

  void send(std::span<const std::byte> bytes) const {
    [[maybe_unused]] const ssize_t sent =
        ::send(control_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

 private:
  static constexpr int kSlice_ms = 100;

  /// Waits for bytes. False: the helper has ended.
  bool wait() {
    pollfd watched{answer_.get(), POLLIN, 0};
    if (poll_in_time(&watched, 1, kSlice_ms) != 0) return true;
    return !has_ended(helper_);
  }

  [[nodiscard]] bool has_bytes() const {
    pollfd watched{answer_.get(), POLLIN, 0};
    return ::poll(&watched, 1, 0) > 0 && (watched.revents & POLLIN) != 0;
  }

  /// poll(), whose time counts. Throws Error when the time limit is exceeded.
  int poll_in_time(pollfd* watched, nfds_t count, int slice_ms) {
    if (waited_s_ > time_limit_s_) {
      end(true);
      fail_for_time();
    }
    const auto start = std::chrono::steady_clock::now();
    const int ready = ::poll(watched, count, slice_ms);
    waited_s_ += seconds_since(start);
    return ready;
  }

  /// The helper closed the stream or ended: reports why. A closed stream comes just before the end.
  [[noreturn]] void fail() {
    constexpr int kGrace_ms = 1;
    for (int i = 0; i < 1000 && !has_ended(helper_); ++i) poll_in_time(nullptr, 0, kGrace_ms);
    const bool is_running = !has_ended(helper_);
    const HelperEnd ended = end(is_running);
    if (ended.end == ImportEnd::out_of_time) fail_for_time();
    if (ended.end == ImportEnd::out_of_memory) {
      throw Error({path_,
                   fmt::format("reading it needs more memory than {} MiB",
                               memory_limit_bytes_ / kDecoderMiB),
                   "", "the file is damaged or malicious"});
    }
    const bool is_crash = ended.signal != 0 && !is_running;
    throw Error({path_,
                 is_crash ? "the process that reads it crashed (" + signal_name(ended.signal) + ")"
                          : "the process that reads it ended without an answer",
                 "", "the file is damaged or malicious"});
  }

  [[noreturn]] void fail_for_time() const {
    throw Error({path_, fmt::format("reading it took longer than {:g} s", time_limit_s_), "",
                 "the file is damaged or malicious; a sound one needs a faster disk or machine"});
  }

  HelperEnd end(bool is_killed) { return end_helper(std::exchange(helper_, 0), is_killed); }

  std::string path_;
  double time_limit_s_;
  std::uint64_t memory_limit_bytes_;
  UniqueFd answer_;
  UniqueFd control_;
  std::shared_ptr<SharedRing> ring_;
  pid_t helper_ = 0;
  double waited_s_ = 0.0;
};

}  // namespace

DecoderRun start_decoder(const DecoderKind& kind, const fs::path& path) {
  const std::uint64_t bytes = input_bytes_of(path);
  const std::uint64_t max_payload =
      kind.max_payload != 0 ? kind.max_payload : InputBudget(bytes).limit(Budget::held_bytes);
  const auto process = std::make_shared<DecoderProcess>(kind, path, bytes);
  return {RecordReader([process](std::span<std::byte> to) { return process->read(to); },
                       path.string(), max_payload, process->ring()),
          [process](std::span<const std::byte> bytes_sent) { process->send(bytes_sent); }, bytes};
}

}  // namespace glidar
