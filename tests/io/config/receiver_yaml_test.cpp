// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/sensor/lidar/return_names.hpp>
#include <support/error_text.hpp>

#include <gtest/gtest.h>
#include <io/yaml_files.hpp>

namespace glidar {
namespace {

const std::string kPulsed =
    "optics: {width: 4, height: 2, fov_deg: 20}\n"
    "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n";

Sensor sensor(const std::string& keys) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", kPulsed + keys + "\n"));
}

std::vector<std::string> returns(const std::string& value) {
  std::vector<std::string> names;
  for (const Return& one : sensor("receiver: {returns: " + value + "}").receiver.returns) {
    names.push_back(return_name(one));
  }
  return names;
}

TEST(FootprintInASensorFile, GivesWidthsAcrossAndUp) {
  const Footprint f =
      *sensor("footprint: {divergence_mrad: [3, 1.5], exit_mm: [9.5, 12.7], rings: 1}").footprint;
  EXPECT_DOUBLE_EQ(f.divergence_x_rad, 3e-3);
  EXPECT_DOUBLE_EQ(f.divergence_y_rad, 1.5e-3);
  EXPECT_DOUBLE_EQ(f.exit_x_m, 9.5e-3);
  EXPECT_DOUBLE_EQ(f.exit_y_m, 12.7e-3);
  EXPECT_EQ(f.rings, 1U);
}

// theta(1/e^2) = 1.699 theta(FWHM) for a Gaussian beam.
TEST(FootprintInASensorFile, TurnsWidthsAtHalfMaximumIntoThoseAtOneOverESquared) {
  const Footprint f = *sensor("footprint: {divergence_mrad: 2, width_definition: fwhm}").footprint;
  EXPECT_NEAR(f.divergence_x_rad, 2e-3 * 1.699, 2e-6);
  EXPECT_EQ(f.divergence_y_rad, f.divergence_x_rad);
  EXPECT_EQ(f.exit_x_m, 0.0);
}

TEST(ReceiverInASensorFile, GivesEveryNumber) {
  const Receiver r = sensor(
                         "receiver: {pulse_ns: 6, timing: leading_edge, min_return_separation_m: "
                         "1.2, returns: [last]}")
                         .receiver;
  EXPECT_DOUBLE_EQ(r.pulse_fwhm_s, 6e-9);
  EXPECT_EQ(r.timing, Receiver::Timing::leading_edge);
  EXPECT_EQ(r.min_return_separation_m, 1.2);
}

TEST(ReceiverInASensorFile, TakesNamesOrANumberOfReturns) {
  EXPECT_EQ(returns("[strongest, last]"), (std::vector<std::string>{"strongest", "last"}));
  EXPECT_EQ(returns("[first, second, third, second_strongest]"),
            (std::vector<std::string>{"first", "second", "third", "second_strongest"}));
  EXPECT_EQ(returns("5"),
            (std::vector<std::string>{"first", "second", "third", "return 4", "return 5"}));
}

TEST(ReceiverInASensorFile, MakesEveryBeamStandOncePerReturn) {
  const Sensor dual = sensor("receiver: {returns: [strongest, last]}");
  EXPECT_EQ(make_beams(dual).size(), 16U);
}

TEST(ReceiverInASensorFile, ErrorsNamePlaceAndWhatIsAllowed) {
  const auto text = [](const std::string& keys) { return error_text([&] { sensor(keys); }); };
  EXPECT_NE(text("receiver: {returns: [strongst]}").find("did you mean 'strongest'?"),
            std::string::npos);
  EXPECT_NE(text("receiver: {returns: 17}").find("s.yaml:3:21"), std::string::npos);
  EXPECT_NE(text("receiver: {returns: []}").find("1 to 16 returns"), std::string::npos);
  EXPECT_NE(text("receiver: {pulse_ns: 0}").find("nanoseconds above 0"), std::string::npos);
  EXPECT_NE(text("footprint: {exit_mm: 3}").find("divergence_mrad"), std::string::npos);
  EXPECT_NE(text("footprint: {divergence_mrad: [1, 2, 3]}").find("[across, up]"),
            std::string::npos);
  EXPECT_NE(text("footprint: {divergence_mrad: 1, rings: 9}").find("1 to 8"), std::string::npos);
}

TEST(ReceiverInASensorFile, NeedsPulseLight) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "optics: {width: 4, height: 2, fov_deg: 20}\nfootprint: {divergence_mrad: 1}\n");
  const std::string text = error_text([&] { load_sensor_file(file); });
  EXPECT_NE(text.find("lidar_equation"), std::string::npos) << text;
}

TEST(MirrorsInASceneFile, AreAShareOfTheLight) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "models:\n  - model: builtin:box\n    materials: {\"*\": {mirror: 0.8}}\n");
  const SceneFile loaded = load_scene_file(file, {}, {});
  EXPECT_EQ(loaded.scene.materials[loaded.scene.instances[0].materials[0]].mirror, 0.8F);
}

}  // namespace
}  // namespace glidar
