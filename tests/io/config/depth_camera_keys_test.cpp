// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_options.hpp>

#include <support/error_text.hpp>
#include <support/preset.hpp>

#include <gmock/gmock.h>

#include <string>

namespace glidar {
namespace {

using ::testing::HasSubstr;

std::string camera_text(const std::string& keys) {
  return "optics: {width: 320, height: 200, fx: 300, fy: 300}\nwavelength_nm: 850\n" + keys;
}

std::string refusal(const std::string& keys) {
  return error_text([&] { parse_sensor(camera_text(keys)); });
}

TEST(DepthCameraKeys, ReadWhatTheyName) {
  const Sensor sensor = parse_sensor(camera_text(
      "depth_model: physical\ndepth_camera:\n  type: active_stereo\n  baseline_m: 0.06\n"
      "  sub_rays: 2\n  projector: {origin_m: [0.02, 0, 0], dot_width_deg: 0.3}\n"
      "  illumination: {sun_w_per_m2: 2, sun_direction: [1, 0, 1]}\n"
      "  imager: {bits: 10, auto_exposure: {target: 0.4, max_time_ms: 5}}\n"
      "  matcher: {disparities: 64, box_px: 7}\n"));
  EXPECT_EQ(sensor.depth_model, DepthModel::physical);
  const auto& camera = std::get<ActiveStereo>(sensor.depth_camera.value());
  EXPECT_EQ(camera.baseline_m, 0.06);
  EXPECT_EQ(camera.sub_rays, 2U);
  EXPECT_EQ(camera.projector.origin_m, Eigen::Vector3d(0.02, 0.0, 0.0));
  EXPECT_NEAR(camera.projector.dot_width_rad, 0.3 * kDegree, 1e-15);
  EXPECT_EQ(camera.illumination.sun_w_per_m2, 2.0);
  EXPECT_EQ(camera.imager.bits, 10U);
  EXPECT_EQ(camera.imager.auto_exposure.target, 0.4);
  EXPECT_NEAR(camera.imager.auto_exposure.max_time_s, 0.005, 1e-15);
  EXPECT_EQ(camera.matcher.box_px, 7U);
}

const char* const kScanner =
    "depth_model: physical\ndepth_camera:\n  type: structured_light\n"
    "  projector: {width: 500, height: 300, fx: 600, fy: 610, cx: 240, cy: 150,\n"
    "              distortion: {model: radial_tangential, k1: 0.1}}\n"
    "  projector_from_camera: {position: [-0.2, 0.01, 0.02], rotation_vector: [0, 0.2, 0]}\n"
    "  light: {power_w: 2, gamma: 2.2, blur_px: 0.7, speckle_contrast: 0.1}\n"
    "  patterns: {axis: rows, steps: 5, period_px: 20, gamma: 2.2}\n"
    "  decoding: {min_modulation: 7}\n"
    "  illumination: {ambient_w_per_m2: 0.2}\n"
    "  imager: {bits: 12}\n  sub_rays: 2\n  image_interval_s: 0.01\n";

TEST(DepthCameraKeys, ReadThoseOfStructuredLight) {
  const Sensor sensor = parse_sensor(camera_text(kScanner));
  const auto& camera = std::get<StructuredLightCamera>(sensor.depth_camera.value());
  EXPECT_EQ(camera.projector.intrinsics.fy, 610.0);
  EXPECT_EQ(std::get<RadialTangential>(camera.projector.distortion).k1, 0.1);
  EXPECT_EQ(camera.projector_from_camera.translation(), Eigen::Vector3d(-0.2, 0.01, 0.02));
  EXPECT_EQ(camera.patterns.width, 500U);
  EXPECT_EQ(camera.patterns.height, 300U);
  EXPECT_EQ(camera.patterns.axis, FringeAxis::rows);
  EXPECT_EQ(camera.patterns.steps, 5U);
  EXPECT_EQ(camera.light.power_w, 2.0);
  EXPECT_EQ(camera.light.gamma, 2.2);
  EXPECT_EQ(camera.light.blur_px, 0.7);
  EXPECT_EQ(camera.light.speckle_contrast, 0.1);
  EXPECT_EQ(camera.decoding.min_modulation, 7.0);
  EXPECT_EQ(camera.illumination.ambient_w_per_m2, 0.2);
  EXPECT_EQ(camera.imager.bits, 12U);
  EXPECT_EQ(camera.sub_rays, 2U);
  EXPECT_EQ(camera.image_interval_s, 0.01);
  const std::string document = sensor_document(sensor);
  EXPECT_EQ(sensor_document(parse_sensor(document)), document);
}

TEST(DepthCameraKeys, OfStructuredLightRefuseWhatDoesNotFit) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = kScanner;
    text.replace(text.find(from), from.size(), to);
    return refusal(text);
  };
  EXPECT_THAT(changed("steps: 5", "steps: 2"),
              HasSubstr("depth_camera.patterns.steps: 2; allowed: 0, or 3 to 64"));
  EXPECT_THAT(changed("[-0.2, 0.01, 0.02]", "[0, 0, 0]"),
              HasSubstr("depth_camera.projector_from_camera: the projector is at the position"));
  EXPECT_THAT(changed("image_interval_s: 0.01", "image_interval_s: 1"),
              HasSubstr("depth_camera.image_interval_s: 1, so that"));
  EXPECT_THAT(changed("power_w: 2", "power_w: 1e40"), HasSubstr("a number from 0 to 1e6"));
  EXPECT_THAT(changed("ambient_w_per_m2: 0.2", "ambient_w_per_m2: 1e40"),
              HasSubstr("a number from 0 to 1e6"));
  EXPECT_THAT(changed("sub_rays: 2", "sub_rays: 17"), HasSubstr("1 to 16"));
  EXPECT_THAT(changed("light: {power_w: 2,", "light: {power: 2,"), HasSubstr("power_w"));
  EXPECT_THAT(refusal("depth_camera: {type: structured_light, projector_from_camera: {position: "
                      "[0.1, 0, 0]}}\n"),
              HasSubstr("projector"));
}

