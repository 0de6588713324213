// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Noise from the scene to the frame: the same bytes for any number of threads, and no other effect.
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

namespace glidar {
namespace {

std::vector<NoiseStep> every_step() {
  return {PointingJitter{.sigma_azimuth_rad = 1e-4, .sigma_elevation_rad = 1e-4},
          EncoderError{.step_rad = 1e-4, .eccentricity_rad = 1e-4, .turn_sigma_rad = 1e-4},
          IntensityGaussian{.sigma = 0.01, .relative = 0.02},
          RangeGaussian{.sigma_m = 0.001, .sigma_per_m = 1e-4},
          RangeSnr{.floor_m = 0.001, .k_m = 0.01, .snr_at_full_scale = 100.0},
          RangeCrlb{.pulse_fwhm_s = 5e-9, .sample_s = 1e-9, .noise = 1e-4},
          RangeShotNoise{.pulse_fwhm_s = 5e-9, .photons_at_full_scale = 1e5},
          RangeUniform{.additive_m = 1e-3, .multiplicative = 1e-4},
          RangeBias{.offset_m = 0.01, .sigma_m = 0.001},
          RangeDrift{.sigma_m = 0.001, .tau_s = 1.0, .per_ring = true},
          Crosstalk{.probability = 0.01, .near_m = 0.5},
          FalseAlarms{.rate_hz = 1e5, .near_m = 0.5, .far_m = 20.0, .intensity = 0.1},
          Khoshelham{},
          NguyenAxial{},
          NguyenLateral{},
          IclKinect{},
          Stereo{.focal_px = 500.0, .baseline_m = 0.1, .sigma_px = 0.1},
          ContinuousWave{.frequencies_hz = {80e6, 16e6, 120e6},
                         .electrons_at_full_scale = 1e5,
                         .multipath_fraction = 0.1},
          KinectV1{},
          DisparityQuantization{.k_m = 1e4},
          Dropout{.probability = 0.02,
                  .by_range_m = {{1.0, 0.0}, {10.0, 0.1}},
                  .by_incidence_rad = {{1.0, 0.0}, {1.6, 0.5}}},
          RangeQuantization{.step_m = 1e-3},
          IntensityScale{.kind = IntensityScale::Kind::vendor}};
}

/// A depth camera before the asteroid.
struct Stage {
  Scene scene = testing::scene_of(make_builtin_model("asteroid"));
  Sensor sensor;
  Beams beams;
  Motion motion;

