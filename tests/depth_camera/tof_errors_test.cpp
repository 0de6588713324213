// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <depth_camera/tof_pictures.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>

namespace glidar {
namespace {

using ::testing::HasSubstr;

TofImages empty_images(std::uint32_t frequencies, std::uint32_t taps) {
  TofImages images{2, 2, frequencies, taps};
  images.level.resize(std::size_t{4} * frequencies * taps);
  return images;
}

std::string option_error(const std::function<void(TofOptions&)>& change) {
  TofOptions options;
  options.frequencies_hz = {80e6, 60e6};
  change(options);
  return error_text([&] {
    const auto frequencies = static_cast<std::uint32_t>(options.frequencies_hz.size());
    (void)decode_tof(empty_images(frequencies, options.taps), options);
  });
}

TEST(TofErrors, NameTheOptionThatIsNotAllowed) {
  EXPECT_THAT(option_error([](TofOptions& o) { o.frequencies_hz.clear(); }),
              HasSubstr("frequencies_hz: has 0 frequencies; allowed: 1 to 8"));
  EXPECT_THAT(option_error([](TofOptions& o) {
                o.frequencies_hz = {80e6, 79.999e6};
              }),
              HasSubstr("greatest common divisor is below a thousandth"));
  EXPECT_THAT(option_error([](TofOptions& o) { o.frequencies_hz[0] = -1.0; }),
              HasSubstr("frequencies_hz: is -1"));
  EXPECT_THAT(option_error([](TofOptions& o) { o.taps = 2; }),
              HasSubstr("taps: is 2; allowed: a whole number from 3 to 16"));
  EXPECT_THAT(option_error([](TofOptions& o) { o.amplitude_gain = {1.0}; }),
              HasSubstr("amplitude_gain: has 1 numbers for 2 frequencies"));
  EXPECT_THAT(
      option_error([](TofOptions& o) { o.unwrapping = TofUnwrapping::kinect_v2; }),
      HasSubstr("kinect_v2 with frequencies_hz [8e+07, 6e+07]; allowed: three frequencies"));
  EXPECT_THAT(option_error([](TofOptions& o) { o.min_amplitude = -2.0; }),
              HasSubstr("min_amplitude: is -2; allowed: a finite number from 0"));
  EXPECT_THAT(option_error([](TofOptions& o) { o.edge_test = TofEdgeTest{.near_step_m = -1.0}; }),
              HasSubstr("edge_test.near_step_m: is -1"));
}

TEST(TofErrors, NameImagesThatDoNotFitTheOptions) {
  TofOptions options;
  options.frequencies_hz = {80e6};
  const auto decode_error = [&](const TofImages& images) {
    return error_text([&] { (void)decode_tof(images, options); });
  };
  EXPECT_THAT(decode_error(empty_images(2, 4)),
              HasSubstr("there are 2 frequencies with 4 phase steps; allowed: as the options: 1 "
                        "with 4"));
  TofImages cut = empty_images(1, 4);
  cut.level.pop_back();
  EXPECT_THAT(decode_error(cut), HasSubstr("have 15 values; allowed: 16"));
  EXPECT_THAT(decode_error({0, 3, 1, 4, {}}), HasSubstr("have 0x3 pixels"));
}

TEST(TofErrors, NameCalibrationsOfOtherSizes) {
  TofOptions options;
  options.frequencies_hz = {80e6};
  const std::array<float, 3> three{};
  EXPECT_THAT(error_text([&] {
                (void)decode_tof(empty_images(1, 4), options, {.depth_per_range = three});
              }),
              HasSubstr("depth_per_range: has 3 numbers; allowed: 4"));
}

TEST(TofErrors, RefuseToExplainPixelsOutsideTheImage) {
  TofOptions options;
  options.frequencies_hz = {80e6};
  EXPECT_THAT(error_text([&] {
                (void)explain_tof(empty_images(1, 4), options, {2, 0});
              }),
              HasSubstr("2,0 is outside the image; allowed: columns 0 to 1, rows 0 to 1"));
}

TEST(TofErrors, NameTheValueOfACameraThatIsNotAllowed) {
  const auto camera_error = [](const std::function<void(TofCamera&)>& change) {
    TofCamera camera = testing::plain_camera({80e6}, 4);
    change(camera);
    return error_text([&] { validate(camera); });
  };
  EXPECT_THAT(camera_error([](TofCamera& c) { c.signal_electrons = 0.0; }),
              HasSubstr("signal_electrons: is 0; allowed: a finite number above 0"));
  EXPECT_THAT(camera_error([](TofCamera& c) { c.contrast = {1.5}; }),
              HasSubstr("contrast: is 1.5"));
  EXPECT_THAT(camera_error([](TofCamera& c) {
                c.contrast = {0.5, 0.5};
              }),
              HasSubstr("has 2 numbers for 1 frequencies"));
  EXPECT_THAT(camera_error([](TofCamera& c) { c.sub_rays = 17; }),
              HasSubstr("sub_rays: is 17; allowed: a whole number from 1 to 16"));
  EXPECT_THAT(camera_error([](TofCamera& c) { c.step_interval_s = 1e300; }),
              HasSubstr("step_interval_s: is 1e+300, so that 4 phase steps take"));
  EXPECT_THAT(camera_error([](TofCamera& c) { c.step_interval_s = 1.25; }),
              HasSubstr("is 1.25, so that 4 phase steps take 5 s; allowed: at most 4 s for all"));
  EXPECT_EQ(camera_error([](TofCamera& c) { c.step_interval_s = 1.0; }), "no error");
  EXPECT_EQ(camera_error([](TofCamera&) {}), "no error");
}

}  // namespace
}  // namespace glidar
