// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/line_file.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/io/model/png_texture.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <support/error_text.hpp>
#include <tests/support/error_text.hpp>
#include <tests/support/test_folder.hpp>

#include <functional>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(InputBudget, GrowsWithTheInputFromAFloor) {
  EXPECT_EQ(InputBudget(0).limit(Budget::decompressed_bytes), 256 * kMiB);
  EXPECT_EQ(InputBudget(kMiB).limit(Budget::decompressed_bytes), 512 * kMiB);
  EXPECT_EQ(InputBudget(0).limit(Budget::held_bytes), 64 * kMiB);
  EXPECT_EQ(InputBudget(1024 * kMiB).limit(Budget::held_bytes), 1024 * kMiB);
  EXPECT_EQ(InputBudget(0).limit(Budget::copies), 8'000'000U);
  InputBudget grown(kMiB);
  grown.add_input(kMiB);
  EXPECT_EQ(grown.limit(Budget::numbers), InputBudget(2 * kMiB).limit(Budget::numbers));
  EXPECT_GT(InputBudget(UINT64_MAX).limit(Budget::messages), UINT64_MAX / 1024);
}

TEST(InputBudget, ReportsWhatExceededItAndWhere) {
  InputBudget budget(1000);
  budget.take(Budget::topics, 5096, "run.mcap, byte 7");
  EXPECT_THAT(error_text([&] { budget.take(Budget::topics, 1, "run.mcap, byte 9"); }),
              AllOf(HasSubstr("run.mcap, byte 9: more than 5096 topics"),
                    HasSubstr("an input of 1000 bytes")));
}

TEST(InputBudget, WhatIsGivenBackCanBeTakenAgain) {
  InputBudget budget(0);
  const std::uint64_t all = budget.limit(Budget::held_bytes);
  for (int i = 0; i < 3; ++i) {
    budget.take(Budget::held_bytes, all, "a");
    budget.give_back(Budget::held_bytes, all);
  }
  EXPECT_FALSE(budget.try_take(Budget::held_bytes, all + 1));
  EXPECT_TRUE(budget.try_take(Budget::held_bytes, all));
  EXPECT_FALSE(budget.try_take(Budget::held_bytes, 1)) << "all is taken";
  EXPECT_THAT(error_text([&] { budget.take(Budget::held_bytes, UINT64_MAX, "a"); }),
              HasSubstr("bytes in memory"));
}

TEST(InputBudget, LimitsNamesOneByOneAndTogether) {
  InputBudget budget(0);
  EXPECT_THAT(error_text([&] { budget.take_name(4097, "a"); }), HasSubstr("at most 4096 bytes"));
  for (int i = 0; i < 256; ++i) budget.take_name(4096, "a");
  EXPECT_THAT(error_text([&] { budget.take_name(1, "a"); }), HasSubstr("bytes of names"));
}

}  // namespace

namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

const InputFileKind kKind = {"a text", 1, "cut it"};

class InputFileTest : public ::testing::Test {
 protected:
  std::string text_of_error(const fs::path& path) const {
    return error_text([&] { read_input_file(path, kKind); });
  }
  testing::TestFolder folder;
};

TEST_F(InputFileTest, AFileIsReadCompletely) {
  const std::string content = std::string("a\0b\xff", 4) + std::string(100'000, 'x');
  EXPECT_EQ(read_input_file(folder.write("a", content), kKind), content);
  EXPECT_EQ(read_input_file(folder.write("empty", ""), kKind), "");
  fs::create_symlink("a", folder / "link");
  EXPECT_EQ(read_input_file(folder / "link", kKind), content);
}

TEST_F(InputFileTest, SystemFilesWithoutASizeAreReadCompletely) {
  EXPECT_THAT(read_input_file("/proc/self/status", kKind), HasSubstr("Pid:"));
}

TEST_F(InputFileTest, OtherThanRegularFilesAreRejectedWithoutBlocking) {
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "device");
  for (const char* name : {"pipe", "device"}) {
    EXPECT_THAT(text_of_error(folder / name), HasSubstr("not a regular file; allowed: a text"))
        << name;
  }
  EXPECT_THAT(text_of_error(folder.path()), HasSubstr("a folder; allowed: a text"));
}

