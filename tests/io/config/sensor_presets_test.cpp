// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/math/constants.hpp>
#include "io/config/published_values.hpp"

#include <gtest/gtest.h>
#include <support/error_text.hpp>
#include <support/parameter_name.hpp>
#include <support/preset.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace glidar {
namespace {

TEST(PresetNames, AreComparedWithoutCaseDashesUnderscoresAndSpaces) {
  EXPECT_EQ(normalised_name("Mid-360_b C"), "mid360bc");
  EXPECT_EQ(match_name("os1 64", {"OS1-32", "OS1-64"}), "OS1-64");
  EXPECT_EQ(match_name("OS1.64", {"OS1-64"}), "");
}

TEST(PresetNames, AnExactNameHasPrecedence) {
  EXPECT_EQ(match_name("a-b", {"AB", "a-b"}), "a-b");
}

TEST(PresetNames, UpToThreeNearestNamesAreSuggested) {
  EXPECT_EQ(nearest_names("VLP-61", {"VLP-16", "ZED"}, "none"), "did you mean VLP-16?");
  EXPECT_EQ(nearest_names("OS1-4", {"OS1-1", "OS1-2", "OS1-3", "OS1-5", "ZED"}, "none"),
            "did you mean OS1-1, OS1-2 or OS1-3?");
  EXPECT_EQ(nearest_names("camera", {"VLP-16"}, "none"), "none");
}

TEST(SensorPresets, NoTwoShareANormalisedNameOrAlias) {
  std::map<std::string, std::string> owner;
  for (const SensorPreset& preset : sensor_presets()) {
    std::vector<std::string> names = preset.aliases;
    names.push_back(preset.name);
    for (const std::string& name : names) {
      const auto [at, is_new] = owner.emplace(normalised_name(name), preset.name);
      EXPECT_TRUE(is_new) << name << " of " << preset.name << " is a name of " << at->second;
    }
  }
}

TEST(SensorPresets, NamesAndAliasesFindTheirSensor) {
  for (const SensorPreset& preset : sensor_presets()) {
    std::vector<std::string> names = preset.aliases;
    names.push_back(preset.name);
    names.push_back(normalised_name(preset.name));
    for (const std::string& name : names) {
      const SensorReference found = find_sensor_file(name);
      EXPECT_EQ(found.file, preset.reference.file) << name;
      EXPECT_EQ(found.variant, preset.reference.variant) << name;
    }
    EXPECT_EQ(load_sensor_file(preset.reference).name, preset.title) << preset.name;
  }
}

TEST(SensorPresets, LoadInEachOfTheirModesAndInTheDefaultOne) {
  for (const SensorPreset& preset : sensor_presets()) {
    SCOPED_TRACE(preset.name);
    EXPECT_EQ(preset.modes.empty(), preset.default_mode.empty());
    EXPECT_EQ(load_sensor_file(preset.reference).mode, preset.default_mode);
    for (const std::string& mode : preset.modes) {
      const SensorReference chosen{preset.reference.file, preset.reference.variant, mode};
      EXPECT_EQ(load_sensor_file(chosen).mode, mode);
    }
  }
}

TEST(SensorPresets, AreFoundByAPartOfTheirNameAliasOrTitle) {
  const auto names = [](const std::string& text) {
    std::vector<std::string> found;
    for (const SensorPreset& preset : matching_presets(text)) found.push_back(preset.name);
    return found;
  };
  EXPECT_EQ(names("hdl_"), (std::vector<std::string>{"HDL-32E", "HDL-64E-S1", "HDL-64E-S2",
                                                     "HDL-64E-S3", "HDL-64E-S3-unit-2"}));
  EXPECT_EQ(names("Velodyne VLP16"), (std::vector<std::string>{"VLP-16"}));
  EXPECT_EQ(names("").size(), sensor_presets().size());
  EXPECT_TRUE(names("no such sensor").empty());
}

TEST(SensorPresets, APartOfANameIsNotAName) {
  EXPECT_FALSE(preset_named("VLP").has_value());
  EXPECT_FALSE(preset_named("").has_value());
  EXPECT_EQ(preset_named("OS1")->name, "OS1-128");
  EXPECT_NE(error_text([] { find_sensor_file("Pandar46"); }).find("did you mean Pandar"),
            std::string::npos);
}

}  // namespace

namespace {

using testing::preset;

/// Angle in degrees between the first and the last beam of a row or column of pixels.
double span_deg(const Beams& beams, std::size_t first, std::size_t count, std::size_t step) {
  std::vector<Eigen::Vector3d> seen;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& d = beams.directions[first + i * step];
    if (!std::isnan(d.x())) seen.push_back(d);
  }
  return std::acos(seen.front().dot(seen.back())) / kDegree;
}