TEST(DepthCameraKeys, OfPresetsAreRestoredFromTheirDocument) {
  for (const char* name : {"D415", "D435", "D455", "Kinect-v1"}) {
    const Sensor sensor = testing::preset(name);
    ASSERT_TRUE(sensor.depth_camera) << name;
    EXPECT_EQ(sensor.depth_model, DepthModel::law) << name;
    const std::string document = sensor_document(sensor);
    EXPECT_EQ(sensor_document(parse_sensor(document)), document) << name;
  }
}

TEST(DepthCameraKeys, RefuseWhatDoesNotFit) {
  EXPECT_THAT(refusal("depth_model: physical\n"), HasSubstr("has no depth_camera"));
  EXPECT_THAT(refusal("depth_model: exact\n"), HasSubstr("law"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, matcher: {box_px: 4}}\n"),
              HasSubstr("is even"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, reference: pattern}\n"),
              HasSubstr("write the baseline as x"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, matcher: {disparities: 400}}\n"),
              HasSubstr("wider than the image"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, projector: {picture: none.png}}\n"),
              HasSubstr("none.png"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, projector: {power_w: 1e40}}\n"),
              HasSubstr("a number from 0 to 1e6"));
  EXPECT_THAT(refusal("depth_camera: {type: active_stereo, illumination: {sun_direction: [0, 0, "
                      "0]}}\n"),
              HasSubstr("without direction"));
  EXPECT_THAT(error_text([] {
                parse_sensor(
                    "optics: {width: 320, height: 200, fx: 300, fy: 300}\n"
                    "depth_camera: {type: active_stereo}\n");
              }),
              HasSubstr("wavelength_nm"));
}

TEST(DepthCameraKeys, SelectTheModelByOption) {
  Sensor sensor = testing::preset("D435");
  SensorOptions options;
  options.depth_model = depth_model_named("--depth-model", "physical");
  apply_depth_model(options, {}, sensor);
  EXPECT_NE(physical_camera(sensor), nullptr);
  EXPECT_EQ(physical_camera(ground_truth_sensor(sensor)), nullptr);
  Sensor other = testing::preset("D405");
  EXPECT_THAT(error_text([&] { apply_depth_model(options, {}, other); }),
              HasSubstr("has no depth_camera"));
  EXPECT_THAT(error_text([] { depth_model_named("--depth-model", "real"); }),
              HasSubstr("law, physical"));
}

}  // namespace
}  // namespace glidar
