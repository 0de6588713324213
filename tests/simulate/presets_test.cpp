// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The sensor presets, with signal and noise, against data sheets and recordings.
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/model/builtin_models.hpp>
#include <support/data.hpp>
#include <support/parameter_name.hpp>
#include <support/preset.hpp>
#include <support/simulate.hpp>

#include <gtest/gtest.h>
#include <io/yaml_files.hpp>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

using testing::preset;

/// A sensor inside a diffuse sphere: beams are at normal incidence, except for its small facets.
struct Ball {
  Scene scene = testing::scene_of(make_builtin_model("sphere"));
  Beams beams;
  Frame frame;

  Ball(const Sensor& sensor, double radius_m, double reflectance) : beams(make_beams(sensor)) {
    scene.instances[0].scale = radius_m;
    for (Material& material : scene.materials) {
      material.diffuse.setConstant(static_cast<float>(reflectance));
    }
    const auto renderer = make_renderer(scene, {.threads = 2});
    const Motion motion = static_motion(scene, Pose::Identity());
    frame.seed = 5;
    testing::simulate({scene, sensor, beams, motion, *renderer}, {}, frame);
  }

  /// Of the pixels that have a beam.
  [[nodiscard]] double share_of_hits() const {
    const auto count = [&](Status status) {
      return static_cast<double>(std::count(frame.status.begin(), frame.status.end(), status));
    };
    const double beams_there =
        static_cast<double>(frame.status.size()) - count(Status::invalid_pixel);
    return count(Status::hit) / beams_there;
  }

  /// Rms over the hits of error(beam); false alarms, far away, are ignored.
  template <class Error>
  [[nodiscard]] double rms(const Error& error) const {
    constexpr double kFalse_m = 1.0;
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (frame.status[i] != Status::hit) continue;
      if (std::abs(frame.range_m[i] - frame.ground_truth.range_m[i]) > kFalse_m) continue;
      squares += std::pow(error(i), 2);
      ++count;
    }
    return std::sqrt(squares / count);
  }

  [[nodiscard]] double range_error_m() const {
    return rms([&](std::size_t i) { return frame.range_m[i] - frame.ground_truth.range_m[i]; });
  }

  /// Error of 1 / depth.
  [[nodiscard]] double inverse_depth_error_per_m() const {
    return rms([&](std::size_t i) {
      return 1.0 / depth_m(beams, i, frame.range_m[i]) -
             1.0 / depth_m(beams, i, frame.ground_truth.range_m[i]);
    });
  }
};

void expect_room_measured(const SensorReference& reference) {
  Sensor sensor = load_sensor_file(reference);
  sensor.limits = {.along = Limits::Along::range};
  const Ball room(sensor, 2.0, 0.5);
  EXPECT_GT(room.share_of_hits(), 0.999);
  // flash arrays: 0.1 m; altimeters: steps of 37.5 cm (MOLA), 1 m (Hayabusa)
  const bool is_altimeter = sensor.rate_hz <= 10.0 && room.beams.size() == 1;
  EXPECT_LT(room.range_error_m(), is_altimeter ? 3.0 : 0.11);
  for (std::size_t i = 0; i < room.beams.size(); ++i) {
    ASSERT_TRUE(room.frame.status[i] != Status::hit || room.frame.range_m[i] > 0.0);
    ASSERT_TRUE(room.frame.intensity[i] >= 0.0F && std::isfinite(room.frame.intensity[i]));
  }
}

TEST(Presets, MeasureARoomWithIntensityAndNoise) {
  for (const SensorPreset& one : sensor_presets()) {
    SCOPED_TRACE(one.name);
    expect_room_measured(one.reference);
  }
}

TEST(Presets, MeasureARoomInEachOfTheirModes) {
  for (const SensorPreset& one : sensor_presets()) {
    for (const std::string& mode : one.modes) {
      if (mode == one.default_mode) continue;  // measured above
      SCOPED_TRACE(one.name + ", mode " + mode);
      expect_room_measured({one.reference.file, one.reference.variant, mode});
    }
  }
}

