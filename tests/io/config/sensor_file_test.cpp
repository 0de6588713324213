// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_file.hpp>

#include <support/source_folder.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Sensor load(const std::string& content) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", content));
}

PinholeIntrinsics intrinsics(const std::string& optics) {
  return std::get<Pinhole>(load("optics: {" + optics + "}\n").optics).intrinsics;
}

Distortion distortion(const std::string& content) {
  return std::get<Pinhole>(
             load("optics: {width: 4, height: 2, fov_deg: 20, distortion: {" + content + "}}\n")
                 .optics)
      .distortion;
}

TEST(SensorFile, ReadsEveryKey) {
  const Sensor sensor = load(R"(
name: test camera
optics:
  type: pinhole
  width: 640
  height: 480
  fx: 500.5
  fy: 501
  cx: 319.25
  cy: 240
  pixel_centre: 0
  distortion: {model: radial_tangential, k1: 1, k2: 2, p1: 3, p2: 4, k3: 5, k4: 6, k5: 7, k6: 8}
limits: {near_m: 0.1, far_m: 1000}
light: {attenuation: {constant: 2, linear_per_m: 3.0e-4, quadratic_per_m2: 4e-8}, ambient: 0.5}
cull_back_faces: true
)");
  EXPECT_EQ(sensor.name, "test camera");
  const auto& pinhole = std::get<Pinhole>(sensor.optics);
  EXPECT_EQ(pinhole.intrinsics.width, 640U);
  EXPECT_EQ(pinhole.intrinsics.height, 480U);
  EXPECT_EQ(pinhole.intrinsics.fx, 500.5);
  EXPECT_EQ(pinhole.intrinsics.fy, 501.0);
  EXPECT_EQ(pinhole.intrinsics.cx, 319.25);
  EXPECT_EQ(pinhole.intrinsics.cy, 240.0);
  EXPECT_EQ(pinhole.intrinsics.pixel_centre, 0.0);
  const auto& k = std::get<RadialTangential>(pinhole.distortion);
  EXPECT_EQ((std::array{k.k1, k.k2, k.p1, k.p2, k.k3, k.k4, k.k5, k.k6}),
            (std::array<double, 8>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(sensor.limits.near_m, 0.1);
  EXPECT_EQ(sensor.limits.far_m, 1000.0);
  EXPECT_EQ(sensor.light.attenuation_constant, 2.0);
  EXPECT_EQ(sensor.light.attenuation_linear_per_m, 3.0e-4);
  EXPECT_EQ(sensor.light.attenuation_quadratic_per_m2, 4e-8);
  EXPECT_EQ(sensor.light.ambient, 0.5);
  EXPECT_TRUE(sensor.cull_back_faces);
}

TEST(SensorFile, DefaultsAreThoseOfTheStructs) {
  const Sensor sensor = load("optics: {width: 3, height: 2, fov_deg: 20}\n");
  const Sensor plain;
  EXPECT_EQ(sensor.name, plain.name);
  EXPECT_EQ(sensor.limits.near_m, plain.limits.near_m);
  EXPECT_EQ(sensor.limits.far_m, std::numeric_limits<double>::infinity());
  EXPECT_EQ(sensor.light.attenuation_constant, plain.light.attenuation_constant);
  EXPECT_EQ(sensor.light.attenuation_linear_per_m, plain.light.attenuation_linear_per_m);
  EXPECT_EQ(sensor.light.attenuation_quadratic_per_m2, plain.light.attenuation_quadratic_per_m2);
  EXPECT_EQ(sensor.light.ambient, plain.light.ambient);
  EXPECT_FALSE(sensor.cull_back_faces);
  const auto& pinhole = std::get<Pinhole>(sensor.optics);
  EXPECT_EQ(pinhole.intrinsics.pixel_centre, 0.5);
  EXPECT_TRUE(std::holds_alternative<NoDistortion>(pinhole.distortion));
}

TEST(SensorFile, FieldOfViewIsVerticalWithSquarePixels) {
  const PinholeIntrinsics k = intrinsics("width: 640, height: 480, fov_deg: 90");
  EXPECT_NEAR(k.fy, 240.0, 1e-12);
  EXPECT_EQ(k.fx, k.fy);
  EXPECT_EQ(k.cx, 320.0);
  EXPECT_EQ(k.cy, 240.0);
}

TEST(SensorFile, HorizontalFieldOfViewSpansTheWidth) {
  const PinholeIntrinsics k = intrinsics("width: 640, height: 480, fov_x_deg: 90");
  EXPECT_NEAR(k.fx, 320.0, 1e-12);
  EXPECT_EQ(k.fx, k.fy);
  EXPECT_EQ(k.cx, 320.0);
  EXPECT_EQ(k.cy, 240.0);
}

TEST(SensorFile, MiddleOfTheImageFollowsThePixelCentre) {
  for (const char* focal : {"fov_deg: 20", "fov_x_deg: 20", "fx: 100, fy: 100"}) {
    const std::string optics = std::string("width: 640, height: 481, ") + focal;
    EXPECT_EQ(intrinsics(optics).cx, 320.0);
    EXPECT_EQ(intrinsics(optics).cy, 240.5);
    EXPECT_EQ(intrinsics(optics + ", pixel_centre: 0").cx, 319.5);
    EXPECT_EQ(intrinsics(optics + ", pixel_centre: 0").cy, 240.0);
  }
}

TEST(SensorFile, SizesReachTheirLimits) {
  EXPECT_EQ(intrinsics("width: 1, height: 65536, fov_deg: 20").height, 65536U);
  EXPECT_EQ(intrinsics("width: 6.5536e4, height: 1, fov_deg: +20").width, 65536U);
}

TEST(SensorFile, DistortionModels) {
  EXPECT_TRUE(std::holds_alternative<NoDistortion>(distortion("model: none")));
  const auto fisheye = std::get<Fisheye>(distortion("model: fisheye, k1: 1, k2: 2, k3: 3, k4: 4"));
  EXPECT_EQ((std::array{fisheye.k1, fisheye.k2, fisheye.k3, fisheye.k4}),
            (std::array<double, 4>{1, 2, 3, 4}));
  const auto radial = std::get<RadialTangential>(distortion("model: radial_tangential, p2: -0.5"));
  EXPECT_EQ(radial.p2, -0.5);
  EXPECT_EQ(radial.k1, 0.0);
}

TEST(SensorFile, WindowsLineEndsAndByteOrderMark) {
  EXPECT_EQ(load("\xEF\xBB\xBFname: a\r\noptics: {width: 4, height: 2, fov_deg: 20}\r\n").name,
            "a");
}

TEST(SensorFile, Woods2016CameraHasThePapersNumbers) {
  const Sensor sensor =
      load_sensor_file(std::filesystem::path(kSourceFolder) / "sensors/woods2016-256.yaml");
  const PinholeIntrinsics k = std::get<Pinhole>(sensor.optics).intrinsics;
  EXPECT_EQ(k.width, 256U);
  EXPECT_EQ(k.height, 256U);
  EXPECT_NEAR(2.0 * std::atan(128.0 / k.fy) * 180.0 / std::numbers::pi, 20.0, 1e-12);
  EXPECT_EQ(sensor.light.attenuation_constant, 1.0);
  EXPECT_EQ(sensor.light.attenuation_linear_per_m, 1e-4);
  EXPECT_EQ(sensor.light.attenuation_quadratic_per_m2, 1e-8);
  EXPECT_EQ(sensor.light.ambient, 0.2);
}

class SensorFileError : public ::testing::TestWithParam<BadFile> {};

TEST_P(SensorFileError, NamesPlaceFieldAndCure) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

std::string optics(const std::string& content) {
  return "optics: {" + content + "}\n";
}
std::string with_good_optics(const std::string& rest) {
  return "optics: {width: 4, height: 2, fov_deg: 20}\n" + rest;
}

const std::string kFocal = "one of fov_deg, fov_x_deg, or fx with fy";
const std::string kSide = "a whole number from 1 to 65536";

const BadFile kBadFiles[] = {
    {"UnknownKey", "optics:\n  widht: 4\n",
     "s.yaml:2:3: optics.widht: unknown key 'widht'; allowed: type, calibration_file, width, "
     "height, fov_deg, "
     "fov_x_deg, fx, fy, cx, cy, pixel_centre, skew, distortion; did you mean 'width'?"},
    {"UnknownKeyFarFromAny", with_good_optics("zzzzzzzzz: 1\n"),
     "s.yaml:2:1: zzzzzzzzz: unknown key 'zzzzzzzzz'; allowed: name, optics, rate_hz, "
     "wavelength_nm, limits, light, lidar_equation, footprint, receiver, weather, "
     "projector_origin_m, doppler, noise, depth_model, depth_camera, cull_back_faces, "
     "source, "
     "unverified, notes, variants, modes, default_mode, aliases"},
    {"DuplicateKey", optics("width: 4, height: 2, width: 5, fov_deg: 20"),
     "s.yaml:1:31: optics.width: the key is given twice; allowed: each key once; remove one of "
     "them"},
    {"MissingOptics", "name: a\n", "s.yaml:1:1: the key 'optics' is missing; add 'optics: ...'"},
    {"MissingWidth", optics("height: 2, fov_deg: 20"),
     "s.yaml:1:9: optics: the key 'width' is missing; add 'width: ...'"},
    {"MissingFy", optics("width: 4, height: 2, fx: 3"),
     "s.yaml:1:35: optics.fx: given without 'fy'; allowed: one of fov_deg, fov_x_deg, or fx with "
     "fy; add 'fy: ...'"},
    {"NoFocalLength", optics("width: 4, height: 2"),
     "s.yaml:1:9: optics: the focal length is missing; allowed: " + kFocal +
         "; add 'fov_deg: ...'"},
    {"FovBesideFx", optics("width: 4, height: 2, fov_deg: 20, fx: 3, fy: 3"),
     "s.yaml:1:48: optics.fx: given beside 'fov_deg'; allowed: " + kFocal + "; remove one of them"},
    {"TwoFovs", optics("width: 4, height: 2, fov_x_deg: 20, fov_deg: 20"),
     "s.yaml:1:42: optics.fov_x_deg: given beside 'fov_deg'; allowed: " + kFocal +
         "; remove one of them"},
    {"CxBesideFov", optics("width: 4, height: 2, fov_deg: 20, cx: 2"),
     "s.yaml:1:48: optics.cx: given beside 'fov_deg'; allowed: fy, cx and cy only together with "
     "fx; remove it, or give fx and fy instead of fov_deg"},
    {"TextForNumber", optics("width: four, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: 'four'; allowed: " + kSide},
    {"NumberWithUnit", optics("width: 4, height: 2, fov_deg: 20deg"),
     "s.yaml:1:40: optics.fov_deg: '20deg'; allowed: degrees above 0 and below 180"},
    {"QuotedNumber", optics("width: \"4\", height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: the text \"4\"; allowed: " + kSide + "; remove the quotes"},
    {"MapForNumber", optics("width: {}, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: a map; allowed: " + kSide},
    {"ListForNumber", optics("width: [4, 5], height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: a list of 2; allowed: " + kSide},
    {"NoValue", "optics:\n  width:\n  height: 2\n",
     "s.yaml:2:3: optics.width: no value; allowed: " + kSide},
    {"ZeroSize", optics("width: 0, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: 0; allowed: " + kSide},
    {"NegativeSize", optics("width: 4, height: -2, fov_deg: 20"),
     "s.yaml:1:28: optics.height: -2; allowed: " + kSide},
    {"HugeSize", optics("width: 65537, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: 65537; allowed: " + kSide},
    {"FractionOfAPixel", optics("width: 4.5, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: 4.5; allowed: " + kSide},
    {"NotANumber", optics("width: .nan, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: .nan; allowed: " + kSide},
    {"NanByName", optics("width: nan, height: 2, fov_deg: 20"),
     "s.yaml:1:17: optics.width: nan; allowed: " + kSide},
    {"Infinite", with_good_optics("limits: {far_m: .inf}\n"),
     "s.yaml:2:17: limits.far_m: .inf; allowed: a finite number above 0"},
    {"BeyondDouble", with_good_optics("limits: {far_m: 1e999}\n"),
     "s.yaml:2:17: limits.far_m: 1e999; allowed: a finite number above 0"},
    {"FovZero", optics("width: 4, height: 2, fov_deg: 0"),
     "s.yaml:1:40: optics.fov_deg: 0; allowed: degrees above 0 and below 180"},
    {"FovStraight", optics("width: 4, height: 2, fov_x_deg: 180"),
     "s.yaml:1:42: optics.fov_x_deg: 180; allowed: degrees above 0 and below 180"},
    {"FxZero", optics("width: 4, height: 2, fx: 0, fy: 1"),
     "s.yaml:1:35: optics.fx: 0; allowed: pixels above 0 and below 1e9"},
    {"FxBeyondReach", optics("width: 4, height: 2, fx: 1e300, fy: 1"),
     "s.yaml:1:35: optics.fx: 1e300; allowed: pixels above 0 and below 1e9"},
    {"CxBeyondReach", optics("width: 4, height: 2, fx: 1, fy: 1, cx: -1e300"),
     "s.yaml:1:49: optics.cx: -1e300; allowed: pixels from -1e9 to 1e9"},
    {"FovOfNoWidth", optics("width: 4, height: 2, fov_deg: 1e-300"),
     "s.yaml:1:40: optics.fov_deg: 1e-300, a focal length of 1.1459155902616464e+302 pixels; "
     "allowed: a field of view that gives pixels above 0 and below 1e9"},
    {"PixelCentreOne", optics("width: 4, height: 2, fov_deg: 20, pixel_centre: 1"),
     "s.yaml:1:58: optics.pixel_centre: 1; allowed: a number from 0 to below 1; 0.5 and 0 are "
     "usual"},
    {"UnknownOptics", optics("type: pinhoel, width: 4"),
     "s.yaml:1:16: optics.type: 'pinhoel'; allowed: pinhole, spinning, line_scan, prism, "
     "wedge_mirror, table, "
     "ouster; did you mean 'pinhole'?"},
    {"UnknownDistortion", optics("width: 4, height: 2, fov_deg: 20, distortion: {model: fish_eye}"),
     "s.yaml:1:64: optics.distortion.model: 'fish_eye'; allowed: none, radial_tangential, "
     "fisheye, fov, omni, double_sphere, eucm, equirectangular; "
     "did you mean 'fisheye'?"},
    {"DistortionWithoutModel", optics("width: 4, height: 2, fov_deg: 20, distortion: {k1: 1}"),
     "s.yaml:1:56: optics.distortion: the key 'model' is missing; add 'model: ...'"},
    {"DistortionNotAMap", optics("width: 4, height: 2, fov_deg: 20, distortion: none"),
     "s.yaml:1:56: optics.distortion: 'none'; allowed: a map with the key 'model'"},
    {"CoefficientOfAnotherModel",
     optics("width: 4, height: 2, fov_deg: 20, distortion: {model: fisheye, p1: 1}"),
     "s.yaml:1:73: optics.distortion.p1: unknown key 'p1'; allowed: model, k1, k2, k3, k4; did you "
     "mean 'k1'?"},
    {"NearNegative", with_good_optics("limits: {near_m: -1}\n"),
     "s.yaml:2:18: limits.near_m: -1; allowed: a finite number from 0"},
    {"FarBeforeNear", with_good_optics("limits: {near_m: 2, far_m: 1}\n"),
     "s.yaml:2:28: limits.far_m: 1, not beyond near_m; allowed: a finite number above "
     "near_m"},
    {"NoAttenuation",
     with_good_optics("light:\n  attenuation: {constant: 0, linear_per_m: 0, "
                      "quadratic_per_m2: 0}\n"),
     "s.yaml:3:16: light.attenuation: all three are 0; allowed: at least one above 0"},
    {"AmbientNegative", with_good_optics("light: {ambient: -0.1}\n"),
     "s.yaml:2:18: light.ambient: -0.1; allowed: a finite number from 0"},
    {"TwoLights",
     with_good_optics("light: {ambient: 0}\n"
                      "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n"),
     "s.yaml:2:8: light: given beside 'lidar_equation'; allowed: one "
     "of "
     "light, lidar_equation; remove one of them"},
    {"NotABoolean", with_good_optics("cull_back_faces: maybe\n"),
     "s.yaml:2:18: cull_back_faces: 'maybe'; allowed: false, true"},
    {"NameIsAList", with_good_optics("name: [a]\n"),
     "s.yaml:2:7: name: a list of 1; allowed: a text that is not empty"},
    {"NameIsEmpty", with_good_optics("name: \"\"\n"),
     "s.yaml:2:7: name: the text \"\"; allowed: a text that is not empty"},
    {"RateOutOfRange", with_good_optics("rate_hz: 1e15\n"),
     "s.yaml:2:10: rate_hz: 1e+15; allowed: frames per second from 1e-6 to 1e9"},
    {"TooSmallForItsUnit",
     with_good_optics("lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n"
                      "receiver: {pulse_ns: 1e-320}\n"),
     "s.yaml:3:22: receiver.pulse_ns: 1e-320; allowed: nanoseconds above 0, up to 1e6"},
    {"KeyIsAList", "[a, b]: 1\n", "s.yaml:1:1: a key that is no word; allowed: words as keys"},
    {"Empty", "", "s.yaml: the file is empty; allowed: a YAML map (key: value); see docs/files.md"},
    {"OnlyAComment", "# nothing\n",
     "s.yaml: the file is empty; allowed: a YAML map (key: value); see docs/files.md"},
    {"AList", "- a\n", "s.yaml:1:1: a list of 1; allowed: a map (key: value); see docs/files.md"},
    {"AWord", "\n hello\n", "s.yaml:2:2: 'hello'; allowed: a map (key: value); see docs/files.md"},
    {"UnknownAnchor", "name: *nobody\n",
     "s.yaml:1:7: the alias '*nobody' has no anchor; write '&nobody' before the value that it "
     "repeats"},
    {"TwoDocuments", "name: a\n---\nname: b\n",
     "s.yaml:3:1: a second document; allowed: one document in a file; remove the line '---' "
     "before it"},
    {"Binary", std::string("name: a\0b\n", 10), "s.yaml: binary data; allowed: a YAML file"},
    {"DeeplyNestedFlow", std::string(200000, '['),
     "s.yaml:1:1: nested too deeply; allowed: a sensor or scene file"},
    {"HugeFile", std::string((8U << 20U) + 1, ' '),
     "s.yaml: a file of more than 8 MiB; allowed: a YAML file of at most 8 MiB; name models by "
     "their path, do not put them into the file"},
    {"ControlCharactersAreNotPrinted", "\"a\\n\\e\": 1\n",
     "s.yaml:1:1: a?\?: unknown key 'a?\?'; allowed: name, optics, rate_hz, "
     "wavelength_nm, limits, light, lidar_equation, footprint, receiver, weather, "
     "projector_origin_m, doppler, noise, depth_model, depth_camera, cull_back_faces, "
     "source, "
     "unverified, notes, variants, modes, default_mode, aliases"},
};

INSTANTIATE_TEST_SUITE_P(All, SensorFileError, ::testing::ValuesIn(kBadFiles), bad_file_name);

TEST(SensorFile, AListWhereAMapBelongsHasAPlace) {
  const TestFolder folder;
  for (const char* key : {"limits", "light", "lidar_equation", "footprint", "receiver", "weather",
                          "doppler", "depth_camera"}) {
    const auto file = folder.write("s.yaml", with_good_optics(std::string(key) + ": [[1]]\n"));
    EXPECT_THAT(error_of(folder, [&] { load_sensor_file(file); }),
                AllOf(StartsWith("s.yaml:2:"), HasSubstr(key), HasSubstr("allowed: ")));
  }
}

// The words between are those of yaml-cpp, which depend on its version.
TEST(SensorFile, BrokenSyntaxHasAPlaceAndACure) {
  const TestFolder folder;
  const auto error = [&](const std::string& content) {
    const auto file = folder.write("s.yaml", content);
    return error_of(folder, [&] { load_sensor_file(file); });
  };
  const std::string cure = "; indent with spaces, not with tabs";
  EXPECT_THAT(error("optics:\n  width: [1, 2\nheight: 3\n"), StartsWith("s.yaml:3:7: not YAML: "));
  for (const auto& [content, place] :
       {std::pair("optics:\n\twidth: 4\n", "s.yaml:2:7: not YAML: "),
        std::pair("optics:\n  width: 4\n\theight: 4\n", "s.yaml:3:1: not YAML: ")}) {
    EXPECT_THAT(error(content), AllOf(StartsWith(place), EndsWith(cure)));
  }
}

TEST(SensorFile, LongWordsAreCutInErrors) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "name: {}\n" + std::string(1000, 'x') + ": 1\n");
  EXPECT_LT(error_of(folder, [&] { load_sensor_file(file); }).size(), 500U);
}

// Ten levels of tenfold references are 10^10 values for a reader that follows them.
TEST(SensorFile, ReferencesThatMultiplyAreRejectedAtOnce) {
  std::string content = "a0: &a0 [x]\n";
  for (int level = 1; level <= 10; ++level) {
    const std::string last = "*a" + std::to_string(level - 1);
    std::string list = last;
    for (int i = 1; i < 10; ++i) list += ", " + last;
    const std::string name = "a" + std::to_string(level);
    content += name + ": &" + name + " [" + list + "]\n";
  }
  const TestFolder folder;
  const auto file = folder.write("s.yaml", content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }),
            "s.yaml:7:25: more than 1001208 values with aliases written out; allowed: 1000000 "
            "values and 2 more "
            "for each byte of the file; use fewer aliases, or smaller ones");
}

TEST(SensorFile, AValueThatContainsItselfIsRejected) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "optics: &a {width: *a, height: 2, fov_deg: 20}\n");
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }),
            "s.yaml:1:20: an alias of the value that it is in; allowed: aliases of other values");
}

TEST(SensorFile, MissingFileIsToldWithItsNeighbour) {
  const TestFolder folder;
  (void)folder.write("camera.yaml", "");
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(folder.path() / "camra.yaml"); }),
            "camra.yaml: no such file; did you mean 'camera.yaml'?");
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(folder.path() / "no/where.yaml"); }),
            "no/where.yaml: no such file");
}

