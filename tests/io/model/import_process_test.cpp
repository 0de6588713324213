// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/import_process.hpp>

#include <io/model_test_support.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>
#include <utility>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeLimit_s = 600.0;  // no script takes so long, however busy the machine is
using ::testing::HasSubstr;
using testing::TestFolder;

/// Replaces the import program by a shell script.
class ImportProcess : public ::testing::Test {
 protected:
  ~ImportProcess() override { ::unsetenv("GLIDAR_IMPORT_HELPER"); }

  ImportRequest with_script(const std::string& body) {
    const fs::path script = temp_.write("import", "#!/bin/sh\n" + body + "\n");
    fs::permissions(script, fs::perms::owner_all);
    ::setenv("GLIDAR_IMPORT_HELPER", script.c_str(), 1);
    return {temp_.write("a.obj", "v 0 0 0\n"), 0.785, kTimeLimit_s, 0};
  }

  std::string error(const ImportRequest& request) {
    return error_text([&] { take_model(run_import(request, {}), request); });
  }

  TestFolder temp_;
};

TEST_F(ImportProcess, ACrashIsReportedWithItsSignal) {
  const std::string text = error(with_script("kill -ABRT $$"));
  EXPECT_THAT(text, HasSubstr("a.obj: the import process crashed (signal SIGABRT, Aborted)"));
}

TEST_F(ImportProcess, AHangingProcessIsKilled) {
  ImportRequest request = with_script("exec sleep 3600");
  request.time_limit_s = 0.3;
  const ImportRun run = run_import(request, {});
  EXPECT_EQ(run.end, ImportEnd::out_of_time);
  EXPECT_LT(run.seconds, kTimeLimit_s);
  EXPECT_THAT(error(request), HasSubstr("took longer than 0.3 s"));
}

TEST_F(ImportProcess, AProcessThatClosesItsProgressIsKilledAtTheDeadline) {
  ImportRequest request = with_script("exec 4>&-\nexec sleep 3600");
  request.time_limit_s = 0.3;
  EXPECT_EQ(run_import(request, {}).end, ImportEnd::out_of_time);
}

TEST_F(ImportProcess, AnAnswerAfterTheEndOfTheProgressCounts) {
  const std::string pipe = (temp_.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRWXU), 0);
  const ImportRequest request = with_script("exec 4>&-\nread line < " + pipe + "\nexit 3");
  std::thread writer([&] { std::ofstream(pipe) << "\n"; });
  EXPECT_EQ(run_import(request, {}).end, ImportEnd::out_of_memory);
  writer.join();
}

TEST_F(ImportProcess, MissingAndMalformedAnswersAreErrors) {
  EXPECT_THAT(error(with_script("exit 0")), HasSubstr("malformed answer"));
  EXPECT_THAT(error(with_script("head -c 500 /dev/zero >&3")), HasSubstr("malformed answer"));
  EXPECT_THAT(error(with_script("exit 2")), HasSubstr("without an answer"));
  EXPECT_THAT(error(with_script("exit 3")), HasSubstr("more memory than 1024 MiB"));
}

/// The limit holds for this process too, so a child has it.
TEST_F(ImportProcess, TheLimitOnTheSizeOfFilesIsNamedAndNotTheModel) {
  const ImportRequest request = with_script("exit 4");
  EXPECT_THAT(error(request), HasSubstr("needs more memory than 1024 MiB"));
  const auto under_limit = [&] {
    const rlimit limit{65536, 65536};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::cerr << error(request);
    std::exit(0);
  };
  EXPECT_EXIT(under_limit(), ::testing::ExitedWithCode(0),
              "a.obj: its triangles and textures exceed the limit of this process on the size of "
              "files, 65536 bytes; raise the limit .ulimit -f.");
}

TEST_F(ImportProcess, ItsOutputIsDiscarded) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const std::string text = error(with_script("echo noise; echo noise >&2"));
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(text, HasSubstr("malformed answer"));
}

TEST_F(ImportProcess, NoOtherDescriptorIsInherited) {
  const fs::path list = temp_.path() / "fds";
  const int leaky = ::dup(0);  // without close-on-exec
  error(with_script("ls /proc/$$/fd > " + list.string()));
  ::close(leaky);
  // 0 to 4; a shell keeps its script open on another, which it opened itself (from 10 on)
  std::istringstream fds(testing::read_file(list));
  for (int fd = 0; fds >> fd;) EXPECT_TRUE(fd <= 4 || fd >= 10) << fd;
}