/// The range of the data sheet at which a reflectance is detected with probability 1/2.
struct SheetPair {
  const char* sensor;
  double reflectance;
  double range50_m;
};

void PrintTo(const SheetPair& pair, std::ostream* out) {
  *out << pair.sensor << ", reflectance " << pair.reflectance;
}

class PresetRange : public ::testing::TestWithParam<SheetPair> {};

// Half of the channels of the XT32 reach 80 m on 10 %, the others 50 m.
TEST(Presets, OuterChannelsOfTheXt32DetectLess) {
  constexpr double kRange_m = 60.0;
  const auto probability = [&](double reference_m) {
    const double signal = reference_m * reference_m / (kRange_m * kRange_m);
    return 0.5 * std::erfc((1.0 - signal) / (0.33 * std::numbers::sqrt2));
  };
  Sensor sensor = preset("XT32");
  sensor.limits = {.along = Limits::Along::range};
  const double expected = 0.5 * (probability(80.0) + probability(50.0));
  EXPECT_NEAR(Ball(sensor, kRange_m, 0.1).share_of_hits(), expected, 0.01);
}

TEST_P(PresetRange, IsThatOfTheDataSheetWithinOneMetre) {
  const SheetPair& pair = GetParam();
  Sensor sensor = preset(pair.sensor);
  sensor.limits = {.along = Limits::Along::range};
  std::erase_if(sensor.noise, [](const NoiseStep& step) {
    return std::holds_alternative<FalseAlarms>(step);  // they are no surface
  });
  const auto seen = [&](double range_m) {
    return Ball(sensor, range_m, pair.reflectance).share_of_hits();
  };
  EXPECT_GT(seen(pair.range50_m - 1.0), 0.5);
  EXPECT_LT(seen(pair.range50_m + 1.0), 0.5);
}

// Ouster revision 6 (50 %), HDL-64E, Alpha Prime, XT32, PandarQT, Livox, TiM781.
INSTANTIATE_TEST_SUITE_P(
    Sheets, PresetRange,
    ::testing::Values(SheetPair{"OS0-32", 0.8, 50.0}, SheetPair{"OS0-32", 0.1, 20.0},
                      SheetPair{"OS1-32", 0.8, 120.0}, SheetPair{"OS1-32", 0.1, 55.0},
                      SheetPair{"OS2-32", 0.8, 240.0}, SheetPair{"OS2-32", 0.1, 100.0},
                      SheetPair{"HDL-64E-S3", 0.8, 120.0}, SheetPair{"HDL-64E-S3", 0.1, 50.0},
                      SheetPair{"VLS-128", 0.1, 120.0}, SheetPair{"QT64", 0.1, 20.0},
                      SheetPair{"Livox-Mid-40", 0.8, 260.0}, SheetPair{"Livox-Mid-70", 0.8, 260.0},
                      SheetPair{"Livox-Avia", 0.8, 320.0}, SheetPair{"Livox-Horizon", 0.8, 260.0},
                      SheetPair{"Livox-Horizon", 0.1, 90.0}, SheetPair{"Livox-Tele-15", 0.8, 500.0},
                      SheetPair{"Livox-Tele-15", 0.1, 200.0}, SheetPair{"TiM781", 0.05, 5.0}),
    testing::parameter_name<SheetPair>);

TEST(Presets, OfOusterDetectNinetyPercentAtTheRangeOfTheDataSheet) {
  for (const SheetPair& pair : {SheetPair{"OS0-64", 0.8, 45.0}, SheetPair{"OS1-64", 0.8, 100.0},
                                SheetPair{"OS2-64", 0.8, 210.0}}) {
    EXPECT_NEAR(Ball(preset(pair.sensor), pair.range50_m, pair.reflectance).share_of_hits(), 0.9,
                0.01);
  }
}

