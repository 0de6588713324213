// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_family.hpp>

#include <glidar/io/config/sensor_presets.hpp>

#include <io/yaml_files.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace glidar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kFamily = R"(name: Maker
rate_hz: 10
limits: {near_m: 1, far_m: 50}
optics: {type: spinning, columns_per_turn: 100, elevation_deg: [2, 1]}
noise:
  - {type: range_gaussian, sigma_m: 0.1}
  - {type: range_quantization, step_m: 0.01}
source: {rate_hz: manual, limits: table, optics: manual}
unverified: [limits]
default_mode: slow
modes:
  slow: {}
  fast: {rate_hz: 20, source: {rate_hz: driver}}
  wide-1: {optics: {columns_per_turn: 400}}
variants:
  One:
    name: Maker One
    aliases: [the one]
  Two-B:
    limits: {far_m: 90}
    optics: {elevation_deg: [5, 4, 3]}
    noise: [{type: range_gaussian, sigma_m: 0.2}]
    source: {limits.far_m: letter}
    unverified: [optics.elevation_deg]
    modes: {fast: null, wide-1: {optics: {columns_per_turn: 800}}, slow: {limits: {near_m: 2}}}
)";

/// The sensor of a text with such variants and modes.
class Family : public ::testing::Test {
 protected:
  Sensor load(const std::string& variant, const std::string& mode = "") {
    return load_sensor_file({.file = file_, .variant = variant, .mode = mode});
  }
  std::string error(const std::string& variant, const std::string& mode = "") {
    return error_of(folder_, [&] { load(variant, mode); });
  }
  std::map<std::string, DatasheetEntry> entries(const std::string& variant,
                                                const std::string& mode = "") {
    std::map<std::string, DatasheetEntry> found;
    for (const DatasheetEntry& entry :
         load_datasheet({.file = file_, .variant = variant, .mode = mode}).entries) {
      found[entry.key] = entry;
    }
    return found;
  }
  void write(const std::string& content) { file_ = folder_.write("f.yaml", content); }

  TestFolder folder_;
  std::filesystem::path file_ = folder_.write("f.yaml", kFamily);
};

const Spinning& spinning(const Sensor& sensor) {
  return std::get<Spinning>(sensor.optics);
}

TEST_F(Family, AVariantReplacesScalarsAndListsAndKeepsTheOtherKeys) {
  const Sensor one = load("One");
  EXPECT_EQ(one.name, "Maker One");
  EXPECT_EQ(one.limits.far_m, 50.0);
  EXPECT_EQ(spinning(one).channels.size(), 2U);
  EXPECT_EQ(one.noise.size(), 2U);
  const Sensor two = load("Two-B", "wide-1");
  EXPECT_EQ(two.name, "Maker");
  EXPECT_EQ(two.limits.near_m, 1.0);
  EXPECT_EQ(two.limits.far_m, 90.0);
  EXPECT_EQ(spinning(two).channels.size(), 3U);
  EXPECT_EQ(two.noise.size(), 1U);
}

TEST_F(Family, AModeIsMergedOverTheVariant) {
  EXPECT_EQ(load("One").rate_hz, 10.0);
  EXPECT_EQ(load("One", "fast").rate_hz, 20.0);
  EXPECT_EQ(spinning(load("One", "fast")).rotation_hz, 20.0);
  EXPECT_EQ(spinning(load("One", "wide-1")).columns_per_turn, 400U);
  EXPECT_EQ(spinning(load("Two-B", "wide-1")).columns_per_turn, 800U);
}

TEST_F(Family, WithoutAModeTheDefaultOneIsUsed) {
  EXPECT_EQ(load("Two-B").mode, "slow");
  EXPECT_EQ(load("Two-B").limits.near_m, 2.0);
  EXPECT_EQ(load("Two-B", "wide-1").limits.near_m, 1.0);
  write("optics: {width: 4, height: 3, fov_deg: 20}\nmodes: {a: {rate_hz: 5}}\n");
  EXPECT_EQ(load("").mode, "");
  EXPECT_EQ(load("").rate_hz, 30.0);
  EXPECT_EQ(load("", "a").rate_hz, 5.0);
}

TEST_F(Family, TheSensorRecordsItsVariantAndModeAsTheFileSpellsThem) {
  const Sensor sensor = load("two b", "WIDE_1");
  EXPECT_EQ(sensor.variant, "Two-B");
  EXPECT_EQ(sensor.mode, "wide-1");
  EXPECT_THAT(sensor.files, ElementsAre(file_.string()));
}

