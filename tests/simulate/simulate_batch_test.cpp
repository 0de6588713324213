// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/simulator.hpp>
#include <support/data.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <vector>

namespace glidar {
namespace {

class SimulateBatch : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "gpu") make_renderer(Scene(), {.kind = "gpu"});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    renderer_ = make_renderer(scene_, {.kind = GetParam(), .threads = 2});
    sensor_.optics = pinhole_from_fov(48, 40, 0.5);
    sensor_.noise = {RangeGaussian{.sigma_m = 0.01}, Dropout{.probability = 0.1}};
    for (int i = 0; i < kFrames; ++i) {
      const Eigen::Vector3d eye(5.0 + i, 0.3 * i, 1.0 - 0.2 * i);
      motions_.push_back(
          static_motion(scene_, look_at(eye, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ())));
    }
  }

  static Frame seeded(int i) {
    Frame frame;
    frame.seed = 100U + static_cast<std::uint64_t>(i);
    frame.number = static_cast<std::uint32_t>(3 * i);
    return frame;
  }

  /// Simulates all together, then each alone, and compares what is measured.
  void expect_as_one_by_one(const Sensor& sensor) const {
    Simulator simulator(scene_, sensor, *renderer_);
    const HitColumnMask hit_columns{.depth = true, .normal = true};
    std::vector<Frame> frames;
    for (int i = 0; i < kFrames; ++i) frames.push_back(seeded(i));
    simulator.simulate_batch(motions_, hit_columns, frames);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Frame alone = seeded(static_cast<int>(i));
      simulator.simulate(motions_[i], hit_columns, alone);
      const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() &&
               std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
      };
      EXPECT_TRUE(same(frames[i].range_m, alone.range_m)) << i;
      EXPECT_TRUE(same(frames[i].intensity, alone.intensity)) << i;
      EXPECT_EQ(frames[i].status, alone.status) << i;
      EXPECT_TRUE(same(frames[i].sigma_m, alone.sigma_m)) << i;
      EXPECT_TRUE(same(frames[i].ground_truth.normal, alone.ground_truth.normal)) << i;
      EXPECT_TRUE(same(frames[i].ground_truth.depth_m, alone.ground_truth.depth_m)) << i;
      for (const Status status : alone.status) hits += status == Status::hit ? 1 : 0;
    }
    EXPECT_GT(hits, 50U * frames.size());
  }

  static constexpr int kFrames = 9;
  Scene scene_ = testing::scene_of(make_builtin_model("torus"));
  Sensor sensor_;
  std::vector<Motion> motions_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_P(SimulateBatch, FramesAreIdenticalToSimulate) {
  expect_as_one_by_one(sensor_);
}

TEST_P(SimulateBatch, PointingErrorsOfAFrameDoNotAffectAnother) {
  if (GetParam() == "raster") GTEST_SKIP() << "casts pinhole beams only; nothing to do";
  sensor_.noise.push_back(PointingJitter{.sigma_azimuth_rad = 1e-3, .sigma_elevation_rad = 1e-3});
  expect_as_one_by_one(sensor_);
}

TEST_P(SimulateBatch, SensorsMayCullBackFacesAndHaveProjectors) {
  Sensor culling = sensor_;
  culling.cull_back_faces = true;
  culling.limits.far_m = 7.0;
  expect_as_one_by_one(culling);
  if (GetParam() == "raster" || GetParam() == "auto")
    return;  // beams from a projector have origins of their own
  Sensor shadowed = sensor_;
  shadowed.projector_origin_m = Eigen::Vector3d(0.3, 0.0, 0.0);
  expect_as_one_by_one(shadowed);
}

TEST_P(SimulateBatch, RejectsWrongNumbersOfFrames) {
  Simulator simulator(scene_, sensor_, *renderer_);
  std::vector<Frame> frames(1);
  EXPECT_EQ(error_text([&] { simulator.simulate_batch(std::span(motions_).first(2), {}, frames); }),
            "batch: 2 motions for 1 frames; allowed: one motion per frame");
}

INSTANTIATE_TEST_SUITE_P(All, SimulateBatch, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

TEST(SimulateBatchOfEchoes, FramesWithSeveralCastsAreIdenticalToSimulate) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  Sensor sensor;
  sensor.optics = pinhole_from_fov(32, 24, 0.6);
  Beams beams = make_beams(sensor);
  beams.times_ns.resize(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    beams.times_ns[i] = static_cast<std::uint32_t>(1000 * i);
  }
  const Motion still =
      static_motion(scene, look_at({4.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  Motion spin = still;
  spin.world_from_instance[0] = Spin{.rate_rad_s = 30.0 * Eigen::Vector3d::UnitZ()};
  const auto renderer = make_renderer(scene, {.threads = 2});
  Simulator simulator(scene, std::make_shared<const BeamCache>(sensor, beams), *renderer);
  const std::vector<Motion> motions = {still, spin, still};
  std::vector<Frame> frames(motions.size());
  simulator.simulate_batch(motions, {}, frames);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    Frame alone;
    simulator.simulate(motions[i], {}, alone);
    EXPECT_EQ(frames[i].intensity, alone.intensity) << i;
    EXPECT_EQ(frames[i].ground_truth.primitive, alone.ground_truth.primitive) << i;
  }
  EXPECT_NE(frames[0].intensity, frames[1].intensity);
  EXPECT_EQ(frames[0].intensity, frames[2].intensity);
}

}  // namespace
}  // namespace glidar
