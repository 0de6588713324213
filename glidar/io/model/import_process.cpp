// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/import_process.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/report.hpp>
#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/decoder/import_program.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <utility>

namespace glidar {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
constexpr double kQuietSeconds = 0.5;    // shorter loads report no progress
constexpr int kSliceMilliseconds = 100;  // between checks of the time limit
constexpr int kEndMilliseconds = 1;      // the same once the process has closed the pipe

struct ProgressPipe {
  UniqueFd read_end;
  UniqueFd write_end;
};

ProgressPipe make_pipe(const std::string& program) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(program, errno);
  return {moved_up(program, ends[0]), moved_up(program, ends[1])};
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
    const int max_ms = watched.fd < 0 ? kEndMilliseconds : kSliceMilliseconds;
    const int ready = ::poll(&watched, 1, std::min(max_ms, static_cast<int>(left_s * 1000.0) + 1));
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

[[noreturn]] void fail(const ImportRequest& request, std::string found, std::string remedy) {
  throw Error(
      {.where = request.model.string(), .found = std::move(found), .remedy = std::move(remedy)});
}

rlim_t max_file_bytes() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 ? limit.rlim_max : RLIM_INFINITY;
}

}  // namespace

std::uint64_t default_memory_limit(std::uint64_t file_bytes) {
  constexpr std::uint64_t kUnfolding = 40;
  return std::max(kGiB, file_bytes > kGiB * kGiB / kUnfolding ? kGiB : file_bytes * kUnfolding);
}

ImportRun run_import(const ImportRequest& request, const Report& report) {
  const std::string program = import_program().string();
  ImportRun run;
  run.memory_limit_bytes = request.memory_limit_bytes != 0
                               ? request.memory_limit_bytes
                               : default_memory_limit(fs::file_size(request.model));
  run.answer = moved_up(program, ::memfd_create("glidar-import", MFD_CLOEXEC));
  ProgressPipe pipe = make_pipe(program);
  const Clock::time_point start = Clock::now();
  std::vector<std::string> arguments = {program,
                                        request.model.string(),
                                        fmt::format("{:.17g}", request.crease_angle_rad),
                                        std::to_string(run.memory_limit_bytes),
                                        fmt::format("{:.3f}", request.time_limit_s),
                                        std::to_string(::getpid())};
  for (const fs::path& folder : request.texture_folders) arguments.push_back(folder.string());
  const pid_t child = start_helper(std::move(arguments),
                                   {.answer = run.answer.get(), .control = pipe.write_end.get()});
  pipe.write_end.reset();
  bool in_time = false;
  try {
    in_time = wait_for_end(child, pipe, request, report);
  } catch (...) {  // the progress callback threw
    end_helper(child, true);
    throw;
  }
  const HelperEnd ending = end_helper(child, !in_time);
  run.seconds = seconds_since(start);
  run.peak_memory_bytes = static_cast<std::uint64_t>(ending.usage.ru_maxrss) * 1024U;
  run.end = ending.end;
  run.signal = ending.signal;
  // the process limits itself to its memory, unless this process has a lower limit
  if (run.end == ImportEnd::over_file_size && max_file_bytes() >= run.memory_limit_bytes)
    run.end = ImportEnd::out_of_memory;
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
      if (run.signal == SIGPROF) {
        fail(request, "reading it takes longer than the limit for a file of its size",
             "the file may be corrupt; otherwise save the model as PLY, OBJ or glTF");
      }
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