TEST(SensorFile, FolderIsNoFile) {
  const TestFolder folder;
  std::filesystem::create_directory(folder.path() / "camera.yaml");
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(folder.path() / "camera.yaml"); }),
            "camera.yaml: a folder; allowed: a YAML file");
}

TEST(ParseSensor, ReadsYamlAndJsonAsAFile) {
  const std::string yaml = "{optics: {width: 40, height: 30, fov_deg: 20}, rate_hz: 5}";
  const std::string json =
      R"({"optics": {"width": 40, "height": 30, "fov_deg": 20.0}, "rate_hz": 5, "name": "a"})";
  for (const Sensor& sensor : {parse_sensor(yaml), parse_sensor(json), load(yaml)}) {
    EXPECT_EQ(std::get<Pinhole>(sensor.optics).intrinsics.width, 40U);
    EXPECT_EQ(sensor.rate_hz, 5.0);
  }
  EXPECT_EQ(parse_sensor(json).name, "a");
}

TEST(ParseSensor, ErrorsNameTheFieldAndNoLine) {
  const TestFolder folder;
  const auto error = [&](const std::string& text) {
    return error_of(folder, [&] { parse_sensor(text); });
  };
  const std::string optics = "optics: {width: 4, height: 2, fov_deg: 20}";
  EXPECT_EQ(error("{optics: {width: 4, height: 2, fov_deg: 200}}"),
            "sensor: optics.fov_deg: 200; allowed: degrees above 0 and below 180");
  EXPECT_THAT(error("{" + optics + ", nose: 3}"),
              ::testing::StartsWith("sensor: nose: unknown key 'nose'"));
  EXPECT_THAT(error("{" + optics + ", noise: [{type: dropout}, 3]}"),
              ::testing::StartsWith("sensor: noise[1]: "));
  EXPECT_THAT(error("{}"), ::testing::StartsWith("sensor: "));
}

}  // namespace
}  // namespace glidar