TEST_F(InputFileTest, AMissingFileIsReportedWithTheNearestName) {
  folder.write("camera.yaml", "");
  EXPECT_EQ(text_of_error(folder / "camra.yaml"),
            (folder / "camra.yaml").string() + ": no such file; did you mean 'camera.yaml'?");
  EXPECT_THAT(text_of_error(folder / "camera.yaml" / "x"), HasSubstr("no such file"));
  EXPECT_THAT(text_of_error(std::string("a\0b", 3)), HasSubstr("zero byte"));
}

TEST_F(InputFileTest, AFileOverTheLimitIsRejectedBeforeItIsRead) {
  const fs::path sparse = folder.write("sparse", "");
  fs::resize_file(sparse, std::uintmax_t{1} << 40U);
  EXPECT_THAT(text_of_error(sparse),
              HasSubstr("a file of more than 1 MiB; allowed: a text of at most 1 MiB; cut it"));
  fs::resize_file(sparse, std::uintmax_t{1} << 20U);
  EXPECT_EQ(read_input_file(sparse, kKind).size(), std::size_t{1} << 20U);
}

/// Everything that reads a file by its own.
TEST_F(InputFileTest, PipesAreRejectedWithoutBlocking) {
  for (const char* name : {"p.yaml", "p.csv", "p.npy", "p.json", "p.glidar.json", "p.png"})
    ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
  const auto sensor = [&](const std::string& optics) {
    load_sensor_file(folder.write("s.yaml", "optics: " + optics + "\n"));
  };
  const std::vector<std::function<void()>> readers = {
      [&] { load_sensor_file(folder / "p.yaml"); },
      [&] { sensor("{type: table, file: p.csv}"); },
      [&] { sensor("{type: table, file: p.npy}"); },
      [&] { sensor("{type: ouster, file: p.json}"); },
      [&] { read_sidecar(folder / "p.pcd"); },
      [&] { read_png_texture(folder / "p.png"); },
      [&] { load_trajectory_file(folder / "p.csv"); },
  };
  for (std::size_t i = 0; i < readers.size(); ++i)
    EXPECT_THAT(error_text(readers[i]), HasSubstr("not a regular file")) << i;
  EXPECT_FALSE(hash_file(folder / "p.yaml"));
  EXPECT_FALSE(hash_file("/dev/zero"));
  fs::resize_file(folder.write("vast", ""), std::uintmax_t{1} << 42U);
  EXPECT_FALSE(hash_file(folder / "vast"));
}

TEST_F(InputFileTest, LinesOfAFileAreReadOneByOne) {
  const std::string long_line(200'000, 'x');
  const fs::path path = folder.write("lines", "a\n\n" + long_line + "\nlast");
  LineFile lines(path, kKind, std::size_t{1} << 20U);
  std::string line;
  for (const std::string& expected :
       {std::string("a"), std::string(), long_line, std::string("last")}) {
    ASSERT_TRUE(lines.next(line));
    EXPECT_EQ(line, expected);
  }
  EXPECT_FALSE(lines.next(line));
  EXPECT_FALSE(lines.next(line));
}

TEST_F(InputFileTest, ALineOverItsLimitIsRejected) {
  const fs::path path = folder.write("lines", std::string(900'000, 'x'));
  LineFile lines(path, kKind, 100'000);
  std::string line;
  EXPECT_THAT(error_text([&] { lines.next(line); }), HasSubstr("a line of more than"));
}

TEST_F(InputFileTest, TextThatIsNotUtf8IsReportedWithItsLine) {
  const auto check = [](std::string_view text) {
    return error_text([&] { require_utf8("f", text); });
  };
  EXPECT_EQ(check("plain \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80 \xED\x9F\xBF \xF4\x8F\xBF\xBF"),
            "no error");
  EXPECT_EQ(check("a\nb\xE9\n"),
            "f:2: bytes that are not UTF-8; allowed: text in UTF-8; convert "
            "it, for example with iconv");
  for (const char* wrong :
       {"\xC3", "\xC0\x80", "\x80", "\xED\xA0\x80", "\xE0\x9F\xBF", "\xF4\x90\x80\x80",
        "\xF5\x80\x80\x80", "\xF0\x8F\xBF\xBF", "\xE2\x82", "\xFF"})
    EXPECT_THAT(check(wrong), HasSubstr("not UTF-8")) << wrong;
}

}  // namespace
}  // namespace glidar
