// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/simulate/explain.hpp>
#include <simulate/panels.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace glidar {
namespace {

/// A camera before a wall, half of it nearer.
struct Stage : testing::PanelScene {
  Sensor sensor;

  Stage() {
    sensor.optics = pinhole_from_fov(40, 30, 0.5);
    add_wall(5.0, -50.0, 0.0);
    add_wall(8.0);
  }
  /// Simulates, or explains if a trace is requested.
  Frame shoot(std::size_t entry, PointTrace* trace) const {
    const auto renderer = make_renderer(scene, {.threads = 2});
    const Motion motion = static_motion(scene, Pose::Identity());
    Simulator simulator(scene, sensor, *renderer);
    Frame frame;
    frame.seed = 5;
    frame.number = 2;
    if (trace != nullptr) {
      *trace = explain(simulator, motion, entry, frame);
    } else {
      simulator.simulate(motion, {}, frame);
    }
    return frame;
  }
};

Stage noisy_stage() {
  Stage stage;
  stage.sensor.noise = {PointingJitter{1e-3, 1e-3}, RangeGaussian{.sigma_m = 0.1},
                        RangeQuantization{.step_m = 0.05}, Dropout{.probability = 0.3}};
  return stage;
}

std::vector<double> depths_of(const Sensor& sensor, const Frame& frame) {
  const Beams beams = make_beams(sensor);
  std::vector<double> depths_m;
  for (std::size_t i = 0; i < beams.size(); ++i)
    depths_m.push_back(depth_m(beams, i, frame.range_m[i]));
  return depths_m;
}

void expect_same(const Frame& one, const Frame& other) {
  EXPECT_EQ(one.status, other.status);
  EXPECT_EQ(one.intensity, other.intensity);
  EXPECT_EQ(one.sigma_m, other.sigma_m);
  EXPECT_EQ(one.return_source, other.return_source);
  ASSERT_EQ(one.range_m.size(), other.range_m.size());
  for (std::size_t i = 0; i < one.range_m.size(); ++i) {
    if (!std::isnan(one.range_m[i])) {
      EXPECT_EQ(one.range_m[i], other.range_m[i]) << i;
    }
  }
}

TEST(Explain, MakesTheSameFrameAsSimulate) {
  for (Stage stage : {Stage(), noisy_stage()}) {
    for (const bool pulsed : {false, true}) {
      if (pulsed) {
        stage.sensor.lidar_equation = LidarEquation{.noise_sigma = 0.1};
        stage.sensor.footprint = Footprint{.divergence_x_rad = 3e-3, .divergence_y_rad = 3e-3};
        stage.sensor.receiver.returns = {{Return::Order::nearest, 0}, {Return::Order::farthest, 0}};
      }
      PointTrace trace;
      expect_same(stage.shoot(7, &trace), stage.shoot(7, nullptr));
    }
  }
}

/// Noise takes about half of the ranges out of the limits.
Stage limited_stage() {
  Stage stage;
  stage.sensor.noise = {RangeGaussian{.sigma_m = 0.1}, RangeQuantization{.step_m = 0.05}};
  stage.sensor.limits = {.near_m = 4.98, .far_m = 8.02};
  return stage;
}

TEST(Explain, AppliesTheLimitsToTheSurfaceAndAfterNoise) {
  const Stage stage = limited_stage();
  PointTrace trace;
  const Frame frame = stage.shoot(7, &trace);
  expect_same(frame, stage.shoot(7, nullptr));
  const std::vector<double> depths_m = depths_of(stage.sensor, frame);
  std::size_t removed = 0;
  for (std::size_t i = 0; i < frame.status.size(); i += 13) {
    stage.shoot(i, &trace);
    EXPECT_EQ(trace.reported.status, frame.status[i]);
    if (frame.status[i] == Status::hit) {
      EXPECT_GE(depths_m[i], 4.98);
      EXPECT_LE(depths_m[i], 8.02);
      EXPECT_EQ(trace.reported.range_m, frame.range_m[i]);
      continue;
    }
    EXPECT_EQ(trace.measured.status, Status::hit);
    EXPECT_EQ(trace.noise.back().after.status, Status::hit);
    const bool is_near = trace.noise.back().after.range_m < 6.5;
    EXPECT_EQ(frame.status[i], is_near ? Status::too_near : Status::too_far);
    ++removed;
  }
  EXPECT_GT(removed, 20U);
}

TEST(Explain, TracesAnEntryThroughAllNoiseSteps) {
  const Stage stage = noisy_stage();
  std::size_t dropped = 0;
  for (const std::size_t entry : {0U, 21U, 600U, 1111U, 1199U}) {
    PointTrace trace;
    const Frame frame = stage.shoot(entry, &trace);
    ASSERT_EQ(trace.noise.size(), 4U);
    EXPECT_EQ(trace.measured.range_m, frame.ground_truth.range_m[entry]);
    EXPECT_EQ(trace.noise[0].after.range_m, trace.measured.range_m) << "the beam was turned before";
    const double noisy_m = trace.measured.range_m + 0.1 * trace.noise[1].samples.at(0).value;
    EXPECT_NEAR(trace.noise[1].after.range_m, noisy_m, 1e-12);
    EXPECT_FLOAT_EQ(trace.noise[1].after.sigma_m, 0.1F);
    EXPECT_NEAR(trace.noise[2].after.range_m, noisy_m, 0.025 + 1e-12);
    const bool is_dropped = trace.noise[3].samples.at(0).value < 0.3;
    EXPECT_EQ(trace.noise[3].after.status, is_dropped ? Status::dropped : Status::hit);
    EXPECT_EQ(trace.noise[3].after.status, frame.status[entry]);
    dropped += is_dropped ? 1U : 0U;
    EXPECT_FALSE(trace.waveform.has_value());
  }
  EXPECT_GT(dropped, 0U);
}

TEST(Explain, ReportsTheActualDirectionOfABeam) {
  Stage stage;
  PointTrace trace;
  stage.shoot(17, &trace);
  EXPECT_EQ(trace.direction, make_beams(stage.sensor).directions[17]);
  stage = noisy_stage();
  stage.shoot(17, &trace);
  const double off_rad = (trace.direction - make_beams(stage.sensor).directions[17]).norm();
  EXPECT_GT(off_rad, 1e-5);
  EXPECT_NEAR(off_rad,
              1e-3 * std::hypot(trace.noise[0].samples[0].value, trace.noise[0].samples[1].value),
              1e-6);
}

TEST(Explain, TracesTheEchoesOfAPulse) {
  Stage stage;
  stage.sensor.optics = pinhole_from_fov(1, 1, 1e-3);  // on the edge of the nearer wall
  stage.sensor.lidar_equation = LidarEquation{};
  stage.sensor.footprint =
      Footprint{.divergence_x_rad = 3e-3, .divergence_y_rad = 3e-3, .rings = 2};
  stage.sensor.receiver.returns = {{Return::Order::nearest, 0}, {Return::Order::farthest, 0}};
  PointTrace trace;
  const Frame frame = stage.shoot(1, &trace);
  ASSERT_TRUE(trace.waveform.has_value());
  const WaveformTrace& waveform = *trace.waveform;
  EXPECT_EQ(waveform.pulse, 0U) << "the second return of the first pulse";
  EXPECT_EQ(waveform.sub_rays, sample_footprint(*stage.sensor.footprint).size());
  ASSERT_EQ(waveform.light_paths.size(), waveform.sub_rays);
  double share = 0.0;
  for (const WaveformTrace::LightPath& way : waveform.light_paths) {
    share += way.share;
    EXPECT_NEAR(way.path.range_m, way.instance == 0 ? 5.0 : 8.0, 1e-4);
    EXPECT_LT(way.path.source, waveform.sub_rays);
  }
  EXPECT_NEAR(share, 1.0, 1e-12);
  ASSERT_EQ(waveform.received.size(), 2U);
  EXPECT_EQ(waveform.returns, (std::vector<int>{0, 1}));
  EXPECT_EQ(waveform.received[0].range_m, frame.range_m[0]);
  EXPECT_EQ(waveform.received[1].range_m, frame.range_m[1]);
  EXPECT_EQ(trace.measured.range_m, frame.range_m[1]);
}

TEST(Explain, MarksAMixedEchoAndTheSurfacesOfItsPaths) {
  Stage stage;
  stage.sensor.lidar_equation = LidarEquation{};
  stage.sensor.footprint = Footprint{.divergence_x_rad = 0.1, .divergence_y_rad = 0.1};
  stage.add_wall(5.3);
  PointTrace trace;
  std::size_t mixed = 0;
  for (std::size_t entry = 0; entry < 20; ++entry) {
    const Frame frame = stage.shoot(entry, &trace);
    ASSERT_TRUE(trace.waveform.has_value());
    std::set<std::uint16_t> surfaces;
    for (const WaveformTrace::LightPath& way : trace.waveform->light_paths)
      surfaces.insert(way.path.surface);
    ASSERT_EQ(trace.waveform->echoes.size(), 1U);
    EXPECT_EQ(trace.waveform->echoes[0].is_mixed, surfaces.size() > 1);
    EXPECT_EQ(frame.return_source[entry] == ReturnSource::mixed_pixel, surfaces.size() > 1);
    if (surfaces.size() > 1) ++mixed;
  }
  EXPECT_GT(mixed, 0U);
  EXPECT_LT(mixed, 20U);
}

TEST(Explain, ReportsTheReceiversNoise) {
  Stage stage;
  stage.sensor.lidar_equation = LidarEquation{.noise_sigma = 0.2};
  stage.sensor.receiver.returns = {{Return::Order::nearest, 0}};
  PointTrace trace;
  const Frame frame = stage.shoot(300, &trace);
  const RngKey draw = rng_key(frame, Purpose::detection, 300);
  ASSERT_EQ(trace.waveform->echoes.size(), 1U);
  ASSERT_EQ(trace.receiver_noise.size(), 1U);
  EXPECT_EQ(trace.receiver_noise[0], normals(random_words(draw))[0]);
  EXPECT_NEAR(trace.waveform->received[0].signal,
              trace.waveform->echoes[0].signal + 0.2 * normals(random_words(draw))[0], 1e-9);
}

TEST(Explain, TracesThePulseOfASelectedEntry) {
  Stage stage = noisy_stage();
  stage.sensor.lidar_equation = LidarEquation{.noise_sigma = 0.2};
  stage.sensor.footprint = Footprint{.divergence_x_rad = 3e-3, .divergence_y_rad = 3e-3};
  stage.sensor.weather = Weather{.rain_mm_per_h = 20.0};
  const auto renderer = make_renderer(stage.scene, {.threads = 2});
  const Motion motion = static_motion(stage.scene, Pose::Identity());
  Simulator simulator(stage.scene, stage.sensor, *renderer);
  Frame frame;
  const auto last_hit = [](const Frame& measured) {
    const auto found = std::find(measured.status.rbegin(), measured.status.rend(), Status::hit);
    return static_cast<std::size_t>(found.base() - measured.status.begin()) - 1;
  };
  const PointTrace trace = explain(simulator, motion, last_hit, frame);
  EXPECT_EQ(frame.status[trace.entry], Status::hit);
  EXPECT_EQ(last_hit(frame), trace.entry);
  ASSERT_TRUE(trace.waveform.has_value());
  EXPECT_EQ(trace.waveform->pulse, trace.entry);
  EXPECT_EQ(trace.waveform->received.at(0).range_m, trace.measured.range_m);
  EXPECT_EQ(trace.noise.back().after.range_m, frame.range_m[trace.entry]);
  Frame simulated;
  simulator.simulate(motion, {}, simulated);
  expect_same(frame, simulated);
}

TEST(Explain, RejectsAnInvalidEntry) {
  PointTrace trace;
  EXPECT_EQ(error_text([&] { Stage().shoot(1200, &trace); }),
            "index: 1200; allowed: 0 to 1199, the entries of this frame");
}

}  // namespace
}  // namespace glidar