/// Angles of a field of view in degrees: of a camera between the outermost pixels of its middle row
/// and column, else between the outermost beams; a full turn is 360.
Eigen::Vector2d field_of_view_deg(const Sensor& sensor, const FrameInterval& window) {
  if (const auto* pinhole = std::get_if<Pinhole>(&sensor.optics)) {
    const Beams beams = make_beams(sensor, window);
    const std::size_t row = static_cast<std::size_t>(pinhole->intrinsics.cy) * beams.cols;
    const auto col = static_cast<std::size_t>(pinhole->intrinsics.cx);
    return {span_deg(beams, row, beams.cols, 1), span_deg(beams, col, beams.rows, beams.cols)};
  }
  Eigen::Vector2d low(1e9, 1e9);
  Eigen::Vector2d high(-1e9, -1e9);
  for (const Eigen::Vector3d& d : make_beams(sensor, window).directions) {
    if (d.hasNaN()) continue;  // a channel that does not fire in this column
    const Eigen::Vector2d angles(std::atan2(d.y(), d.x()), std::asin(d.z()));
    low = low.cwiseMin(angles);
    high = high.cwiseMax(angles);
  }
  return (high - low) / kDegree;
}

TEST(Presets, AreAllTested) {
  std::set<std::string> tested;
  for (const PublishedValues& published : kPublished) tested.insert(published.name);
  for (const SensorPreset& one : sensor_presets())
    EXPECT_TRUE(tested.contains(one.name)) << one.name;
  EXPECT_EQ(sensor_presets().size(), tested.size());
}

class Preset : public ::testing::TestWithParam<PublishedValues> {};

TEST_P(Preset, HasThePointsOfItsSheet) {
  const PublishedValues& published = GetParam();
  const Sensor sensor = preset(published.name);
  const Beams beams = make_beams(sensor);
  validate(beams);
  EXPECT_EQ(beams.rows, published.rows);
  EXPECT_EQ(beams.cols, published.cols);
  const double points_per_s = static_cast<double>(beams.size()) * sensor.rate_hz;
  // a clock that does not divide a turn gives one column more or less
  EXPECT_NEAR(points_per_s, published.points_per_s, 1.01 * published.rows * sensor.rate_hz);
}

