// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/recording.hpp>

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace glidar::link {
namespace {

/// A folder that is removed after the test.
class Folder {
 public:
  Folder() {
    std::string name = std::filesystem::temp_directory_path() / "glidar-recording-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

const std::string kHash = "0123456789abcdef0123456789abcdef";

lockstep::Body some_body(double x) {
  const Pose pose = make_pose({x, 1.0 / 3.0, -1e-300}, Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2));
  return {.world_from_body = pose,
          .rate_rad_s = {0.1, 0.2, 1.0 / 7.0},
          .velocity_m_s = {1e9, -0.0, 3.0}};
}

TEST(Recording, ReadsBackEveryBitThatWasWritten) {
  const Folder folder;
  RecordedFrame frame{.sensor = 3, .is_placed = true, .frame_hash = kHash};
  frame.moment = {.t_ns = -5, .seed = 0xFFFFFFFFFFFFFFFFU, .number = 7, .sensor = some_body(0.1)};
  frame.moment.objects = {some_body(2.7e7), {}};
  RecordingWriter writer(folder / "r.jsonl");
  writer.begin({.version = "1.2.3",
                .command = {.arguments = {"stream", "a b"}, .folder = folder / "."},
                .files = {{"a b", "12"}}});
  writer.write(frame);
  writer.commit();

  RecordingReader reader(folder / "r.jsonl");
  EXPECT_EQ(reader.head().version, "1.2.3");
  EXPECT_EQ(reader.head().command.arguments, (std::vector<std::string>{"stream", "a b"}));
  EXPECT_TRUE(std::filesystem::equivalent(reader.head().command.folder, folder / "."));
  ASSERT_EQ(reader.head().files.size(), 1U);
  EXPECT_EQ(reader.head().files[0].path, "a b");
  const std::optional<RecordedFrame> read = reader.next();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->sensor, 3U);
  EXPECT_EQ(read->frame_hash, kHash);
  EXPECT_EQ(read->moment.t_ns, -5);
  EXPECT_EQ(read->moment.seed, 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(read->moment.number, 7U);
  ASSERT_TRUE(read->is_placed);
  ASSERT_EQ(read->moment.objects.size(), 2U);
  EXPECT_EQ(read->moment.sensor.world_from_body.matrix(), some_body(0.1).world_from_body.matrix());
  EXPECT_EQ(read->moment.sensor.rate_rad_s, some_body(0.1).rate_rad_s);
  EXPECT_EQ(read->moment.objects[0].velocity_m_s, some_body(2.7e7).velocity_m_s);
  EXPECT_EQ(read->moment.objects[1].world_from_body.matrix(), Pose::Identity().matrix());
  EXPECT_FALSE(reader.next());
}

TEST(Recording, HasNoBodiesForPosesFromTheCommand) {
  const Folder folder;
  RecordingWriter writer(folder / "r.jsonl");
  writer.begin({.version = "1", .command = {.arguments = {"stream"}, .folder = folder / "."}});
  writer.write({.sensor = 0, .is_placed = false, .frame_hash = kHash});
  writer.commit();
  RecordingReader reader(folder / "r.jsonl");
  EXPECT_FALSE(reader.next().value().is_placed);
}

TEST(Recording, AppearsWhenItIsComplete) {
  const Folder folder;
  {
    RecordingWriter writer(folder / "r.jsonl");
    writer.begin({.version = "1", .command = {.arguments = {"stream"}, .folder = folder / "."}});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "r.jsonl"));
  EXPECT_THROW(RecordingReader(folder / "r.jsonl"), Error);
  EXPECT_THROW(RecordingReader(folder / "."), Error);
}

TEST(Recording, ReportsTheInvalidKey) {
  const Folder folder;
  std::ofstream(folder / "r.jsonl")
      << R"({"recording": 1, "glidar": "1", "command": {"arguments": ["stream"], "folder": 5}})";
  EXPECT_THAT(error_text([&] { const RecordingReader reader(folder / "r.jsonl"); }),
              ::testing::HasSubstr("a value of another type in 'command.folder'"));
}

TEST(Recording, RejectsNamesThatAreNotUtf8) {
  const Folder folder;
  RecordingWriter writer(folder / "r.jsonl");
  EXPECT_THROW(
      writer.begin(
          {.version = "1", .command = {.arguments = {"stream", "b\xff"}, .folder = folder / "."}}),
      Error);
}

}  // namespace
}  // namespace glidar::link
