// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The same bytes from every build type, any number of threads and any C library.
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/simulator.hpp>
#include <support/data.hpp>
#include <support/preset.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace glidar {
namespace {

/// FNV-1a over the bytes of a column.
template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) {
    hash = (hash ^ bytes[i]) * 0x100000001b3U;
  }
  return hash;
}

TEST(Golden, TheAsteroidsFrameHasTheRecordedBytes) {
  const Scene scene = testing::scene_of(make_builtin_model("asteroid"));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(96, 64, 0.5);
  const Beams beams = make_beams(sensor);
  const Motion motion =
      static_motion(scene, look_at({4.0, -3.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  const auto renderer = make_renderer(scene, {});
  Frame frame;
  testing::simulate({scene, sensor, beams, motion, *renderer},
                    {.normal = true, .shading_normal = true, .object_point = true}, frame);
  EXPECT_EQ(hash_of(frame.range_m), 9726207806536911748U);
  EXPECT_EQ(hash_of(frame.intensity), 8418342543815064715U);
  EXPECT_EQ(hash_of(frame.ground_truth.primitive), 9915169409929839669U);
  EXPECT_EQ(hash_of(frame.ground_truth.normal), 14283022333936143779U);
  EXPECT_EQ(hash_of(frame.ground_truth.shading_normal), 884859711244796085U);
  EXPECT_EQ(hash_of(frame.ground_truth.object_point_m), 13269653441643021824U);
}

TEST(Golden, BeamsOfPresetsHaveTheRecordedBytes) {
  const auto hash = [](const char* name) {
    return hash_of(make_beams(testing::preset(name)).directions);
  };
  EXPECT_EQ(hash("VLP-16"), 10372437558375830034U);
  EXPECT_EQ(hash("OS1-128"), 17104498845996309118U);
  EXPECT_EQ(hash("RPLIDAR-A2M8"), 8606994576022671178U);
  EXPECT_EQ(hash("ALTM-3100"), 1206907401030045931U);
  EXPECT_EQ(hash("Livox-Avia"), 9247065409348504407U);
  EXPECT_EQ(hash("Livox-Mid-360"), 16599951781615489346U);
  EXPECT_EQ(hash("Azure-Kinect-WFOV"), 17200857416396549151U);
  EXPECT_EQ(hash("D435"), 5669341467647616280U);
}

/// A frame of pulses with footprints, returns and noise, of two instances of a body: the second is
/// larger, turned, and hides a part of the first.
Frame pulsed_frame(float mirror) {
  Scene scene = testing::scene_of(make_builtin_model("asteroid"));
  Instance large = scene.instances[0];
  large.scale = 2.75;
  large.world_from_object = look_at({-1.0, 3.5, 0.75}, {0.3, 0.2, 0.1}, Eigen::Vector3d::UnitZ());
  large.materials = {static_cast<std::uint32_t>(scene.materials.size())};
  scene.materials.push_back(scene.materials[0]);
  scene.materials.back().mirror = mirror;
  scene.instances.push_back(large);
  Sensor sensor = testing::preset("VLP-16");
  sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  const auto renderer = make_renderer(scene, {.threads = 2});
  Simulator simulator(scene, sensor, *renderer);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(3.0, -2.0, 0.25);
  Frame frame;
  frame.seed = 3;
  simulator.simulate(static_motion(scene, pose), {.normal = true}, frame);
  return frame;
}

TEST(Golden, FramesOfFootprintsHaveTheRecordedBytes) {
  const Frame plain = pulsed_frame(0.0F);
  EXPECT_EQ(hash_of(plain.range_m), 5765623209004123444U);
  EXPECT_EQ(hash_of(plain.intensity), 17085379318233326308U);
  EXPECT_EQ(hash_of(plain.status), 5944900632760247420U);
  EXPECT_EQ(hash_of(plain.return_source), 7364110070399786890U);
  EXPECT_EQ(hash_of(plain.ground_truth.range_m), 12053345696802950158U);
  EXPECT_EQ(hash_of(plain.ground_truth.primitive), 5773909311519655076U);
  EXPECT_EQ(hash_of(plain.ground_truth.normal), 13122420343999016593U);
  const Frame mirrored = pulsed_frame(0.6F);
  EXPECT_EQ(hash_of(mirrored.range_m), 14401977297723139572U);
  EXPECT_EQ(hash_of(mirrored.intensity), 2442026864755054115U);
  EXPECT_EQ(hash_of(mirrored.return_source), 17745416241687838664U);
  const auto count = [](const Frame& frame, ReturnSource source) {
    return std::count(frame.return_source.begin(), frame.return_source.end(), source);
  };
  EXPECT_GT(count(plain, ReturnSource::surface), 3000);
  EXPECT_GT(count(plain, ReturnSource::mixed_pixel), 50);
  EXPECT_GT(count(mirrored, ReturnSource::ghost), 50);
}

}  // namespace
}  // namespace glidar
