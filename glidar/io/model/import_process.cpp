// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/import_process.hpp>
#include <glidar/io/model/import_program.hpp>

#include <glidar/core/elapsed_time.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

namespace glidar {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
constexpr double kQuietSeconds = 0.5;    // shorter loads report no progress
constexpr int kSliceMilliseconds = 100;  // between checks of the time limit
constexpr int kEndMilliseconds = 1;      // the same once the progress is closed, as at the end
constexpr int kAnswerFd = 3;
constexpr int kProgressFd = 4;

[[noreturn]] void cannot_start(const std::string& program, int error) {
  throw Error(
      {.where = program, .found = std::string("cannot be started: ") + std::strerror(error)});
}

/// The environment of the process: the search path of the dynamic loader and, if
/// it is built with sanitizers, their options. It contains no secrets that a malicious model could
/// read.
std::vector<std::string> environment() {
  std::vector<const char*> names = {"LD_LIBRARY_PATH"};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  names.insert(names.end(), {"ASAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"});
#endif
  std::vector<std::string> all;
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

/// Its standard streams are /dev/null, descriptors 3 and 4 are passed to it, all others are closed.
class SpawnPlan {
 public:
  SpawnPlan(int answer, int progress) {
    posix_spawn_file_actions_init(&actions_);
    for (const int standard : {0, 1, 2}) {
      posix_spawn_file_actions_addopen(&actions_, standard, "/dev/null", O_RDWR, 0);
    }
    posix_spawn_file_actions_adddup2(&actions_, answer, kAnswerFd);
    posix_spawn_file_actions_adddup2(&actions_, progress, kProgressFd);
    posix_spawn_file_actions_addclosefrom_np(&actions_, kProgressFd + 1);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;
  ~SpawnPlan() { posix_spawn_file_actions_destroy(&actions_); }

  pid_t start(const std::string& program, std::vector<std::string> arguments) const {
    std::vector<std::string> variables = environment();
    pid_t child = 0;
    const int error = ::posix_spawn(&child, program.c_str(), &actions_, nullptr,
                                    pointers_to(arguments).data(), pointers_to(variables).data());
    if (error != 0) cannot_start(program, error);
    return child;
  }

 private:
  posix_spawn_file_actions_t actions_{};
};

struct ProgressPipe {
  UniqueFd read_end;
  UniqueFd write_end;
};

/// Moved above the descriptors of the child, so that duplicating them there cannot collide.
UniqueFd moved_up(int fd) {
  const UniqueFd low(fd);
  return UniqueFd(::fcntl(low.get(), F_DUPFD_CLOEXEC, kProgressFd + 1));
}

ProgressPipe make_pipe(const std::string& program) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) cannot_start(program, errno);
  ProgressPipe pipe{moved_up(ends[0]), moved_up(ends[1])};
  if (!pipe.read_end || !pipe.write_end) cannot_start(program, errno);
  return pipe;
}

UniqueFd make_answer(const std::string& program) {
  UniqueFd answer = moved_up(::memfd_create("glidar-import", MFD_CLOEXEC));
  if (!answer) cannot_start(program, errno);
  return answer;
}

/// True when the child has ended; it is not reaped yet. An unknown child counts as ended.
bool has_ended(pid_t child) {
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0) {
    return errno != EINTR;
  }
  return info.si_pid == child;
}

/// Reads percent bytes until the process ends. It may close the pipe earlier, and another fork may
/// hold the pipe's other end, so only the end of the process counts. False when the time limit was
/// exceeded.
bool wait_for_end(pid_t child, const ProgressPipe& pipe, const ImportRequest& request,
                  const Report& report) {
  const Clock::time_point start = Clock::now();
  const std::string task = "loading " + request.model.filename().string();
  double fraction = -1.0;
  pollfd watched{pipe.read_end.get(), POLLIN, 0};
  for (;;) {
    const double left_s = request.time_limit_s - seconds_since(start);
    if (left_s <= 0.0) return false;
    const int most = watched.fd < 0 ? kEndMilliseconds : kSliceMilliseconds;
    const int ready = ::poll(&watched, 1, std::min(most, static_cast<int>(left_s * 1000.0) + 1));
    if (ready == 0 && has_ended(child)) return true;
    if (ready > 0) {
      std::array<unsigned char, 256> percents{};
      const ssize_t got = ::read(watched.fd, percents.data(), percents.size());
      if (got == 0 || (got < 0 && errno != EINTR)) watched.fd = -1;
      if (got > 0) fraction = std::min(1.0, percents[static_cast<std::size_t>(got) - 1] / 100.0);
    }
    if (report.progress && seconds_since(start) > kQuietSeconds) report.progress(task, fraction);
  }
}

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  const char* words = ::sigdescr_np(signal);
  return fmt::format("signal SIG{}, {}", name != nullptr ? name : std::to_string(signal),
                     words != nullptr ? words : "unknown");
}

[[noreturn]] void fail(const ImportRequest& request, std::string found, std::string remedy) {
  throw Error(
      {.where = request.model.string(), .found = std::move(found), .remedy = std::move(remedy)});
}

