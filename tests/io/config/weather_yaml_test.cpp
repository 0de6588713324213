// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_file.hpp>

#include <gtest/gtest.h>
#include <io/yaml_files.hpp>

namespace glidar {
namespace {

const std::string kPulsed =
    "optics: {width: 4, height: 2, fov_deg: 20}\n"
    "wavelength_nm: 905\n"
    "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n";

const std::string kEvery =
    "{visibility_m: 200, visibility_kind: mor, fog_model: kruse, fog_backscatter_per_sr: 0.092, "
    "fog_looks: 4, rain_mm_per_h: 12, rain_model: goodin, snow_mm_per_h: 3, snow_model: "
    "sekhon_srivastava, "
    "min_signal: 0.2}";

Weather weather(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kPulsed + "weather: " + map + "\n")).weather;
}

TEST(WeatherYaml, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kPulsed)).weather.has_value());
}

TEST(WeatherYaml, GivesEveryNumberAndModel) {
  const Weather read = weather(kEvery);
  EXPECT_EQ(read.visibility_m, 200.0);
  EXPECT_EQ(read.visibility_kind, Weather::Visibility::mor);
  EXPECT_EQ(read.fog_model, Weather::FogModel::kruse);
  EXPECT_EQ(read.fog_backscatter_per_sr, 0.092);
  EXPECT_EQ(read.fog_looks, 4U);
  EXPECT_EQ(read.rain_mm_per_h, 12.0);
  EXPECT_EQ(read.rain_model, Weather::RainModel::goodin);
  EXPECT_EQ(read.snow_mm_per_h, 3.0);
  EXPECT_EQ(read.snow_model, Weather::SnowModel::sekhon_srivastava);
  EXPECT_EQ(read.min_signal, 0.2);
}

TEST(WeatherYaml, IsClearByDefault) {
  const Weather read = weather("{}");
  EXPECT_EQ(extinction_per_m(read, 905e-9), 0.0);
  EXPECT_EQ(read.visibility_kind, Weather::Visibility::contrast);
  EXPECT_EQ(read.fog_model, Weather::FogModel::kim);
  EXPECT_EQ(read.rain_model, Weather::RainModel::geometric);
  EXPECT_EQ(read.snow_model, Weather::SnowModel::gunn_marshall);
}

TEST(WeatherYaml, ComesBackInTheSidecarAsTheFileSaysIt) {
  const nlohmann::ordered_json reported = write_struct(FieldVisitor::Mode::report, weather(kEvery));
  EXPECT_EQ(
      reported.dump(),
      R"({"visibility_m":200.0,"visibility_kind":"mor","fog_model":"kruse",)"
      R"("fog_backscatter_per_sr":0.092,"fog_looks":4,"rain_mm_per_h":12.0,"rain_model":"goodin",)"
      R"("snow_mm_per_h":3.0,"snow_model":"sekhon_srivastava","min_signal":0.2})");
}

class WeatherYamlError : public ::testing::TestWithParam<BadFile> {};

TEST_P(WeatherYamlError, NamesPlaceFieldAndWhatIsAllowed) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

const BadFile kBadFiles[] = {
    {"UnknownKey", kPulsed + "weather: {rain: 3}\n",
     "s.yaml:4:11: weather.rain: unknown key 'rain'; allowed: visibility_m, visibility_kind, "
     "fog_model, fog_backscatter_per_sr, fog_looks, rain_mm_per_h, rain_model, snow_mm_per_h, "
     "snow_model, min_signal; did you mean 'rain_mm_per_h'?"},
    {"MisspeltKey", kPulsed + "weather: {visiblity_m: 3}\n",
     "s.yaml:4:11: weather.visiblity_m: unknown key 'visiblity_m'; allowed: visibility_m, "
     "visibility_kind, fog_model, fog_backscatter_per_sr, fog_looks, rain_mm_per_h, rain_model, "
     "snow_mm_per_h, snow_model, min_signal; did you mean 'visibility_m'?"},
    {"VisibilityOfCentimetres", kPulsed + "weather: {visibility_m: 0.3}\n",
     "s.yaml:4:25: weather.visibility_m: 0.3; allowed: metres from 1 to 1e6, or 0 for clear air"},
    {"HalfALook", kPulsed + "weather: {fog_looks: 1.5}\n",
     "s.yaml:4:22: weather.fog_looks: 1.5; allowed: a whole number from 0 to 64"},
    {"TooManyLooks", kPulsed + "weather: {fog_looks: 65}\n",
     "s.yaml:4:22: weather.fog_looks: 65; allowed: a whole number from 0 to 64"},
    {"NegativeRain", kPulsed + "weather: {rain_mm_per_h: -1}\n",
     "s.yaml:4:26: weather.rain_mm_per_h: -1; allowed: mm/h from 0 to 1000"},
    {"UnknownModel", kPulsed + "weather: {fog_model: kin}\n",
     "s.yaml:4:22: weather.fog_model: 'kin'; allowed: kim, kruse; did you mean 'kim'?"},
    {"NoPulsedLight", "optics: {width: 4, height: 2, fov_deg: 20}\nweather: {rain_mm_per_h: 1}\n",
     "s.yaml:2:10: weather: given without 'lidar_equation'; allowed: weather for a sensor with "
     "pulsed "
     "light; add 'lidar_equation: ...'"},
    {"NoWavelength",
     "optics: {width: 4, height: 2, fov_deg: 20}\n"
     "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n"
     "weather: {visibility_m: 100}\n",
     "s.yaml:3:10: weather: a visibility without 'wavelength_nm', on which fog's extinction "
     "depends; allowed: fog for light of a known wavelength; add 'wavelength_nm: ...'"},
};

INSTANTIATE_TEST_SUITE_P(All, WeatherYamlError, ::testing::ValuesIn(kBadFiles), bad_file_name);

}  // namespace
}  // namespace glidar