TEST_F(Family, SourcesAreMergedByKeyAndListsOfUnverifiedKeysAreReplaced) {
  auto two = entries("Two-B", "wide-1");
  EXPECT_EQ(two.at("limits.near_m").source, "table");
  EXPECT_EQ(two.at("limits.far_m").source, "letter");
  EXPECT_TRUE(two.at("limits.near_m").verified);
  EXPECT_FALSE(two.at("optics.elevation_deg").verified);
  EXPECT_FALSE(entries("One").at("limits.near_m").verified);
  EXPECT_EQ(entries("One").at("rate_hz").source, "manual");
  EXPECT_EQ(entries("One", "fast").at("rate_hz").source, "driver");
}

TEST_F(Family, TheDatasheetListsAliasesAndModesAndNoKeysOfTheFamily) {
  const Datasheet one = load_datasheet({.file = file_, .variant = "One"});
  EXPECT_EQ(one.name, "One");
  EXPECT_THAT(one.aliases, ElementsAre("the one"));
  EXPECT_THAT(one.modes, ElementsAre("slow", "fast", "wide-1"));
  EXPECT_EQ(one.default_mode, "slow");
  for (const DatasheetEntry& entry : one.entries) {
    EXPECT_THAT(entry.key, ::testing::Not(HasSubstr("mode")));
    EXPECT_THAT(entry.key, ::testing::Not(HasSubstr("alias")));
  }
  EXPECT_THAT(load_datasheet({.file = file_, .variant = "Two-B"}).modes,
              ElementsAre("slow", "wide-1"));
}

TEST_F(Family, OneAnchorInSeveralVariantsGivesEachItsOwnValues) {
  write(
      "optics: &o {width: 4, height: 3, fov_deg: 20}\n"
      "variants: {A: {optics: {width: 8}}, B: {}, C: {optics: *o}}\n");
  EXPECT_EQ(std::get<Pinhole>(load("A").optics).intrinsics.width, 8U);
  EXPECT_EQ(std::get<Pinhole>(load("B").optics).intrinsics.width, 4U);
  EXPECT_EQ(std::get<Pinhole>(load("C").optics).intrinsics.width, 4U);
}

TEST_F(Family, PathsInOverridesAreSeenFromTheFolderOfTheFile) {
  (void)folder_.write("rays.csv", "Time/s,Azimuth/deg,Zenith/deg\n0.1,0,90\n0.2,90,60\n");
  write(
      "optics: {type: table, file: missing.csv}\nvariants: {A: {optics: {file: "
      "rays.csv}}}\n");
  EXPECT_EQ(std::get<RayTable>(load("A").optics).directions.size(), 2U);
}

TEST_F(Family, UnknownVariantsAndModesAreErrorsThatListThem) {
  EXPECT_EQ(error(""),
            "f.yaml: it is a family of sensors; allowed: one of its variants: One, "
            "Two-B; choose one: 'f.yaml#One'");
  EXPECT_EQ(error("Two-C"),
            "f.yaml: 'Two-C' is none of its variants; allowed: One, Two-B; did you mean 'Two-B'?");
  EXPECT_EQ(error("One", "fats"),
            "mode: 'fats' is no mode of Maker One; allowed: slow, fast, wide-1; did you mean "
            "'fast'?");
  EXPECT_EQ(error("Two-B", "fast"), "mode: 'fast' is no mode of Maker; allowed: slow, wide-1");
  write("optics: {width: 4, height: 3, fov_deg: 20}\n");
  EXPECT_EQ(error("A"),
            "f.yaml: it has no variants, but 'A' is requested; allowed: the file without '#A'");
  EXPECT_EQ(error("", "fast"),
            "mode: 'fast', but f.yaml has no modes; allowed: a sensor with "
            "modes; leave the mode out");
}

struct BadFamily {
  const char* name;
  const char* content;  ///< after a complete document of one line
  const char* variant;
  const char* mode;
  const char* error;
};

void PrintTo(const BadFamily& bad, std::ostream* out) {
  *out << bad.name;
}

