// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/output/output.hpp>

#include "support/error_text.hpp"
#include "support/test_folder.hpp"

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& path, const OutputRig& rig) {
  return error_text([&] { open_output(path, rig); });
}

TEST(OutputFormats, EverySuffixSelectsItsKind) {
  for (const OutputFormat& format : output_formats()) {
    EXPECT_EQ(output_kind("scan" + format.suffix), format.kind) << format.suffix;
    EXPECT_THAT(suffixes_of(format.kind), HasSubstr(format.suffix));
    EXPECT_FALSE(format.description.empty()) << format.suffix;
  }
}

TEST(OutputFormats, ErrorsListAllSuffixesAndTheNearest) {
  const Scene scene;
  const std::string error = error_of("run.osii", {.scene = scene, .sensors = {}});
  for (const OutputFormat& format : output_formats()) EXPECT_THAT(error, HasSubstr(format.suffix));
  EXPECT_THAT(error, HasSubstr("did you mean .osi?"));
}

TEST(OpenOutput, RefusesWhatDoesNotFitAndLeavesNoFile) {
  const testing::TestFolder folder;
  const Scene scene;
  Sensor camera;
  Pinhole optics;
  optics.intrinsics = {.width = 8, .height = 6, .fx = 10.0, .fy = 10.0, .cx = 4.0, .cy = 3.0};
  camera.optics = optics;
  const Beams beams = make_beams(camera);
  OutputRig rig{.scene = scene, .sensors = {}};
  rig.sensors.push_back({.sensor = camera, .beams = beams});
  EXPECT_THAT(error_of(folder / "run.pcap", rig), HasSubstr("Pandar64"));
  EXPECT_THAT(error_of(folder / "run.imu.csv", rig), HasSubstr("there is no IMU"));
  rig.imus = {{.name = "imu", .imu = {}}};
  EXPECT_THAT(error_of(folder / "run.imu.csv", rig), HasSubstr("a motion that is known"));
  EXPECT_THAT(error_of("udp://127.0.0.1:0", rig), HasSubstr("1 to 65535"));
  EXPECT_THAT(error_of("udp://::1", rig), HasSubstr("IPv6"));
  rig.inputs = {(folder / "run.osi").string()};
  EXPECT_THAT(error_of(folder / "run.osi", rig), HasSubstr("input"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace glidar