/// Standard deviation of ranges in recordings or data sheets.
struct Spread {
  const char* sensor;
  double range_m;
  double reflectance;
  double least_m;
  double most_m;
};

void PrintTo(const Spread& spread, std::ostream* out) {
  *out << spread.sensor << " at " << spread.range_m << " m, reflectance " << spread.reflectance;
}

class PresetSpread : public ::testing::TestWithParam<Spread> {};

TEST_P(PresetSpread, IsThatOfRecordingsAndDataSheets) {
  const Spread& spread = GetParam();
  const double found_m =
      Ball(preset(spread.sensor), spread.range_m, spread.reflectance).range_error_m();
  EXPECT_GT(found_m, spread.least_m);
  EXPECT_LT(found_m, spread.most_m);
}

INSTANTIATE_TEST_SUITE_P(Sheets, PresetSpread,
                         ::testing::Values(Spread{"VLP-16", 3.0, 0.95, 0.0060, 0.0072},
                                           Spread{"VLP-16", 3.0, 0.2, 0.0065, 0.0097},
                                           Spread{"VLP-16", 3.0, 0.06, 0.0083, 0.0123},
                                           Spread{"VLP-32C", 1.5, 0.5, 0.0038, 0.0044},
                                           Spread{"VLP-32C", 7.5, 0.5, 0.0071, 0.0079},
                                           Spread{"XT32", 5.0, 0.5, 0.0029, 0.0033},
                                           Spread{"QT64", 3.0, 0.5, 0.013, 0.016},
                                           Spread{"Livox-Mid-40", 20.0, 0.8, 0.019, 0.021},
                                           Spread{"UTM-30LX", 15.0, 0.8, 0.01, 0.03},
                                           Spread{"OS2-32", 10.0, 0.5, 0.005, 0.0076},
                                           Spread{"flash-128", 100.0, 0.5, 0.05, 0.15}),
                         testing::parameter_name<Spread>);

TEST(Presets, OfDepthCamerasSpreadAsMeasured) {
  // 0.53 to 0.60 steps of 1 / 345.5 m in recorded frames
  const double kinect_steps =
      345.5 * Ball(preset("Kinect-v1"), 2.0, 0.5).inverse_depth_error_per_m();
  EXPECT_GT(kinect_steps, 0.52);
  EXPECT_LT(kinect_steps, 0.60);
  // elevation_mapping's D435: 3.587 mm at 1 m, growing with the square of the depth
  EXPECT_NEAR(Ball(preset("D435"), 2.0, 0.5).inverse_depth_error_per_m(), 0.003587, 2e-5);
  const double azure_m = Ball(preset("Azure-Kinect-NFOV-2x2"), 1.2, 0.5).range_error_m();
  EXPECT_GT(azure_m, 0.001);
  EXPECT_LT(azure_m, 0.003);
}

TEST(Presets, OfVelodyneReportReflectanceInPercent) {
  const Ball ball(preset("VLP-16"), 10.0, 0.5);
  for (const float intensity : ball.frame.intensity) EXPECT_NEAR(intensity, 50.0F, 1.0F);
}

TEST(Presets, OfOusterHaveOneFalseAlarmInTenThousand) {
  const Ball empty(preset("OS1-128"), 1e5, 0.5);
  const double expected = 1e-4 * static_cast<double>(empty.beams.size());
  const double found = empty.share_of_hits() * static_cast<double>(empty.beams.size());
  EXPECT_NEAR(found, expected, 4.0 * std::sqrt(expected));
}