  Stage() {
    for (Material& material : scene.materials) material.specular.setZero();  // no pow
    sensor.optics = pinhole_from_fov(96, 64, 0.5);
    beams = make_beams(sensor);
    motion =
        static_motion(scene, look_at({4.0, -3.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ()));
  }
  Frame shoot(unsigned threads, std::uint64_t seed = 1, std::uint32_t number = 0) const {
    const auto renderer = make_renderer(scene, {.threads = threads});
    Frame frame;
    frame.seed = seed;
    frame.number = number;
    testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
    return frame;
  }
};

/// Allows eight threads on machines with fewer processors.
const tbb::global_control kEightThreads(tbb::global_control::max_allowed_parallelism, 8);

/// Bytes, so that NaN equals NaN.
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool same(const Frame& a, const Frame& b) {
  return same(a.range_m, b.range_m) && same(a.intensity, b.intensity) && same(a.status, b.status) &&
         same(a.sigma_m, b.sigma_m);
}

TEST(Noise, GivesTheSameBytesForAnyNumberOfThreads) {
  Stage stage;
  stage.sensor.noise = every_step();
  ASSERT_EQ(stage.sensor.noise.size(), std::variant_size_v<NoiseStep>);
  const Frame one = stage.shoot(1);
  EXPECT_GT(std::count(one.status.begin(), one.status.end(), Status::hit), 500);
  EXPECT_TRUE(same(one, stage.shoot(2)));
  EXPECT_TRUE(same(one, stage.shoot(8)));
}

TEST(Noise, EverySingleStepGivesTheSameBytesForAnyNumberOfThreads) {
  Stage stage;
  for (const NoiseStep& step : every_step()) {
    stage.sensor.noise = {step};
    EXPECT_TRUE(same(stage.shoot(1), stage.shoot(8))) << step.index();
  }
}

TEST(Noise, EveryStepChangesTheFrame) {
  Stage stage;
  const Frame plain = stage.shoot(2);
  for (const NoiseStep& step : every_step()) {
    stage.sensor.noise = {step};
    EXPECT_FALSE(same(stage.shoot(2), plain)) << step.index();
  }
}

TEST(Noise, DependsOnSeedAndFrame) {
  Stage stage;
  stage.sensor.noise = {RangeGaussian{.sigma_m = 0.01}};
  const Frame frame = stage.shoot(2);
  EXPECT_FALSE(same(frame.range_m, stage.shoot(2, 2).range_m));
  EXPECT_FALSE(same(frame.range_m, stage.shoot(2, 1, 1).range_m));
  EXPECT_TRUE(same(frame.range_m, stage.shoot(2).range_m));
}

TEST(Noise, DoesNotChangeTheGroundTruth) {
  Stage stage;
  const Frame plain = stage.shoot(2);
  stage.sensor.noise = {RangeGaussian{.sigma_m = 0.01}, Dropout{.probability = 0.5}};
  EXPECT_TRUE(same(plain.ground_truth.range_m, stage.shoot(2).ground_truth.range_m));
}

TEST(Noise, AMaterialScalesIt) {
  Stage stage;
  stage.sensor.noise = {RangeGaussian{.sigma_m = 0.01}};
  const Frame plain = stage.shoot(2);
  for (Material& material : stage.scene.materials) material.noise_scale = 2.5F;
  const Frame scaled = stage.shoot(2);
  for (std::size_t i = 0; i < plain.range_m.size(); ++i) {
    if (plain.status[i] != Status::hit) continue;
    const double error_m = plain.range_m[i] - plain.ground_truth.range_m[i];
    EXPECT_NEAR(scaled.range_m[i] - scaled.ground_truth.range_m[i], 2.5 * error_m, 1e-14);
    EXPECT_FLOAT_EQ(scaled.sigma_m[i], 0.025F);
  }
}

TEST(Noise, ATextureScalesIt) {
  Stage stage;
  stage.scene = testing::scene_of(make_builtin_model("plane"));
  stage.motion = static_motion(stage.scene,
                               look_at({0.0, 0.0, 3.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY()));
  Texture texture{.name = "halves", .width = 2, .height = 1, .channels = 1, .texels = {0, 255}};
  stage.scene.textures.push_back(texture);
  for (Material& material : stage.scene.materials) {
    material.noise_texture.texture = static_cast<std::int32_t>(stage.scene.textures.size() - 1);
    material.noise_texture.filter = Filter::nearest;
    material.noise_scale = 3.0F;
  }
  stage.sensor.noise = {RangeGaussian{.sigma_m = 0.01}};
  const Frame frame = stage.shoot(2);
  double none = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != Status::hit) continue;
    const double error_m = frame.range_m[i] - frame.ground_truth.range_m[i];
    if (frame.sigma_m[i] == 0.0F) {
      EXPECT_EQ(error_m, 0.0);
      none += 1.0;
    } else {
      EXPECT_FLOAT_EQ(frame.sigma_m[i], 0.03F);
      all += 1.0;
    }
  }
  EXPECT_NEAR(none / all, 1.0, 0.05);
}

TEST(Noise, BeamsWithJitterAreReportedInTheNominalDirection) {
  Stage stage;
  stage.sensor.noise = {PointingJitter{.sigma_azimuth_rad = 0.01, .sigma_elevation_rad = 0.01}};
  stage.scene = testing::scene_of(make_builtin_model("plane"));
  stage.motion = static_motion(stage.scene,
                               look_at({0.0, 0.0, 3.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitY()));
  const Frame frame = stage.shoot(2);
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
    if (frame.status[i] != Status::hit) continue;
    const Eigen::Vector3d& went = frame.true_directions[i];
    EXPECT_NEAR(frame.range_m[i] * went.z(), 3.0, 1e-12);
    const double apart = std::acos(std::min(1.0, went.dot(stage.beams.directions[i])));
    squares += apart * apart;
    count += 1.0;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.01 * std::sqrt(2.0), 3e-4);  // four standard errors
}

}  // namespace
}  // namespace glidar