TEST_F(ImportProcess, LongLoadsReportProgress) {
  const std::string pipe = (temp_.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRWXU), 0);
  // '2' is 50; the script ends once somebody writes to the pipe
  const ImportRequest request = with_script("printf '\\062' >&4; read line < " + pipe + "; exit 2");
  std::vector<double> fractions;
  std::string task;
  bool is_ended = false;
  const Report report{{}, [&](std::string_view name, double fraction) {
                        task = name;
                        fractions.push_back(fraction);
                        if (fraction > 0.0 && !std::exchange(is_ended, true)) {
                          std::ofstream(pipe) << "\n";
                        }
                      }};
  run_import(request, report);
  EXPECT_EQ(task, "loading a.obj");
  ASSERT_FALSE(fractions.empty());
  EXPECT_EQ(fractions.back(), 0.5);
}

TEST_F(ImportProcess, FastLoadsShowNoProgress) {
  int calls = 0;
  const Report report{{}, [&](std::string_view, double) { ++calls; }};
  const ImportRun run = run_import(with_script("exit 2"), report);
  constexpr double kFast_s = 0.4;  // of a busy machine no load is fast
  EXPECT_TRUE(calls == 0 || run.seconds > kFast_s);
}

TEST_F(ImportProcess, TheEndIsDetectedWhileAChildKeepsThePipe) {
  const std::string child = (temp_.path() / "child").string();
  const ImportRun run = run_import(with_script("sleep 3600 & echo $! > " + child + "; exit 2"), {});
  ::kill(static_cast<pid_t>(std::stol(testing::read_file(child))), SIGKILL);
  EXPECT_EQ(run.end, ImportEnd::crashed);
  EXPECT_LT(run.seconds, kTimeLimit_s);
}

TEST(ImportLimits, GrowWithTheFile) {
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
  EXPECT_EQ(default_memory_limit(0), 1024 * kMiB);
  EXPECT_EQ(default_memory_limit(16 * kMiB), 1024 * kMiB);
  EXPECT_EQ(default_memory_limit(100 * kMiB), 4000 * kMiB);
}

/// A grid of 2 side^2 triangles whose corners name a v, a vt and a vn.
void write_grid(const fs::path& path, std::uint32_t side) {
  std::ofstream obj(path);
  const auto for_vertices = [side](const auto& write) {
    for (std::uint32_t y = 0; y <= side; ++y) {
      for (std::uint32_t x = 0; x <= side; ++x) write(x * 1.0 / side, y * 1.0 / side);
    }
  };
  for_vertices([&](double x, double y) { obj << "v " << x << ' ' << y << ' ' << x * y << '\n'; });
  for_vertices([&](double x, double y) { obj << "vt " << x << ' ' << y << '\n'; });
  for_vertices([&](double x, double y) { obj << "vn " << x << ' ' << y << ' ' << 1 - x << '\n'; });
  const auto corner = [&obj](std::uint32_t i) { obj << ' ' << i << '/' << i << '/' << i; };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    obj << 'f';
    for (const std::uint32_t i : {a, b, c}) corner(i);
    obj << '\n';
  };
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t i = y * (side + 1) + x + 1;
      triangle(i, i + 1, i + side + 2);
      triangle(i, i + side + 2, i + side + 1);
    }
  }
}

TEST(ImportMemory, OfAnObjWithUvsAndNormalsIsAtMostFourTimesThatOfItsMesh) {
  GLIDAR_SKIP_SANITIZED();
  constexpr std::uint64_t kSide = 700;
  constexpr std::uint64_t kMesh_bytes =
      (kSide + 1) * (kSide + 1) * (12 + 12 + 8) + 2 * kSide * kSide * 12;
  const TestFolder temp;
  write_grid(temp / "a.obj", kSide);
  rusage own{};  // the system counts it for the processes that this one starts
  ::getrusage(RUSAGE_SELF, &own);
  ASSERT_LT(static_cast<std::uint64_t>(own.ru_maxrss) * 1024, 3 * kMesh_bytes) << "run it alone";
  const ImportRequest request{temp / "a.obj", 0.785, kTimeLimit_s, 0};
  const ImportRun run = run_import(request, {});
  EXPECT_LE(run.peak_memory_bytes, 4 * kMesh_bytes);
  const Mesh mesh = take_model(run, request).model.mesh;
  EXPECT_EQ(mesh.positions_m.size(), (kSide + 1) * (kSide + 1));
  EXPECT_EQ(mesh.uvs[0].size(), mesh.positions_m.size());
}

TEST(ImportLimits, ConcurrentImportsDoNotMix) {
  const TestFolder temp;
  std::vector<std::thread> threads;
  std::vector<std::size_t> counts(8);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    threads.emplace_back([&, i] {
      std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
      for (std::size_t f = 0; f <= i; ++f) obj += "f 1 2 3\n";
      counts[i] = testing::load(temp.write(std::to_string(i) + ".obj", obj)).mesh.triangles.size();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < counts.size(); ++i) EXPECT_EQ(counts[i], i + 1);
}

}  // namespace
}  // namespace glidar