constexpr std::array kBadFamilies = std::to_array<BadFamily>({
    {"AWrongValueOfAVariant", "variants: {A: {rate_hz: x}}", "A", "",
     "f.yaml:2:25: rate_hz (variant A): 'x'; allowed: a finite number above 0"},
    {"AWrongKeyOfAMode", "modes:\n  m: {optics: {widht: 3}}", "", "m",
     "f.yaml:3:16: optics.widht (mode m): unknown key 'widht'"},
    {"AWrongValueOfTheDocument", "rate_hz: x\nvariants: {A: {}}\nmodes: {m: {}}", "A", "m",
     "f.yaml:2:10: rate_hz (variant A, mode m): 'x'"},
    {"AKeyToRemoveThatDoesNotExist", "variants: {A: {optics: {cx: null}}}", "A", "",
     "f.yaml:2:25: variants.A.optics.cx: no value, which removes the key"},
    {"AKeyGivenTwiceInAVariant", "variants: {A: {rate_hz: 1, rate_hz: 2}}", "A", "",
     "f.yaml:2:28: variants.A.rate_hz: the key is given twice"},
    {"AVariantThatIsNoMap", "variants: {A: 3}", "A", "", "f.yaml:2:15: variants.A: 3;"},
    {"VariantsThatAreNoMap", "variants: [A]", "A", "", "f.yaml:2:11: variants: a list of 1"},
    {"NoVariants", "variants: {}", "", "", "f.yaml:2:11: variants: a map; allowed: at least one"},
    {"NamesThatAreEqual", "variants: {A-1: {}, a1: {}}", "a1", "",
     "f.yaml:2:25: variants.a1: the name equals 'A-1'"},
    {"AModeNameWithoutLetters", "modes: {'-': {}}", "", "", "f.yaml:2:14: modes.-: '-'; allowed"},
    {"ADefaultThatIsNoMode", "modes: {a: {}}\ndefault_mode: b", "", "",
     "f.yaml:3:15: default_mode: 'b'; allowed: a"},
    {"ADefaultWithoutModes", "default_mode: b", "", "",
     "f.yaml:2:15: default_mode: given without 'modes'"},
    {"AliasesOfAFamily", "aliases: [b]\nvariants: {A: {}}", "A", "",
     "f.yaml:2:10: aliases: aliases of a family; allowed: 'aliases' in each of its variants"},
    {"AliasesThatAreNoList", "aliases: b", "", "", "f.yaml:2:10: aliases: 'b'; allowed: a list"},
});

class FamilyError : public ::testing::TestWithParam<BadFamily> {};

TEST_P(FamilyError, NamesThePlaceTheVariantAndTheMode) {
  const BadFamily& bad = GetParam();
  const TestFolder folder;
  const auto file = folder.write(
      "f.yaml", std::string("optics: {width: 4, height: 3, fov_deg: 20}\n") + bad.content + "\n");
  const std::string error = error_of(
      folder, [&] { load_sensor_file({.file = file, .variant = bad.variant, .mode = bad.mode}); });
  EXPECT_TRUE(error.starts_with(bad.error)) << error;
}

INSTANTIATE_TEST_SUITE_P(All, FamilyError, ::testing::ValuesIn(kBadFamilies),
                         [](const auto& one) { return std::string(one.param.name); });

TEST_F(Family, AVariantIsChosenBehindTheNameOfItsFile) {
  const SensorReference found = find_sensor_file(file_.string() + "#One", "fast");
  EXPECT_EQ(found.file, file_);
  EXPECT_EQ(found.variant, "One");
  EXPECT_EQ(found.mode, "fast");
  EXPECT_THAT(error_of(folder_, [&] { find_sensor_file(file_.string() + "#"); }),
              HasSubstr("has no variant after '#'; allowed: FILE#VARIANT"));
  const auto odd = folder_.write("a#b.yaml", "optics: {width: 4, height: 3, fov_deg: 20}\n");
  EXPECT_EQ(find_sensor_file(odd.string()).file, odd);
}

/// `count` variants, the last one with the key rate_hz.
std::string many_variants(int count) {
  std::string text = "{optics: {width: 4, height: 3, fov_deg: 20}, variants: {";
  for (int i = 0; i < count; ++i) text += "v" + std::to_string(i) + ": {rate_hz: 7}, ";
  return text + "}}";
}

TEST_F(Family, HasAtMost1000Variants) {
  const auto most = folder_.write("most.yaml", many_variants(1000));
  EXPECT_EQ(load_sensor_file({.file = most, .variant = "v999"}).rate_hz, 7.0);
  const auto more = folder_.write("more.yaml", many_variants(1001));
  EXPECT_THAT(error_of(folder_, [&] { load_sensor_file({.file = more, .variant = "v1"}); }),
              HasSubstr("1001 names; allowed: at most 1000"));
}

TEST_F(Family, ManyKeysAreMergedByName) {
  std::string keys;
  for (int i = 0; i < 20'000; ++i) keys += "k" + std::to_string(i) + ": 1, ";
  const auto file =
      folder_.write("keys.yaml", "{" + keys + "variants: {a: {" + keys + "k: null}}}");
  EXPECT_THAT(error_of(folder_, [&] { load_sensor_file({.file = file, .variant = "a"}); }),
              HasSubstr("variants.a.k: no value, which removes the key"));
}

TEST(ParseSensor, ReadsTheDefaultModeOfAText) {
  const std::string text =
      "{optics: {width: 4, height: 3, fov_deg: 20}, modes: {a: {rate_hz: 7}}, default_mode: a}";
  EXPECT_EQ(parse_sensor(text).rate_hz, 7.0);
}

}  // namespace
}  // namespace glidar