TEST_P(Preset, HasTheFieldOfViewOfItsSheet) {
  const PublishedValues& published = GetParam();
  const Sensor sensor = preset(published.name);
  const bool livox = std::holds_alternative<Prism>(sensor.optics) ||
                     std::holds_alternative<WedgeMirror>(sensor.optics);
  const FrameInterval window = livox ? FrameInterval{0, 1'000'000'000} : frame_interval(sensor, 0);
  const Eigen::Vector2d found_deg = field_of_view_deg(sensor, window);
  // Data sheets are rounded, as-built units deviate by 2 degrees (Ouster's); the cameras' numbers
  // are calibrations of single units: the D435's gives 89.1 x 58.2, the narrow Azure Kinect's 73.1
  // x 65.7.
  EXPECT_NEAR(found_deg.x(), published.across_deg, sensor.optics.index() == 0 ? 2.3 : 1.2);
  EXPECT_NEAR(found_deg.y(), published.upright_deg, 2.3);
}

TEST_P(Preset, TellsOneReturnOfABeamUnlessMoreAreChosen) {
  Sensor sensor = preset(GetParam().name);
  EXPECT_EQ(sensor.receiver.returns.size(), 1U);
  const Beams one = make_beams(sensor);
  sensor.receiver.returns.push_back({Return::Order::farthest, 0});
  const Beams two = make_beams(sensor);
  EXPECT_EQ(two.rows, 2 * one.rows);
  EXPECT_EQ(two.cols, one.cols);
  EXPECT_EQ(two.firings(), one.size());
}

TEST_P(Preset, TellsTheSourceOfEveryNumber) {
  const Datasheet datasheet = load_datasheet(find_sensor_file(GetParam().name));
  EXPECT_GT(datasheet.entries.size(), 4U);
  for (const DatasheetEntry& entry : datasheet.entries) {
    const bool is_number = entry.value.find_first_of("0123456789") != std::string::npos;
    EXPECT_TRUE(entry.key == "name" || !is_number || !entry.source.empty()) << entry.key;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Preset, ::testing::ValuesIn(kPublished),
                         testing::parameter_name<PublishedValues>);

/// Beams of the data sheets: full widths at half maximum, across and up; TiM781: in all.
struct Beam {
  const char* name;
  double divergence_mrad[2];
  double exit_mm[2];
};

TEST(Presets, HaveTheBeamsOfTheirSheets) {
  constexpr double kPerFwhm = 1.699;  // a Gaussian's width at 1/e^2 over that at half maximum
  std::map<std::string, Beam> sheets;
  for (const Beam& beam : std::to_array<Beam>({{"VLP-16", {3.0, 1.5}, {9.5, 12.7}},
                                               {"Puck-Hi-Res", {3.0, 1.5}, {9.5, 12.7}},
                                               {"HDL-32E", {2.79, 2.79}, {12.7, 6.35}},
                                               {"HDL-64E-S3", {2.0, 2.0}, {0.0, 0.0}},
                                               {"VLS-128", {3.0, 1.5}, {0.0, 0.0}},
                                               {"OS0-32", {6.109, 6.109}, {0.0, 0.0}},
                                               {"OS0-64", {6.109, 6.109}, {0.0, 0.0}},
                                               {"OS0-128", {6.109, 6.109}, {0.0, 0.0}},
                                               {"OS1-32", {3.142, 3.142}, {10.0, 10.0}},
                                               {"OS1-64", {3.142, 3.142}, {10.0, 10.0}},
                                               {"OS1-128", {3.142, 3.142}, {10.0, 10.0}},
                                               {"Livox-Mid-40", {0.5236, 4.887}, {0.0, 0.0}},
                                               {"Livox-Mid-70", {0.5236, 4.887}, {0.0, 0.0}},
                                               {"Livox-Avia", {0.5236, 4.887}, {0.0, 0.0}},
                                               {"Livox-Horizon", {4.887, 0.5236}, {0.0, 0.0}},
                                               {"Livox-Tele-15", {0.3491, 2.0944}, {0.0, 0.0}},
                                               {"HDL-64E-S1", {2.0, 2.0}, {0.0, 0.0}},
                                               {"HDL-64E-S2", {2.0, 2.0}, {0.0, 0.0}},
                                               {"HDL-64E-S3-unit-2", {2.0, 2.0}, {0.0, 0.0}},
                                               {"OS0-32-U0", {6.109, 6.109}, {0.0, 0.0}},
                                               {"OS1-32-U0", {3.142, 3.142}, {10.0, 10.0}},
                                               {"OS1-64-AH", {3.142, 3.142}, {10.0, 10.0}},
                                               {"OS1-64-gen1", {2.269, 2.269}, {0.0, 0.0}},
                                               {"OS1-16-gen1", {2.269, 2.269}, {0.0, 0.0}},
                                               {"LMS111", {15.0, 15.0}, {8.0, 8.0}},
                                               {"LMS151", {15.0, 15.0}, {8.0, 8.0}},
                                               {"LMS511-HR", {4.5, 4.5}, {13.6, 13.6}},
                                               {"LMS511-SR", {11.9, 11.9}, {13.6, 13.6}},
                                               {"TiM781", {14.4, 8.6}, {7.0, 7.0}}})) {
    sheets[beam.name] = beam;
  }
  for (const SensorPreset& one : sensor_presets()) {
    const std::string& name = one.name;
    SCOPED_TRACE(name);
    const Sensor sensor = load_sensor_file(one.reference);
    ASSERT_EQ(sensor.footprint.has_value(), sheets.contains(name));
    if (!sensor.footprint) continue;
    const Beam& beam = sheets[name];
    const bool is_sick = name.starts_with("TiM") || name.starts_with("LMS");  // object sizes
    const double unit = 1e-3 * (is_sick ? 1.0 : kPerFwhm);
    EXPECT_NEAR(sensor.footprint->divergence_x_rad, beam.divergence_mrad[0] * unit, 5e-6);
    EXPECT_NEAR(sensor.footprint->divergence_y_rad, beam.divergence_mrad[1] * unit, 5e-6);
    EXPECT_NEAR(sensor.footprint->exit_x_m, beam.exit_mm[0] * unit, 1e-5);
    EXPECT_NEAR(sensor.footprint->exit_y_m, beam.exit_mm[1] * unit, 1e-5);
    EXPECT_EQ(sample_footprint(*sensor.footprint).size(), 7U);
  }
}

TEST(Presets, AreFoundInCapitalsOrNot) {
  EXPECT_EQ(preset("vlp-16").name, "Velodyne VLP-16");
  EXPECT_EQ(preset("LIVOX-AVIA").name, "Livox Avia");
}

TEST(Presets, UnknownNamesAreToldTheNearest) {
  const std::string error = error_text([&] { preset("VLP-61"); });
  EXPECT_NE(error.find("did you mean VLP-"), std::string::npos) << error;
}

TEST(Presets, NumbersFromMemoryAreMarked) {
  const Datasheet datasheet = load_datasheet(find_sensor_file("D435"));
  std::map<std::string, bool> verified;
  for (const DatasheetEntry& entry : datasheet.entries) verified[entry.key] = entry.verified;
  EXPECT_FALSE(verified.at("limits.near_m"));  // by "limits"
  EXPECT_TRUE(verified.at("optics.fx"));
  EXPECT_TRUE(verified.at("name"));
}

TEST(Presets, SourcesStandBesideTheirNumbers) {
  const Datasheet datasheet = load_datasheet(find_sensor_file("OS1-64"));
  std::map<std::string, std::string> source;
  for (const DatasheetEntry& entry : datasheet.entries) source[entry.key] = entry.source;
  EXPECT_TRUE(source.at("rate_hz").starts_with("10 with 512"));
  EXPECT_EQ(source.at("wavelength_nm"), "data sheet, revision 6");
  EXPECT_TRUE(source.at("lidar_equation.reference_range_m").ends_with("every second time"));
  EXPECT_TRUE(source.at("lidar_equation.range90_m").ends_with("nine times of ten"));
  EXPECT_TRUE(source.at("noise[1].k_m").starts_with("OS1 data sheet, first generation: 1.5"));
  EXPECT_TRUE(source.at("noise[1].floor_m").starts_with("ouster-sdk"));
  EXPECT_EQ(source.at("noise[3].step_m"), "data sheet, revision 6: 1 mm");
}

TEST(Presets, CountTheValuesThatTheManufacturerBacks) {
  const Datasheet datasheet{.name = "a",
                            .sensor = {},
                            .entries = {{"name", "A 1", "", true},
                                        {"optics.type", "pinhole", "data sheet", true},
                                        {"optics.fx", "400", "factory calibration", true},
                                        {"rate_hz", "30", "data sheet", true},
                                        {"limits.far_m", "9", "a survey", false}}};
  EXPECT_EQ(count_values(datasheet).backed, 2U);
  EXPECT_EQ(count_values(datasheet).total, 3U);  // a name and a type are no values
}

TEST(Presets, DoNotCallAThirdPartysNumberTheManufacturers) {
  for (const SensorPreset& one : sensor_presets()) {
    for (const DatasheetEntry& entry : load_datasheet(one.reference).entries) {
      if (!entry.verified || entry.key.ends_with("type") || entry.key.ends_with("kind")) continue;
      for (const char* third_party :
           {"HELIOS", "LISA", "elevation_mapping", "IsaacSim", "recording (", "recording of"}) {
        EXPECT_FALSE(entry.source.starts_with(third_party)) << one.name << " " << entry.key;
      }
    }
  }
}

TEST(Presets, OfRealDepthCamerasHaveSquarePixels) {
  constexpr double kCalibrationSpread = 3e-4;  // fx and fy of one unit, both estimated
  for (const SensorPreset& one : sensor_presets()) {
    const Sensor sensor = load_sensor_file(one.reference);
    const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
    if (pinhole == nullptr) continue;
    const PinholeIntrinsics& k = pinhole->intrinsics;
    EXPECT_NEAR(k.fx / k.fy, 1.0, kCalibrationSpread) << one.name;
  }
}

TEST(Presets, HaveThePublishedCalibrationsOfStereoCameras) {
  const auto stereo = [](const char* name) { return std::get<Stereo>(preset(name).noise.at(0)); };
  EXPECT_NEAR(stereo("D435").focal_px, 430.14, 0.005);
  EXPECT_NEAR(stereo("D435").baseline_m, 0.05015, 5e-6);
  EXPECT_NEAR(stereo("D415").focal_px, 443.9, 0.05);
  EXPECT_NEAR(stereo("D415").baseline_m, 0.0548, 5e-5);
  for (const char* name : {"D435", "D415"}) {
    const Sensor sensor = preset(name);
    EXPECT_EQ(std::get<Pinhole>(sensor.optics).intrinsics.fx, stereo(name).focal_px);
  }
}

TEST(Presets, OfTheWideAzureKinectSeeNothingBeyondItsMetricRadius) {
  const Sensor sensor = preset("Azure-Kinect-WFOV-2x2");
  const Beams beams = make_beams(sensor);
  double widest_rad = 0.0;
  std::size_t without = 0;
  for (const Eigen::Vector3d& d : beams.directions) {
    if (std::isnan(d.x())) {
      ++without;
    } else {
      widest_rad = std::max(widest_rad, std::acos(d.z()));
    }
  }
  EXPECT_NEAR(widest_rad, std::atan(1.74), 2e-3);  // half a pixel
  // a disc in its square: the corners are 1 - pi / 4 of it
  EXPECT_NEAR(static_cast<double>(without), 0.2146 * static_cast<double>(beams.size()), 1500.0);
  EXPECT_TRUE(std::isnan(beams.directions.front().x()));
}

TEST(Presets, LimitsOfScannersAreAlongTheBeam) {
  EXPECT_EQ(preset("VLP-16").limits.along, Limits::Along::range);
  EXPECT_EQ(preset("D435").limits.along, Limits::Along::depth);
  EXPECT_DOUBLE_EQ(preset("OS1-128").wavelength_m, 865e-9);
}

}  // namespace
}  // namespace glidar