TEST(Surfaces, ReturnTheSignalOfTheLidarEquation) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml",
      "models: [{model: builtin:box, scale: 10, materials: {\"*\": {surface: asphalt}}}]\n"
      "sensor: {optics: {width: 1, height: 1, fov_deg: 1}, wavelength_nm: 905,\n"
      "  lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}}\n");
  const SceneFile loaded = load_scene_file(file, {}, {});
  const Beams beams = make_beams(loaded.sensors.at(0).sensor);
  const auto renderer = make_renderer(loaded.scene, {.threads = 1});
  const Motion motion = static_motion(loaded.scene, Pose::Identity());
  Frame frame;
  testing::simulate({loaded.scene, loaded.sensors.at(0).sensor, beams, motion, *renderer}, {},
                    frame);
  EXPECT_NEAR(frame.range_m[0], 10.0, 1e-9);  // a wall of the box, at normal incidence
  EXPECT_NEAR(frame.intensity[0], 0.278 / 0.8 * 100.0, 1e-4);
}

/// Looks past a box of 0.8 m at the walls of a room, 4 m away.
Frame look_past_a_box(const Sensor& sensor, double front_m) {
  Scene scene;
  add_model(scene, make_builtin_model("box"));
  scene.instances[0].scale = 4.0;
  add_model(scene, make_builtin_model("box"));
  scene.instances[1].scale = 0.4;
  scene.instances[1].world_from_object.translation().x() = front_m + 0.4;
  const auto renderer = make_renderer(scene, {.threads = 2});
  const Beams beams = make_beams(sensor);
  Frame frame;
  testing::simulate({scene, sensor, beams, static_motion(scene, Pose::Identity()), *renderer}, {},
                    frame);
  return frame;
}

TEST(Presets, OfVelodyneReportBothSurfacesOfACutBeamWithTwoReturns) {
  Sensor sensor = preset("VLP-16");
  sensor.noise.clear();
  sensor.receiver.returns.push_back({Return::Order::farthest, 0});
  const Frame frame = look_past_a_box(sensor, 1.6);
  const std::size_t beams = frame.status.size() / 2;
  std::size_t cut = 0;
  for (std::size_t i = 0; i < beams; ++i) {
    ASSERT_EQ(frame.status[i], Status::hit);
    if (frame.status[beams + i] != Status::hit) continue;
    ++cut;
    EXPECT_GT(std::abs(frame.range_m[beams + i] - frame.range_m[i]), 1.0);  // its separation
  }
  EXPECT_GT(cut, 20U);  // both upright edges on each of the rings that meet the box, and its top
  EXPECT_LT(cut, beams / 50);
}

// A pulse of 5 ns cannot resolve surfaces 0.5 m apart.
TEST(Presets, ReportMixedPixelsUnlessSetToGroundTruth) {
  const Frame wide = look_past_a_box(preset("OS1-128"), 3.5);
  EXPECT_GT(
      std::count(wide.return_source.begin(), wide.return_source.end(), ReturnSource::mixed_pixel),
      0);
  const Frame line = look_past_a_box(ground_truth_sensor(preset("OS1-128")), 3.5);
  EXPECT_EQ(
      std::count(line.return_source.begin(), line.return_source.end(), ReturnSource::mixed_pixel),
      0);
}

TEST(GroundTruthSensor, DoesNotChangeTheGeometry) {
  Sensor noisy = preset("VLP-16");
  noisy.weather = Weather{.rain_mm_per_h = 10.0};
  noisy.projector_origin_m = Eigen::Vector3d::UnitY();
  const Sensor sensor = ground_truth_sensor(noisy);
  EXPECT_FALSE(sensor.lidar_equation.has_value());
  EXPECT_TRUE(noisy.footprint.has_value());
  EXPECT_FALSE(sensor.footprint.has_value());
  EXPECT_FALSE(sensor.weather.has_value());
  EXPECT_FALSE(sensor.projector_origin_m.has_value());
  EXPECT_TRUE(sensor.noise.empty());
  EXPECT_EQ(sensor.limits.far_m, noisy.limits.far_m);
  EXPECT_EQ(sensor.rate_hz, noisy.rate_hz);
  EXPECT_EQ(Ball(sensor, 3.0, 0.5).range_error_m(), 0.0);
}

}  // namespace
}  // namespace glidar
