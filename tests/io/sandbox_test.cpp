// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// What a hostile model gains that takes control of the import process: tests/import/sandbox_probe.
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/model/import_process.hpp>

#include <io/model_cache_fixture.hpp>

#include <gmock/gmock.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <map>
#include <sstream>
#include <string>

namespace glidar {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::TestFolder;
using testing::Variable;

constexpr double kTimeLimit_s = 600.0;  // however busy the machine is
constexpr const char* kSuccess = "0";
constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A TCP port of this machine that accepts connections.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(socket_.get(), 8), 0);
    socklen_t size = sizeof address;
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] bool is_connected() const {
    const UniqueFd peer(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    return static_cast<bool>(peer);
  }

 private:
  UniqueFd socket_;
  std::uint16_t port_ = 0;
};

class Sandbox : public ::testing::Test {
 protected:
  Sandbox() {
    outside_ = elsewhere_.write("secret", "a secret");
    model_ = folder_.write("a.obj", outside_.string() + "\n" + std::to_string(listener_.port()));
    fs::create_symlink(outside_, folder_ / "link");
  }

  void limit_landlock(int version) {
    model_ = folder_.write("a.obj", testing::read_file(model_) + "\n" + std::to_string(version));
  }

  /// What came of each attempt: "0" or the name of an error.
  std::map<std::string, std::string> attempt() {
    const Variable program("GLIDAR_IMPORT_HELPER", GLIDAR_SANDBOX_PROBE);
    const Variable secret("GLIDAR_TEST_SECRET", "a secret");
    const int leaky = ::dup(0);  // without close-on-exec
    const ImportRequest request{model_, 0.785, kTimeLimit_s, 0};
    std::string text;
    try {
      take_model(run_import(request, {}), request);
    } catch (const Error& error) {
      text = error.parts().found;
    }
    ::close(leaky);
    std::map<std::string, std::string> results;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line, '|');) {
      const std::size_t colon = line.find(": ");
      results[line.substr(0, colon)] = colon == std::string::npos ? "" : line.substr(colon + 2);
    }
    return results;
  }

  TestFolder folder_;
  TestFolder elsewhere_;
  Listener listener_;
  fs::path model_;
  fs::path outside_;
};

TEST_F(Sandbox, ACompromisedImportProcessHasNoAccess) {
  GLIDAR_SKIP_SANITIZED();
  std::map<std::string, std::string> results = attempt();
  if (results.contains("note"))
    GTEST_SKIP() << "no sandbox; use Linux 5.13 or later with Landlock: " << results["note"];
  constexpr std::size_t kAttempts = 65;  // so that none is lost
  EXPECT_EQ(results.size(), kAttempts);
  EXPECT_EQ(results["read the model again"], kSuccess);  // what it is for
  results.erase("read the model again");
  for (const auto& [name, result] : results) EXPECT_NE(result, kSuccess) << name;
  EXPECT_EQ(results["read a file outside"], "EACCES");
  EXPECT_EQ(results["create a file by openat2"], "EACCES");
  EXPECT_EQ(results["fork"], "EPERM");
  EXPECT_EQ(results["execute a program"], "EPERM");
  EXPECT_EQ(results["make a TCP socket"], "EPERM");
  EXPECT_EQ(results["trace the parent"], "EPERM");
}

/// Versions 1 and 2 do not restrict the truncation of files, from 3 on all changes.
TEST_F(Sandbox, AnOldLandlockGivesNoAccessEither) {
  GLIDAR_SKIP_SANITIZED();
  const std::string model = testing::read_file(model_);
  for (const int version : {1, 2, 3, 5}) {
    model_ = folder_.write("a.obj", model);
    limit_landlock(version);
    const std::string before = testing::read_file(model_);
    std::map<std::string, std::string> results = attempt();
    if (results.contains("note")) GTEST_SKIP() << "no sandbox; use Linux 5.13 or later";
    EXPECT_EQ(results["read the model again"], kSuccess);
    results.erase("read the model again");
    for (const auto& [name, result] : results) EXPECT_NE(result, kSuccess) << version << name;
    EXPECT_EQ(results["truncate the model by openat2"], version < 3 ? "EPERM" : "EACCES");
    EXPECT_EQ(testing::read_file(model_), before) << version;
  }
}

TEST_F(Sandbox, NothingOutsideTheImportProcessChanges) {
  GLIDAR_SKIP_SANITIZED();
  const std::string before = testing::read_file(model_);
  if (attempt().contains("note"))
    GTEST_SKIP() << "no sandbox; use Linux 5.13 or later with Landlock";
  EXPECT_EQ(testing::read_file(model_), before);
  EXPECT_EQ(testing::read_file(outside_), "a secret");
  EXPECT_THAT(folder_.names(), ::testing::ElementsAre("a.obj", "link"));
  EXPECT_THAT(elsewhere_.names(), ::testing::ElementsAre("secret"));
  ASSERT_EQ(::fcntl(STDIN_FILENO, F_GETFD), 0);
}

TEST_F(Sandbox, AMissingMechanismIsReported) {
  GLIDAR_SKIP_SANITIZED();
  const fs::path model = folder_.write("b.obj", kTriangle);
  const Variable program("GLIDAR_IMPORT_HELPER", GLIDAR_WITHOUT_SANDBOX);
  const Model loaded = testing::load(model);
  EXPECT_EQ(loaded.mesh.triangles.size(), 1U);
  EXPECT_THAT(loaded.notes, Contains(AllOf(HasSubstr("ran without Landlock"),
                                           HasSubstr("this kernel does not have it"))));
  EXPECT_THAT(loaded.notes,
              Contains(AllOf(HasSubstr("ran without its filter of system calls, seccomp"),
                             HasSubstr("Invalid argument"))));
  EXPECT_THAT(testing::report_of(model, testing::without_cache()), HasSubstr("Landlock"));
}

TEST_F(Sandbox, TheNoteOfAMissingMechanismIsNotCached) {
  GLIDAR_SKIP_SANITIZED();
  ModelOptions options;
  options.cache_folder = elsewhere_ / "cache";
  const fs::path model = folder_.write("b.obj", kTriangle);
  {
    const Variable program("GLIDAR_IMPORT_HELPER", GLIDAR_WITHOUT_SANDBOX);
    EXPECT_THAT(testing::load(model, options).notes, Contains(HasSubstr("Landlock")));
    const Model again = testing::load(model, options);
    EXPECT_TRUE(again.from_cache);
    EXPECT_THAT(again.notes, Not(Contains(HasSubstr("Landlock"))));
  }
}

}  // namespace
}  // namespace glidar
