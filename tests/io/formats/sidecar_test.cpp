// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/sidecar.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>
#include <glidar/io/formats/sidecar_file.hpp>
#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace glidar {
namespace {

using testing::TestFolder;

TEST(ReadSidecar, ReturnsTheOriginOfTheCloud) {
  const TestFolder folder;
  CloudFixture made = make_fixture();
  made.frame.number = 7;
  SidecarContext context = made.context();
  context.command = {.arguments = {"render", "a b.obj", "-o", "x.pcd"},
                     .folder = folder.path() / "elsewhere"};
  make_file_sink(folder.path() / "x.pcd", {}, context)->write(made.cloud, made.frame);
  const Sidecar sidecar = read_sidecar(folder.path() / "x.pcd");
  EXPECT_EQ(sidecar.path, folder.path() / "x.glidar.json");
  EXPECT_EQ(sidecar.version, version());
  EXPECT_EQ(sidecar.command.arguments, context.command.arguments);
  EXPECT_EQ(sidecar.command.folder.lexically_normal(), folder.path() / "elsewhere");
  ASSERT_EQ(sidecar.frames.size(), 1U);
  EXPECT_EQ(sidecar.frames[0].number, 7U);
  EXPECT_EQ(sidecar.frames[0].hash, frame_hash(made.frame));
  EXPECT_EQ(sidecar.frames[0].points, made.cloud.size());
  EXPECT_EQ(sidecar.model_hashes.size(), made.scene.instances.size());
}

TEST(ReadSidecar, HasNoCommandForCloudsWithoutOne) {
  const TestFolder folder;
  const CloudFixture made = make_fixture();
  const SidecarContext context = made.context();
  make_file_sink(folder.path() / "x.pcd", {}, context)->write(made.cloud, made.frame);
  EXPECT_TRUE(read_sidecar(folder.path() / "x.pcd").command.arguments.empty());
}

TEST(ReadSidecar, FindsEveryFileOfAFrameWhoseFilesWereWrittenOneByOne) {
  const TestFolder folder;
  CloudFixture made = make_fixture();
  const SidecarContext context = made.context();
  for (const char* name : {"x.pcd", "x.ply", "x.pcd"})
    make_file_sink(folder.path() / name, {}, context)->write(made.cloud, made.frame);
  EXPECT_EQ(read_sidecar(folder.path() / "x.ply").frames[0].points, made.cloud.size());
  EXPECT_EQ(read_sidecar(folder.path() / "x.pcd").frames[0].points, made.cloud.size());
  std::filesystem::remove(folder.path() / "x.ply");
  make_file_sink(folder.path() / "x.pcd", {}, context)->write(made.cloud, made.frame);
  EXPECT_NE(error_text([&] { read_sidecar(folder.path() / "x.ply"); }).find("does not list x.ply"),
            std::string::npos);
  make_file_sink(folder.path() / "x.ply", {}, context)->write(made.cloud, made.frame);
  EXPECT_EQ(read_sidecar(folder.path() / "x.pcd").frames[0].points, made.cloud.size());
  made.frame.range_m[0] += 1.0;  // another measurement replaces them
  make_file_sink(folder.path() / "x.pcd", {}, context)->write(made.cloud, made.frame);
  EXPECT_NE(error_text([&] { read_sidecar(folder.path() / "x.ply"); }).find("does not list x.ply"),
            std::string::npos);
}

TEST(FrameHash, DependsOnTheMeasurementOnly) {
  Frame frame;
  frame.status = {Status::hit, Status::miss};
  frame.range_m = {2.0, std::nan("")};
  frame.intensity = {0.5F, 0.0F};
  const std::string before = frame_hash(frame);
  EXPECT_EQ(before.size(), 32U);
  frame.ground_truth.range_m.push_back(1.0);
  EXPECT_EQ(frame_hash(frame), before);
  frame.range_m[0] = std::nextafter(frame.range_m[0], 1e9);
  const std::string other_range = frame_hash(frame);
  EXPECT_NE(other_range, before);
  frame.intensity[0] += 1.0F;
  EXPECT_NE(frame_hash(frame), other_range);
  const std::string without_velocity = frame_hash(frame);
  frame.radial_velocity_m_s = {3.0, std::nan("")};
  const std::string with_velocity = frame_hash(frame);
  EXPECT_NE(with_velocity, without_velocity);
  frame.radial_velocity_m_s[0] = -3.0;
  EXPECT_NE(frame_hash(frame), with_velocity);
}

std::string sidecar_error(const TestFolder& folder, const std::string& sidecar) {
  (void)folder.write("x.glidar.json", sidecar);
  return error_text([&] { read_sidecar(folder.path() / "x.pcd"); });
}

TEST(ReadSidecar, RejectsOtherFiles) {
  const TestFolder folder;
  const std::string error = error_text([&] { read_sidecar(folder.path() / "x.pcd"); });
  EXPECT_TRUE(error.ends_with("; write the cloud again, with -o and without --no-sidecar"))
      << error;
  for (const char* text : {"", "{", "{\"glidar\": nul}"}) {
    const std::string damaged = sidecar_error(folder, text);
    EXPECT_NE(damaged.find("x.glidar.json: a damaged file: its text "), std::string::npos)
        << damaged;
    EXPECT_NE(damaged.find("; copy the file again, or write the cloud again"), std::string::npos);
    EXPECT_EQ(damaged.find("exception"), std::string::npos) << damaged;
  }
  for (const char* text : {"[]", "{}", "{\"glidar\": 3}", "null"}) {
    EXPECT_NE(sidecar_error(folder, text).find("not a sidecar of this version"), std::string::npos)
        << text;
  }
}

TEST(ReadSidecar, DoesNotListFilesOfOtherMeasurementsWithTheSameNumbers) {
  const TestFolder folder;
  const auto is_listed_after = [&](const auto& change) {
    CloudFixture made = make_fixture();
    write_cloud(made, folder.path() / "x.ply");
    change(made.frame);
    write_cloud(made, folder.path() / "x.pcd");
    const std::string text = file_bytes(folder.path() / "x.glidar.json");
    return text.find("x.ply") != std::string::npos;
  };
  EXPECT_TRUE(is_listed_after([](Frame&) {}));
  EXPECT_FALSE(is_listed_after([](Frame& frame) { frame.stamp_ns += 1; }));
  EXPECT_FALSE(
      is_listed_after([](Frame& frame) { frame.world_from_sensor.translation().x() += 1; }));
  EXPECT_FALSE(
      is_listed_after([](Frame& frame) { frame.world_from_instance[1].translation().y() += 1; }));
}

TEST(RunSidecar, ListsOnlyBoxesWithPoints) {
  CloudFixture made = make_fixture();
  made.frame.boxes = {{.instance = 0, .points = 3}, {.instance = 1, .points = 0}};
  const RunSidecar run = run_sidecar(made.context(), made.frame, "run.glidar.json");
  const std::vector<FramePoints> points = {{"run.csv", 20}};
  const std::string entry = frame_entry(made.context(), made.frame, run, points, Pose::Identity());
  EXPECT_NE(entry.find("\"name\":\"rock\""), std::string::npos) << entry;
  EXPECT_EQ(entry.find("other rock"), std::string::npos) << entry;
}

TEST(RunSidecar, ListsAsManyFramesAsAReaderTakesAndCountsTheOthers) {
  const CloudFixture made = make_fixture();
  RunSidecar run = run_sidecar(made.context(), made.frame, "run.glidar.json");
  std::string huge = "[0";
  for (std::size_t i = 0; i < std::size_t{1} << 22U; ++i) huge += ",0";
  huge += ']';
  for (int i = 0; i < 5; ++i) run.add_frame(huge);
  run.add_frame("[]");
  EXPECT_EQ(run.frames.size(), 3U);  // 2^24 values
  EXPECT_EQ(run.unlisted_frames, 3U);
  run.frames = {"{}", "{}"};
  const std::string text = sidecar_text(run, {});
  EXPECT_TRUE(
      text.ends_with("  \"unlisted_frames\": 3,\n  \"frames\": [\n    {},\n    {}\n  ]\n}\n"))
      << text;
}

}  // namespace
}  // namespace glidar
