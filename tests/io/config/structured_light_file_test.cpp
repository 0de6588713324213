// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/structured_light_file.hpp>

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

TEST(StructuredLightFile, OfAnotherDepthCameraIsRefused) {
  const std::string document = sensor_document(testing::preset("D435"));
  EXPECT_THAT(error_text([&] { parse_structured_light(document); }),
              HasSubstr("type: structured_light"));
}

}  // namespace
}  // namespace glidar