/// How a process ended, and the resources it used.
struct Ending {
  int status = 0;
  rusage usage{};
};

/// Waits for the process, after killing it if necessary.
Ending end(pid_t child, bool is_killed) {
  if (is_killed) ::kill(child, SIGKILL);
  Ending ending;
  while (::wait4(child, &ending.status, 0, &ending.usage) < 0 && errno == EINTR) {
  }
  return ending;
}

/// Exit status of the import program when it has no memory left to report this in a block.
constexpr int kExitNoMemory = 3;
/// The same when its answer exceeds the limit on the size of files, which holds for memory too.
constexpr int kExitFileSize = 4;

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

rlim_t max_file_bytes() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 ? limit.rlim_max : RLIM_INFINITY;
}

void classify(ImportRun& run, int status) {
  if (WIFEXITED(status)) {
    run.end = ending_of(WEXITSTATUS(status));
  } else {
    run.signal = WTERMSIG(status);
    run.end = run.signal == SIGXCPU   ? ImportEnd::out_of_time
              : run.signal == SIGXFSZ ? ImportEnd::over_file_size
                                      : ImportEnd::crashed;
  }
  // the process limits itself to its memory, unless this process has a lower limit
  if (run.end == ImportEnd::over_file_size && max_file_bytes() >= run.memory_limit_bytes)
    run.end = ImportEnd::out_of_memory;
}

}  // namespace

std::uint64_t default_memory_limit(std::uint64_t file_bytes) {
  constexpr std::uint64_t kUnfolding = 40;
  return std::max(kGiB, file_bytes > kGiB * kGiB / kUnfolding ? kGiB : file_bytes * kUnfolding);
}

double default_time_limit_s(std::uint64_t file_bytes) {
  constexpr double kMin = 20.0;
  constexpr double kPerByte = 2e-6;  // fifty times the duration of a slow format on a slow machine
  return kMin + kPerByte * static_cast<double>(file_bytes);
}

ImportRun run_import(const ImportRequest& request, const Report& report) {
  const std::string program = import_program().string();
  ImportRun run;
  run.memory_limit_bytes = request.memory_limit_bytes != 0
                               ? request.memory_limit_bytes
                               : default_memory_limit(fs::file_size(request.model));
  run.answer = make_answer(program);
  ProgressPipe pipe = make_pipe(program);
  const Clock::time_point start = Clock::now();
  const pid_t child =
      SpawnPlan(run.answer.get(), pipe.write_end.get())
          .start(program,
                 {program, request.model.string(), fmt::format("{:.17g}", request.crease_angle_rad),
                  std::to_string(run.memory_limit_bytes),
                  fmt::format("{:.3f}", request.time_limit_s), std::to_string(::getpid())});
  pipe.write_end.reset();
  bool in_time = false;
  try {
    in_time = wait_for_end(child, pipe, request, report);
  } catch (...) {  // the progress callback threw
    end(child, true);
    throw;
  }
  const auto [status, usage] = end(child, !in_time);
  run.seconds = seconds_since(start);
  run.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;
  classify(run, status);
  if (!in_time) run.end = ImportEnd::out_of_time;
  ::lseek(run.answer.get(), 0, SEEK_SET);
  return run;
}

void reject_answer(const std::filesystem::path& model, const std::string& found) {
  throw Error({.where = model.string(),
               .found = "the import process returned a malformed answer (" + found + ")",
               .remedy = "save the model in another format (PLY, OBJ or glTF)"});
}

ImportedModel take_model(const ImportRun& run, const ImportRequest& request) {
  switch (run.end) {
    case ImportEnd::out_of_time:
      fail(request, fmt::format("reading it took longer than {:g} s", request.time_limit_s),
           "save the model in another format, or make it smaller");
    case ImportEnd::out_of_memory:
      fail(request,
           fmt::format("reading it needs more memory than {} MiB", run.memory_limit_bytes >> 20U),
           "the file may be corrupt; otherwise save the model in another format, or make it "
           "smaller");
    case ImportEnd::over_file_size:
      fail(request,
           fmt::format("its triangles and textures exceed the limit of this process on the size of "
                       "files, {} bytes",
                       max_file_bytes()),
           "raise the limit (ulimit -f)");
    case ImportEnd::crashed:
      fail(request,
           run.signal != 0 ? "the import process crashed (" + signal_name(run.signal) + ")"
                           : "the import process ended without an answer",
           "the file is corrupt or uses an unsupported feature; save it in another format "
           "(PLY, OBJ or glTF)");
    case ImportEnd::answered:
      break;
  }
  std::optional<ImportFailure> failure;
  try {
    BlockReader block(run.answer.get());
    if (block.kind() == BlockKind::model) return read_model(block);
    failure = read_failure(block);
  } catch (const Error& error) {
    reject_answer(request.model, error.parts().found);
  }
  fail(request, failure->found, failure->remedy);
}

}  // namespace glidar
