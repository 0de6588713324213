// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/sensor_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <algorithm>
#include <cmath>

namespace glidar::app {
namespace {

constexpr double kMaxPixels = 1e9;
constexpr double kMaxAmbient = 1e6;  // keeps intensities far below the maximum of float

std::array<double, 3> parse_attenuation(const std::string& text) {
  const std::vector<double> n = parse_numbers(text, 3, "c,l,q");
  if (std::min({n[0], n[1], n[2]}) < 0.0 || std::max({n[0], n[1], n[2]}) <= 0.0) {
    refuse_value(text, "3 numbers from 0, at least one of them above 0");
  }
  return {n[0], n[1], n[2]};
}

void add_camera_options(const OptionGroup& group, SensorFlags& flags) {
  const auto side = whole<std::uint32_t>(1, kMaxImageSide);
  const auto focal_length = number(kAboveZero, kMaxPixels, "pixels above 0, up to 1e9");
  const auto centre = number(-kMaxPixels, kMaxPixels, "pixels from -1e9 to 1e9");
  group.add("-w,--width", "PX", "Image width [256]", flags.width, side);
  group.add("--height", "PX", "Image height; -h prints this help [256]", flags.height, side);
  group.add("--fov", "DEG", "Vertical field of view [20]", flags.fov_deg,
            number(kAboveZero, std::nextafter(180.0, 0.0), "degrees above 0 and below 180"));
  group.add("--fx", "PX", "Focal length along the width [= fy]", flags.fx, focal_length);
  group.add("--fy", "PX", "Focal length along the height [= fx]", flags.fy, focal_length);
  group.add("--cx", "PX", "Column of the principal point [width / 2]", flags.cx, centre);
  group.add("--cy", "PX", "Row of the principal point [height / 2]", flags.cy, centre);
}

void add_scan_options(const OptionGroup& group, SensorFlags& flags) {
  group.add("--near", "M", "Minimum reported depth (LiDAR: range), m [0]", flags.near_m,
            number(0.0, kFinite, "metres, 0 or above"));
  group.add("--far", "M", "Maximum reported depth (LiDAR: range), m [inf]", flags.far_m,
            number(kAboveZero, INFINITY, "metres above 0, or inf"));
  group.add("--rate", "HZ", "Frames per second; of a spinning sensor: revolutions", flags.rate_hz,
            parse_number);
  group.add("--columns-per-turn", "N", "Columns of a spinning sensor, for example 2048",
            flags.columns_per_turn, whole<std::int64_t>(1, kMaxColumnsPerTurn));
  group.add("--returns", "LIST|N",
            "Returns of a pulse (strongest,last), or the N nearest [its own]", flags.returns,
            [](const std::string& text) { return parse_returns("--returns", parse_list(text)); });
  group.add_flag("--cull-back-faces", "Beams pass triangles seen from behind [they are hit]",
                 flags.cull_back_faces);
  group.add("--depth-model", "NAME", "law (noise steps) or physical (raw images) [its own]",
            flags.depth_model,
            one_of<DepthModel>({{"law", DepthModel::law}, {"physical", DepthModel::physical}}));
  group.add_flag("--ground-truth", "No noise, pulsed light or footprint: the exact geometry",
                 flags.ground_truth);
}

void add_light_options(const OptionGroup& group, SensorFlags& flags) {
  group.add("--ambient", "A", "Ambient light of the scene [0.2]", flags.ambient,
            number(0.0, kMaxAmbient, "a number from 0 to 1e6"));
  group.add("--attenuation", "C,L,Q", "Light falls as 1/(C + L d + Q d^2) [1,1e-4,1e-8]",
            flags.attenuation, parse_attenuation);
  group.add("--visibility", "M", "Visibility, for pulsed light; 0: no fog [as in the sensor file]",
            flags.visibility_m, parse_number);
  group.add("--rain", "MM/H", "Rain, for pulsed light [as in the sensor file]", flags.rain_mm_per_h,
            parse_number);
  group.add("--snow", "MM/H", "Snow as melted water, for pulsed light [as in the sensor file]",
            flags.snow_mm_per_h, parse_number);
}

}  // namespace

void add_calibration_option(const OptionGroup& group, std::vector<std::string>& files) {
  group.add_repeatable("--calibration", "FILE",
                       "Calibration of one LiDAR or camera; repeatable [none]",
                       [&files](const std::string& file) { files.push_back(file); });
}

void add_sensor_options(CLI::App& command, SensorFlags& flags) {
  const OptionGroup group(command, "Sensor");
  group.add("--sensor", "NAME|FILE", "Sensor preset (see glidar sensors) or sensor file (YAML)",
            flags.file);
  group.add("--mode", "NAME", "Mode of the sensor, for example 2048x10 [its default mode]",
            flags.mode);
  add_calibration_option(group, flags.calibration_files);
  add_camera_options(group, flags);
  add_scan_options(group, flags);
  add_light_options(group, flags);
  const OptionNames camera = {"--width", "--height", "--fov", "--fx", "--fy", "--cx", "--cy"};
  forbid_together(command, {"--sensor"}, camera);
  require_option(command, {"--mode"}, "--sensor");
  forbid_together(command, {"--fov"}, {"--fx", "--fy"});
}

}  // namespace glidar::app
