// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/depth_camera_files.hpp>

#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <support/error_text.hpp>
#include <support/preset.hpp>
#include <support/source_folder.hpp>

#include <gmock/gmock.h>

#include <filesystem>

namespace glidar {
namespace {

using ::testing::HasSubstr;

void expect_same(const StructuredLight& setup, const Sensor& sensor) {
  const auto& scanner = std::get<StructuredLightCamera>(*sensor.depth_camera);
  EXPECT_EQ(setup.camera.intrinsics.fx, std::get<Pinhole>(sensor.optics).intrinsics.fx);
  EXPECT_EQ(setup.projector.intrinsics.fx, scanner.projector.intrinsics.fx);
  EXPECT_EQ(setup.projector_from_camera.matrix(), scanner.projector_from_camera.matrix());
  EXPECT_EQ(setup.patterns.width, 1280U);
  EXPECT_EQ(setup.patterns.height, 800U);
  EXPECT_EQ(setup.patterns.period_px, scanner.patterns.period_px);
  EXPECT_EQ(setup.decoding.min_modulation, scanner.decoding.min_modulation);
}

TEST(StructuredLightFile, OfASensorIsTheSetupOfItsCamera) {
  const std::filesystem::path path = std::filesystem::path(kSourceFolder) / "examples/scanner.yaml";
  const Sensor sensor = load_sensor_file(path);
  expect_same(load_structured_light(path), sensor);
  expect_same(parse_structured_light(sensor_document(sensor)), sensor);
}

TEST(StructuredLightFile, OfASensorHasTheSaturationOfItsImager) {
  Sensor sensor = load_sensor_file(std::filesystem::path(kSourceFolder) / "examples/scanner.yaml");
  auto& scanner = std::get<StructuredLightCamera>(*sensor.depth_camera);
  const auto level = [&](std::uint32_t bits) {
    scanner.imager.bits = bits;
    return parse_structured_light(sensor_document(sensor)).decoding.saturation_level;
  };
  EXPECT_EQ(level(8), 0U);
  EXPECT_EQ(level(10), 1023U);
  EXPECT_EQ(level(16), 0U);
  scanner.decoding.saturation_level = 900;
  EXPECT_EQ(level(10), 900U);
}

TEST(StructuredLightFile, OfAnotherDepthCameraIsRefused) {
  const std::string document = sensor_document(testing::preset("D435"));
  EXPECT_THAT(error_text([&] { parse_structured_light(document); }),
              HasSubstr("type: structured_light"));
}

const char* const kSetup =
    "camera: {width: 8, height: 4, fx: 9, fy: 9}\n"
    "projector: {width: 64, height: 4, fx: 9, fy: 9}\n"
    "projector_from_camera: {position: [0.2, 0, 0]}\n"
    "patterns: {steps: 4, period_px: 8}\n";

std::string refusal_with(const std::string& from, const std::string& to) {
  std::string text = kSetup;
  text.replace(text.find(from), from.size(), to);
  return error_text([&] { parse_structured_light(text); });
}

TEST(StructuredLightFile, OfASetupIsRefusedAtTheKeyThatDoesNotFit) {
  EXPECT_EQ(image_count(parse_structured_light(kSetup).patterns), 12U);
  EXPECT_THAT(refusal_with("steps: 4", "steps: 2"),
              HasSubstr("patterns.steps: 2; allowed: 0, or 3"));
  EXPECT_THAT(refusal_with("steps: 4, period_px: 8", "steps: 0, period_px: 1000"),
              HasSubstr("patterns.period_px: 1000"));
  EXPECT_THAT(refusal_with("steps: 4", "steps: 0, has_inverses: false"),
              HasSubstr("patterns.has_inverses"));
  EXPECT_THAT(refusal_with("steps: 4", "min_level: 1"), HasSubstr("patterns: max_level: 1"));
  EXPECT_THAT(refusal_with("[0.2, 0, 0]", "[0, 0, 0]"),
              HasSubstr("projector_from_camera: the projector is at the position of the camera"));
  EXPECT_THAT(refusal_with("width: 64", "width: 16385"), HasSubstr("at most 16384"));
}

}  // namespace
}  // namespace glidar
