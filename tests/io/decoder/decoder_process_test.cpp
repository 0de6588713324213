// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/decoder_process.hpp>

#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/packets/packet_frames.hpp>

#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>

#include <sys/wait.h>

#include <cstdlib>

namespace glidar {
namespace {

using ::testing::HasSubstr;
using testing::TestFolder;

/// Replaces the program by a shell script.
class DecoderProcess : public ::testing::Test {
 protected:
  ~DecoderProcess() override { ::unsetenv("GLIDAR_IMPORT_HELPER"); }

  /// The error of reading a bag with this script, which may take `time_limit_s`.
  std::string error(const std::string& body, double time_limit_s = 600.0) {
    return error_text([&] {
      const auto bag = bags::receive_bag(start(body, time_limit_s));
      for (bags::BagMessage message; bag->next(message);) {
      }
    });
  }

  DecoderRun start(const std::string& body, double time_limit_s = 600.0,
                   DecoderKind kind = kBagDecoder) {
    const std::filesystem::path script = folder_.write("import", "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    ::setenv("GLIDAR_IMPORT_HELPER", script.c_str(), 1);
    kind.time_limit_s = time_limit_s;
    return start_decoder(kind, folder_.write("run.mcap", "bag"));
  }

  /// Whether this process has a child, which runs or was not waited for.
  [[nodiscard]] static bool is_running() {
    siginfo_t info{};
    return ::waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0;
  }

  TestFolder folder_;
};

constexpr double kShort_s = 0.3;
constexpr const char* kTopics =
    R"(printf '\002\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0' >&3)";
constexpr const char* kEnd = R"(printf '\004\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0' >&3)";

TEST_F(DecoderProcess, ABagWithoutTopicsIsRead) {
  EXPECT_EQ(error(std::string(kTopics) + "\n" + kEnd), "no error");
}

TEST_F(DecoderProcess, SilenceEndsAfterTheTimeLimit) {
  EXPECT_THAT(error("exec sleep 3600", kShort_s), HasSubstr("run.mcap: reading it took longer"));
  EXPECT_FALSE(is_running());
}

TEST_F(DecoderProcess, SilenceAfterTheTopicsEndsToo) {
  EXPECT_THAT(error(std::string(kTopics) + "\nexec sleep 3600", kShort_s),
              HasSubstr("took longer than 0.3 s"));
}

TEST_F(DecoderProcess, AStoppedProcessEnds) {
  EXPECT_THAT(error("kill -STOP $$", kShort_s), HasSubstr("took longer"));
  EXPECT_FALSE(is_running());
}

TEST_F(DecoderProcess, ClosedDescriptorsDoNotKeepItAlive) {
  EXPECT_THAT(error("exec sleep 3600 3>&- 4>&-", kShort_s), HasSubstr("run.mcap: "));
  EXPECT_FALSE(is_running());
}

TEST_F(DecoderProcess, AFloodEndsAtTheFirstMalformedRecord) {
  EXPECT_THAT(error("exec cat /dev/zero >&3"), HasSubstr("a record of kind 0"));
  EXPECT_FALSE(is_running());
}

TEST_F(DecoderProcess, AFloodOfTopicsEndsAtTheBudget) {
  const std::string topic =
      R"(\001\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\012\0\0\0\0\0\0\0\001\0\0\0\0\0\0\0\0\0)";
  EXPECT_THAT(error("while printf '" + topic + "' >&3; do :; done"), HasSubstr("topics"));
}

TEST_F(DecoderProcess, AFloodOfDatagramsEndsAtTheBudget) {
  std::string datagrams;
  constexpr int kBytes = 4000;
  for (int i = 0; i < 500; ++i) {
    std::string head(24, '\0');
    head[0] = static_cast<char>(RecordKind::item);
    head[16] = static_cast<char>(kBytes % 256);
    head[17] = static_cast<char>(kBytes / 256);
    datagrams += head + std::string(kBytes, 'x');
  }
  const std::string block = folder_.write("block", datagrams).string();
  CapturedPackets packets(
      start("while cat '" + block + "' >&3; do :; done", 600.0, kCaptureDecoder));
  EXPECT_THAT(error_text([&] {
                for (UdpPacket packet; packets.next(packet);) {
                }
              }),
              HasSubstr("more datagrams than the capture has bytes"));
}

TEST_F(DecoderProcess, CrashesAndLimitsAreReported) {
  EXPECT_THAT(error("kill -SEGV $$"), HasSubstr("crashed (signal SIGSEGV"));
  EXPECT_THAT(error("exit 2"), HasSubstr("ended without an answer"));
  EXPECT_THAT(error("exit 3"), HasSubstr("needs more memory than"));
  EXPECT_THAT(error("kill -XCPU $$"), HasSubstr("took longer"));
  EXPECT_THAT(error(kTopics), HasSubstr("ended without an answer"));
}

TEST_F(DecoderProcess, UsesFunctionsOfTheCLibraryThatAreTheSameOnEveryProcessor) {
  EXPECT_THAT(error(R"([ "$GLIBC_TUNABLES" = glibc.cpu.hwcaps=-FMA,-FMA4 ] && exit 2; exit 3)"),
              HasSubstr("ended without an answer"));
}

TEST_F(DecoderProcess, EndsWithItsReader) {
  {
    const auto bag = bags::receive_bag(start(std::string(kTopics) + "\nexec sleep 3600"));
    EXPECT_TRUE(is_running());
  }
  EXPECT_FALSE(is_running());
}

TEST_F(DecoderProcess, ASelectionForAnEndedProcessIsNoSignal) {
  const std::string topic =
      R"(printf '\001\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\012\0\0\0\0\0\0\0\001\0\0\0\0\0\0\0\0\0' >&3)";
  const auto bag = bags::receive_bag(start(topic + "\n" + kTopics + "\nexit 2"));
  ASSERT_EQ(bag->topics().size(), 1U);
  bags::BagMessage message;
  EXPECT_THAT(error_text([&] { bag->next(message); }), HasSubstr("ended without an answer"));
}

}  // namespace
}  // namespace glidar
