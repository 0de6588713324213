// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/decoder_process.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/decoder/import_program.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

/// The environment of the program: the search path of the dynamic loader and, if it is built with
/// sanitizers, their options. It contains no secrets that a malicious file could read. Assimp turns
/// objects by sines of the C library, so glibc selects those for processors without FMA: a model is
/// the same on every x86-64 processor.
std::vector<std::string> helper_environment() {
  std::vector<const char*> names = {"LD_LIBRARY_PATH"};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  names.insert(names.end(), {"ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"});
#endif
  std::vector<std::string> all = {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4"};
  for (const char* name : names) {
    const char* value = std::getenv(name);
    if (value != nullptr) all.push_back(std::string(name) + "=" + value);
  }
  return all;
}

/// The strings as posix_spawn requires them; pointers into `texts`.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

class SpawnActions {
 public:
  explicit SpawnActions(const HelperFds& fds) {
    posix_spawn_file_actions_init(&actions_);
    for (const int standard : {0, 1, 2}) {
      posix_spawn_file_actions_addopen(&actions_, standard, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&actions_, fds.answer, kAnswerFd);
    posix_spawn_file_actions_adddup2(&actions_, fds.control, kControlFd);
    const bool has_shared = fds.shared >= 0;
    if (has_shared) posix_spawn_file_actions_adddup2(&actions_, fds.shared, kSharedFd);
    posix_spawn_file_actions_addclosefrom_np(&actions_, has_shared ? kSharedFd + 1 : kSharedFd);
  }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

ImportEnd ending_of(int exit_code) {
  switch (exit_code) {
    case 0:
      return ImportEnd::answered;
    case kExitNoMemory:
      return ImportEnd::out_of_memory;
    case kExitFileSize:
      return ImportEnd::over_file_size;
    default:
      return ImportEnd::crashed;
  }
}

}  // namespace

void fail_to_start(const std::string& program, int error) {
  throw Error(
      {.where = program, .found = std::string("cannot be started: ") + std::strerror(error)});
}

UniqueFd moved_up(const std::string& program, int fd) {
  if (fd < 0) fail_to_start(program, errno);
  const UniqueFd low(fd);
  UniqueFd moved(::fcntl(low.get(), F_DUPFD_CLOEXEC, kSharedFd + 1));
  if (!moved) fail_to_start(program, errno);
  return moved;
}

pid_t start_helper(std::vector<std::string> arguments, const HelperFds& fds) {
  const std::string program = arguments.front();
  std::vector<std::string> variables = helper_environment();
  const SpawnActions actions(fds);
  pid_t helper = 0;
  const int error = ::posix_spawn(&helper, program.c_str(), actions.get(), nullptr,
                                  pointers_to(arguments).data(), pointers_to(variables).data());
  if (error != 0) fail_to_start(program, error);
  return helper;
}

bool has_ended(pid_t helper) {
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(helper), &info, WEXITED | WNOHANG | WNOWAIT) != 0) {
    return errno != EINTR;
  }
  return info.si_pid == helper;
}

HelperEnd end_helper(pid_t helper, bool is_killed) {
  if (is_killed) ::kill(helper, SIGKILL);
  HelperEnd ended;
  int status = 0;
  while (::wait4(helper, &status, 0, &ended.usage) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) {
    ended.end = ending_of(WEXITSTATUS(status));
    return ended;
  }
  ended.signal = WTERMSIG(status);
  const bool is_late = ended.signal == SIGXCPU || ended.signal == SIGPROF;
  ended.end = is_late                   ? ImportEnd::out_of_time
              : ended.signal == SIGXFSZ ? ImportEnd::over_file_size
                                        : ImportEnd::crashed;
  return ended;
}

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  const char* words = ::sigdescr_np(signal);
  return fmt::format("signal SIG{}, {}", name != nullptr ? name : std::to_string(signal),
                     words != nullptr ? words : "unknown");
}

double default_time_limit_s(std::uint64_t file_bytes) {
  constexpr double kMin = 20.0;
  constexpr double kPerByte = 2e-6;  // fifty times the duration of a slow format on a slow machine
  return kMin + kPerByte * static_cast<double>(file_bytes);
}

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

void send_pixels(const PixelSize& size, std::span<const std::byte> bytes, RecordWriter& to) {
  std::vector<std::byte> payload(sizeof size + bytes.size());
  std::memcpy(payload.data(), &size, sizeof size);
  std::memcpy(payload.data() + sizeof size, bytes.data(), bytes.size());
  to.write({RecordKind::item, 0, 0, payload});
  to.flush();
}

ReceivedPixels receive_pixels(DecoderRun run, std::uint64_t (*bytes_of)(const PixelSize& size)) {
  const Record record = run.records.next();
  ReceivedPixels pixels;
  if (record.kind != RecordKind::item || record.payload.size() <= sizeof pixels.size)
    run.records.reject("no image");
  std::memcpy(&pixels.size, record.payload.data(), sizeof pixels.size);
  const std::span<const std::byte> bytes = record.payload.subspan(sizeof pixels.size);
  if (bytes.size() != bytes_of(pixels.size)) run.records.reject("an image of another size");
  pixels.bytes.assign(bytes.begin(), bytes.end());
  return pixels;
}

}  // namespace glidar
