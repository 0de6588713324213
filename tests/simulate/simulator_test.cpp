// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>
#include <glidar/simulate/simulator.hpp>
#include <support/data.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

namespace glidar {
namespace {

Pose pose() {
  return look_at({4.0, -1.0, 2.0}, {0.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ());
}

/// A camera of pulses with all that is prepared once: sub-rays, weather, pointing and other noise.
Sensor pulsed_sensor() {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(24, 16, 0.5);
  sensor.wavelength_m = 905e-9;
  sensor.lidar_equation = LidarEquation{.noise_sigma = 0.1};
  sensor.footprint = Footprint{.divergence_x_rad = 3e-3, .divergence_y_rad = 3e-3};
  sensor.weather = Weather{.visibility_m = 50.0, .rain_mm_per_h = 20.0};
  sensor.receiver.returns = {{Return::Order::strongest, 0}, {Return::Order::farthest, 0}};
  sensor.noise = {PointingJitter{.sigma_azimuth_rad = 1e-3}, RangeGaussian{.sigma_m = 0.01},
                  Crosstalk{.probability = 0.1}};
  return sensor;
}

Frame seeded(std::uint64_t seed) {
  Frame frame;
  frame.seed = seed;
  return frame;
}

void expect_same(const Frame& one, const Frame& other) {
  const auto is_same = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  EXPECT_TRUE(is_same(one.range_m, other.range_m));
  EXPECT_TRUE(is_same(one.intensity, other.intensity));
  EXPECT_TRUE(is_same(one.true_directions, other.true_directions));
  EXPECT_TRUE(is_same(one.ground_truth.range_m, other.ground_truth.range_m));
  EXPECT_EQ(one.status, other.status);
  EXPECT_EQ(one.return_source, other.return_source);
}

/// The sensor with beams that fire one after another, 10 us apart.
std::shared_ptr<const BeamCache> one_by_one(const Sensor& sensor) {
  Beams beams = make_beams(sensor);
  for (std::uint32_t i = 0; i < beams.size(); ++i) {
    beams.times_ns.push_back(10'000U * (i % static_cast<std::uint32_t>(beams.firings())));
  }
  return std::make_shared<const BeamCache>(sensor, beams);
}

TEST(Simulator, AFrameDoesNotDependOnTheFramesBefore) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  const auto renderer = make_renderer(scene, {.threads = 2});
  const Motion still = static_motion(scene, pose());
  Motion spin = still;
  spin.world_from_instance[0] = Spin{.rate_rad_s = 30.0 * Eigen::Vector3d::UnitZ()};
  for (const Sensor& sensor : {pulsed_sensor(), ground_truth_sensor(pulsed_sensor())}) {
    const auto beams = one_by_one(sensor);
    Frame expected = seeded(7);
    Simulator(scene, beams, *renderer).simulate(still, {.normal = true}, expected);
    Simulator simulator(scene, beams, *renderer);
    Frame frame = seeded(8);
    simulator.simulate(spin, kAllHitColumns, frame);
    EXPECT_NE(frame.intensity, expected.intensity);
    frame.seed = 7;
    simulator.simulate(still, {.normal = true}, frame);
    expect_same(frame, expected);
  }
}

TEST(Simulator, SimulatesTheFirstFrameOfAStaticScene) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  Simulator simulator(scene, pulsed_sensor(), {.threads = 2});
  Frame expected = seeded(5);
  simulator.simulate(static_motion(scene, pose()), {}, expected);
  expect_same(simulator.simulate(pose(), {}, 5), expected);
}

TEST(Simulator, SharesARendererWithOthers) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  const auto renderer = make_renderer(scene, {.threads = 2});
  Simulator one(scene, pulsed_sensor(), *renderer);
  Simulator other(scene, ground_truth_sensor(pulsed_sensor()), *renderer);
  const Frame before = one.simulate(pose());
  EXPECT_GT(std::count(before.status.begin(), before.status.end(), Status::hit), 50);
  const Frame between = other.simulate(pose());
  EXPECT_NE(between.status.size(), before.status.size());
  expect_same(one.simulate(pose()), before);
}

TEST(Simulator, KeepsTheDirectionsOfPointingErrorsInTheFrame) {
  const Scene scene = testing::scene_of(make_builtin_model("box"));
  Simulator simulator(scene, pulsed_sensor(), {.threads = 2});
  Frame frame = simulator.simulate(pose());
  EXPECT_EQ(frame.true_directions.size(), simulator.beams()->size());
  Simulator without(scene, ground_truth_sensor(pulsed_sensor()), {.threads = 2});
  without.simulate(static_motion(scene, pose()), {}, frame);
  EXPECT_TRUE(frame.true_directions.empty());
}

}  // namespace
}  // namespace glidar
