// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/render_options.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace glidar::app {
namespace {

using ::testing::HasSubstr;

RenderFlags parsed(std::vector<std::string> arguments) {
  CLI::App command;
  RenderFlags flags;
  add_render_options(command, flags);
  arguments.emplace_back("model.obj");
  command.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  return flags;
}

std::string error_of(const std::vector<std::string>& arguments) {
  try {
    (void)parsed(arguments);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(RenderOptions, ErrorsOfVectorsAndPosesNameTheOption) {
  EXPECT_THAT(error_of({"--eye", "1,2"}), HasSubstr("--eye: '1,2' (2 numbers)"));
  EXPECT_THAT(error_of({"--eye", "1,,2"}), HasSubstr("empty part"));
  EXPECT_THAT(error_of({"--eye", "1,2,x"}), HasSubstr("'x'"));
  EXPECT_THAT(error_of({"--eye", "1,2,inf"}), HasSubstr("finite"));
  EXPECT_THAT(error_of({"--eye", "1,2,3 "}), HasSubstr("'3 '"));
  EXPECT_THAT(error_of({"--eye", "1e16,0,0"}), HasSubstr("--eye: 1e+16; allowed"));
  EXPECT_THAT(error_of({"--sensor-pose", "0,0,0,0,0,0,0"}),
              HasSubstr("--sensor-pose: a quaternion of length 0"));
  EXPECT_THAT(error_of({"--sensor-pose", "1e300,0,0,1,0,0,0"}),
              HasSubstr("--sensor-pose: 1e+300; allowed"));
  EXPECT_THAT(error_of({"--camera-r", "1,0,0,0"}), HasSubstr("axis of length 0"));
  EXPECT_THAT(error_of({"--camera-z", "1e300"}), HasSubstr("--camera-z: 1e+300; allowed"));
  EXPECT_THAT(error_of({"--scale", "0"}), HasSubstr("--scale: 0; allowed"));
}

TEST(RenderOptions, ErrorsOfMotionNameTheOption) {
  EXPECT_THAT(error_of({"--sensor-rate", "1,2"}), HasSubstr("--sensor-rate: '1,2' (2 numbers)"));
  EXPECT_THAT(error_of({"--object-rate", "1,2,1e10"}), HasSubstr("rad/s from -1e9 to 1e9"));
  EXPECT_THAT(error_of({"--start-time", "1e10"}), HasSubstr("--start-time: '1e10'"));
  EXPECT_THAT(error_of({"--from", "soon"}), HasSubstr("--from: 'soon'"));
}

TEST(RenderOptions, ThatExcludeEachOtherAreRefused) {
  const std::vector<std::vector<std::string>> pairs = {
      {"--eye=1,2,3", "--camera-z=5"},
      {"--eye=1,2,3", "--sensor-pose=0,0,0,1,0,0,0"},
      {"--camera-q=1,0,0,0", "--camera-r=1,0,0,1"},
      {"--model-q=1,0,0,0", "--model-r=1,0,0,1"},
      {"--trajectory=t.tum", "--sensor-rate=1,2,3"},
      {"--trajectory=t.tum", "--camera-z=5"},
      {"--sensor=VLP-16", "--width=5"},
      {"--layout=velodyne", "--columns=xyz"}};
  for (const auto& pair : pairs) {
    EXPECT_THROW((void)parsed(pair), CLI::ExcludesError) << pair.front() << " " << pair.back();
  }
}

TEST(RenderOptions, ThatNeedAnotherAreRefusedWithoutIt) {
  for (const char* option : {"--target=1,2,3", "--trajectory-rate=10", "--range-sigma=0.1"}) {
    EXPECT_THROW((void)parsed({option}), CLI::RequiresError) << option;
  }
}

TEST(RenderOptions, NumbersAreDecimalAndRoundedOnce) {
  EXPECT_EQ(parsed({"--seed=010"}).seed, 10U);
  EXPECT_EQ(parsed({"--seed=18446744073709551615"}).seed, 18446744073709551615U);
  EXPECT_EQ(parsed({"--near=+0.1"}).sensor.near_m, 0.1);
  EXPECT_THAT(error_of({"--seed=0x10"}), HasSubstr("--seed: '0x10'; allowed: a whole number"));
  EXPECT_THAT(error_of({"--near=0x10"}), HasSubstr("--near: '0x10'; allowed: a number"));
}

TEST(RenderOptions, QuaternionsOfAnyLengthButZeroAreTaken) {
  for (const char* text : {"1e300,0,0,1e300", "1e-300,0,0,1e-300"}) {
    const RenderFlags flags = parsed({"--sensor-pose", std::string("0,0,0,") + text});
    ASSERT_TRUE(flags.pose.world_from_sensor) << text;
    EXPECT_TRUE(is_rigid(*flags.pose.world_from_sensor)) << text;
  }
}

TEST(RenderOptions, ACameraAttitudeOfAnyKindIsTheSame) {
  const RenderFlags by_axis = parsed({"--camera-r=1.5707963267948966,0,2,0"});
  const RenderFlags by_quaternion = parsed({"--camera-q=1,0,1,0"});
  EXPECT_LT(by_axis.pose.camera_q->angularDistance(*by_quaternion.pose.camera_q), 1e-15);
}

TEST(RenderOptions, FilesAreKnownSoThatNoOutputReplacesThem) {
  EXPECT_EQ(files_of(MotionFlags{.trajectory = "a", .trajectory_times = "b"}),
            (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(files_of(MotionFlags{}).empty());
}

}  // namespace
}  // namespace glidar::app
