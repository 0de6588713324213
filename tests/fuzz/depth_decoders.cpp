// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/depth_camera/stereo.hpp>
#include <glidar/depth_camera/time_of_flight.hpp>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

namespace glidar::testing {
namespace {

constexpr std::size_t kOptionBytes = 10;

/// The options' bytes, and those after them.
struct Input {
  std::string options;
  std::string data;
};

Input read_input(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (bytes.size() < kOptionBytes) throw Error({"input", "too few bytes", "at least 10"});
  return {bytes.substr(0, kOptionBytes), bytes.substr(kOptionBytes)};
}

std::uint32_t number(const Input& input, std::size_t i) {
  return static_cast<std::uint8_t>(input.options[i]);
}

TofOptions tof_options(const Input& input) {
  TofOptions options = number(input, 4) % 2 == 1 ? kinect_v2_options() : TofOptions{};
  if (number(input, 4) % 2 == 0) {
    for (std::uint32_t f = 0; f < number(input, 2); ++f) {
      options.frequencies_hz.push_back(1e6 * (number(input, 5) + f * number(input, 6)));
    }
    options.taps = number(input, 3);
  }
  if ((number(input, 4) & 2U) != 0) options.filter = TofFilter{.min_amplitude = 1.0};
  if ((number(input, 4) & 4U) != 0) options.edge_test = TofEdgeTest{};
  options.min_amplitude = number(input, 7);
  options.misfit_test.max_rad = 0.1 * number(input, 8);
  options.far_m = number(input, 9) == 0 ? kInfinity : number(input, 9);
  return options;
}

TofImages tof_images(const Input& input, const TofOptions& options) {
  TofImages images{number(input, 0), number(input, 1),
                   static_cast<std::uint32_t>(options.frequencies_hz.size()), options.taps};
  images.level.resize(input.data.size() / sizeof(float));
  if (!images.level.empty()) {
    std::memcpy(images.level.data(), input.data.data(), images.level.size() * sizeof(float));
  }
  return images;
}

void check_tof(const TofMeasurement& measured, const TofOptions& options) {
  for (std::size_t i = 0; i < measured.status.size(); ++i) {
    const double range_m = measured.range_m[i];
    const bool is_valid = measured.status[i] == TofStatus::valid;
    demand(is_valid ? std::isfinite(range_m) : std::isnan(range_m), "a range where it is valid");
    demand(!is_valid || (range_m >= options.near_m && range_m <= options.far_m),
           "valid depths are within the limits");
  }
}

/// Levels of one of both images; too few bytes leave the image too small.
GreyImage grey_image(const Input& input, std::size_t first) {
  GreyImage image = {.width = number(input, 0), .height = number(input, 1)};
  const std::size_t pixels = std::size_t{image.width} * image.height;
  for (std::size_t i = first; i < std::min(first + pixels, input.data.size()); ++i) {
    image.level.push_back(static_cast<std::uint8_t>(input.data[i]));
  }
  return image;
}

StereoOptions stereo_options(const Input& input) {
  StereoOptions options;
  options.disparities = number(input, 2);
  options.min_disparity_px = number(input, 3);
  options.census = static_cast<StereoCensus>(number(input, 4) % 3);
  options.subpixel = static_cast<StereoSubpixel>(number(input, 4) / 3 % 3);
  options.paths = number(input, 4) / 9 % 2 == 0 ? 8 : 4;
  options.box_px = number(input, 5);
  options.p1 = number(input, 6);
  options.p2 = number(input, 7);
  options.uniqueness_percent = number(input, 8) % 128;
  options.has_left_right_test = number(input, 8) < 128;
  options.steps_per_px = number(input, 9);
  return options;
}

void check_stereo(const StereoMatch& match, const StereoOptions& options) {
  const double first = options.min_disparity_px;
  for (std::size_t i = 0; i < match.status.size(); ++i) {
    const double disparity_px = match.disparity_px[i];
    const bool is_valid = match.status[i] == StereoStatus::valid;
    demand(is_valid != std::isnan(disparity_px), "a disparity where it is valid");
    demand(!is_valid || (disparity_px >= first && disparity_px <= first + options.disparities),
           "valid disparities are within the search");
  }
}

}  // namespace

void read_raw_tof_images(const std::filesystem::path& file) {
  const Input input = read_input(file);
  const TofOptions options = tof_options(input);
  const TofImages images = tof_images(input, options);
  const TofMeasurement measured = decode_tof(images, options);
  check_tof(measured, options);
  const std::uint32_t column = images.width - 1;
  const TofTrace trace = explain_tof(images, options, {column, 0});
  demand(trace.status == measured.status[column], "the trace has the status of its pixel");
  demand(!format_tof_trace(trace).empty(), "the trace has a text");
}

void read_raw_stereo_pair(const std::filesystem::path& file) {
  const Input input = read_input(file);
  const StereoOptions options = stereo_options(input);
  const GreyImage left = grey_image(input, 0);
  const GreyImage right = grey_image(input, left.level.size());
  const StereoMatch match = match_stereo(left, right, options);
  check_stereo(match, options);
  const StereoMatch plain = match_stereo(left, right, options, {.instruction_set = "baseline"});
  demand(match.status == plain.status, "the same for every instruction set");
  const std::uint32_t column = left.width - 1;
  const StereoTrace trace = explain_stereo(left, right, options, {column, 0});
  demand(trace.status == match.status[column], "the trace has the status of its pixel");
  demand(!format_stereo_trace(trace).empty(), "the trace has a text");
}

}  // namespace glidar::testing
