// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/simulate/simulate.hpp>
#include <support/data.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <cstring>

namespace glidar {
namespace {

class SimulateBatch : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    try {
      if (GetParam() == "opengl") const opengl::EglContext context({});
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    renderer_ = make_renderer(scene_, {.kind = GetParam(), .threads = 2});
    sensor_.optics = pinhole_from_fov(48, 40, 0.5);
    sensor_.noise = {RangeGaussian{.sigma_m = 0.01}, Dropout{.probability = 0.1}};
    beams_ = make_beams(sensor_);
    for (int i = 0; i < kFrames; ++i) {
      const Eigen::Vector3d eye(5.0 + i, 0.3 * i, 1.0 - 0.2 * i);
      motions_.push_back(
          static_motion(scene_, look_at(eye, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ())));
    }
  }

  [[nodiscard]] glidar::Setup setup(int i) const {
    return {scene_, sensor_, beams_, motions_[static_cast<std::size_t>(i)], *renderer_};
  }

  static Frame seeded(int i) {
    Frame frame;
    frame.seed = 100U + static_cast<std::uint64_t>(i);
    frame.number = static_cast<std::uint32_t>(3 * i);
    return frame;
  }

  /// Simulates all together, then each alone, and compares what is measured.
  void expect_as_one_by_one(const std::vector<glidar::Setup>& setups) const {
    const HitFieldMask fields{.depth = true, .normal = true};
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < setups.size(); ++i) frames.push_back(seeded(static_cast<int>(i)));
    simulate_batch(setups, fields, frames);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < setups.size(); ++i) {
      Frame alone = seeded(static_cast<int>(i));
      simulate(setups[i], fields, alone);
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
    EXPECT_GT(hits, 50U * setups.size());
  }

  static constexpr int kFrames = 9;
  Scene scene_ = testing::scene_of(make_builtin_model("torus"));
  Sensor sensor_;
  Beams beams_;
  std::vector<Motion> motions_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_P(SimulateBatch, FramesAreIdenticalToSimulate) {
  std::vector<glidar::Setup> setups;
  for (int i = 0; i < kFrames; ++i) setups.push_back(setup(i));
  expect_as_one_by_one(setups);
}

TEST_P(SimulateBatch, SensorsMayDiffer) {
  Sensor culling = sensor_;
  culling.cull_back_faces = true;
  culling.limits.far_m = 7.0;
  Sensor shadowed = sensor_;
  shadowed.projector_origin_m = Eigen::Vector3d(0.3, 0.0, 0.0);
  Sensor plain;
  plain.optics = pinhole_from_fov(20, 31, 0.6);
  const Beams plain_beams = make_beams(plain);
  std::vector<glidar::Setup> setups = {setup(0), setup(1)};
  setups.push_back({scene_, culling, beams_, motions_[2], *renderer_});
  setups.push_back({scene_, plain, plain_beams, motions_[3], *renderer_});
  if (GetParam() == "rays") {  // a shadow's beams have origins of their own
    setups.push_back({scene_, shadowed, beams_, motions_[4], *renderer_});
  }
  expect_as_one_by_one(setups);
}

TEST_P(SimulateBatch, RejectsWrongNumbersOfFramesAndSeveralRenderers) {
  std::vector<glidar::Setup> setups = {setup(0), setup(1)};
  std::vector<Frame> frames(1);
  EXPECT_EQ(error_text([&] { simulate_batch(setups, {}, frames); }),
            "batch: 2 setups for 1 frames; allowed: one setup per frame");
  const auto other = make_renderer(scene_, {.kind = GetParam(), .threads = 1});
  setups.push_back({scene_, sensor_, beams_, motions_[2], *other});
  frames.resize(3);
  EXPECT_EQ(error_text([&] { simulate_batch(setups, {}, frames); }),
            "batch: several renderers; allowed: one for all");
}

INSTANTIATE_TEST_SUITE_P(All, SimulateBatch, ::testing::ValuesIn(renderer_kinds()),
                         [](const auto& test) { return test.param; });

TEST(SimulateBatchOfEchoes, FramesWithSeveralCastsAreIdenticalToSimulate) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  Sensor moving;
  moving.optics = pinhole_from_fov(32, 24, 0.6);
  Beams beams = make_beams(moving);
  beams.times_ns.resize(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    beams.times_ns[i] = static_cast<std::uint32_t>(1000 * i);
  }
  Motion spin =
      static_motion(scene, look_at({4.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  const Motion still = spin;
  spin.world_from_instance[0] = Spin{.rate_rad_s = 30.0 * Eigen::Vector3d::UnitZ()};
  const auto renderer = make_renderer(scene, {.threads = 2});
  const std::vector<glidar::Setup> setups = {{scene, moving, beams, still, *renderer},
                                             {scene, moving, beams, spin, *renderer},
                                             {scene, moving, beams, still, *renderer}};
  std::vector<Frame> frames(setups.size());
  simulate_batch(setups, {}, frames);
  for (std::size_t i = 0; i < setups.size(); ++i) {
    Frame alone;
    simulate(setups[i], {}, alone);
    EXPECT_EQ(frames[i].intensity, alone.intensity) << i;
    EXPECT_EQ(frames[i].ground_truth.primitive, alone.ground_truth.primitive) << i;
  }
  EXPECT_NE(frames[0].intensity, frames[1].intensity);
  EXPECT_EQ(frames[0].intensity, frames[2].intensity);
}

}  // namespace
}  // namespace glidar
