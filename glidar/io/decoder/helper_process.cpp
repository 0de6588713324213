// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/helper_process.hpp>

#include <glidar/core/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

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
  ended.end = ended.signal == SIGXCPU   ? ImportEnd::out_of_time
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

}  // namespace glidar
