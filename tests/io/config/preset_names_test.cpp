// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/preset_names.hpp>

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>

#include <map>

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
}  // namespace glidar
