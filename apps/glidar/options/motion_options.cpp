// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/motion_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <cmath>

namespace glidar::app {
namespace {

Eigen::Vector3d parse_angular_rate(const std::string& text) {
  constexpr double kMax_rad_s = 1e9;
  const Eigen::Vector3d rate = parse_vector(text);
  if (rate.cwiseAbs().maxCoeff() > kMax_rad_s) refuse_value(text, "rad/s from -1e9 to 1e9");
  return rate;
}

std::int64_t parse_start_ns(const std::string& text) {
  constexpr double kMaxStart_s = 9.2e9;
  return std::llround(number(-kMaxStart_s, kMaxStart_s, "seconds up to 9.2e9")(text) * 1e9);
}

}  // namespace

void add_motion_options(CLI::App& command, MotionFlags& flags) {
  const OptionGroup motion(command, "Motion");
  motion.add("--trajectory", "FILE", "Poses of the sensor over time: TUM, KITTI, CSV",
             flags.trajectory);
  motion.add("--trajectory-rate", "HZ", "Poses per second of a KITTI file, Hz",
             flags.trajectory_rate_hz, parse_number);
  motion.add("--trajectory-times", "FILE", "Times of the poses of a KITTI file, one per line",
             flags.trajectory_times);
  motion.add("--trajectory-start", "S", "Time of the first pose, s [as in the file]",
             flags.trajectory_start_ns, parse_start_ns);
  motion.add("--trajectory-interpolation", "NAME",
             "Between poses: linear, or spline, as IMUs need [linear]",
             flags.trajectory_interpolation,
             one_of<Interpolation>(
                 {{"linear", Interpolation::linear}, {"spline", Interpolation::spline}}));
  require_option(command,
                 {"--trajectory-rate", "--trajectory-times", "--trajectory-start",
                  "--trajectory-interpolation"},
                 "--trajectory");
  motion.add("--object-rate", "X,Y,Z", "Angular rate of the model about its axes, rad/s",
             flags.object_rate_rad_s, parse_angular_rate);
  motion.add("--sensor-rate", "X,Y,Z", "Angular rate of the sensor about left, up, forward, rad/s",
             flags.sensor_rate_rad_s, parse_angular_rate);
  forbid_together(command, {"--trajectory"},
                  {"--sensor-rate", "--eye", "--target", "--sensor-pose"});
}

std::vector<std::string> files_of(const MotionFlags& flags) {
  std::vector<std::string> files;
  for (const std::string& file : {flags.trajectory, flags.trajectory_times}) {
    if (!file.empty()) files.push_back(file);
  }
  return files;
}

}  // namespace glidar::app
