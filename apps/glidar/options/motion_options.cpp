// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/motion_options.hpp>

#include <glidar/core/time_text.hpp>

#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

#include <string_view>

namespace glidar::app {

void add_pose_options(CLI::App& command, PoseFlags& flags) {
  const OptionGroup group(command, "Pose (default: the scene fills the view, seen from 2,-3,2)");
  group.add("--eye", "X,Y,Z", "Sensor position in the world, m", flags.eye_m, parse_position);
  group.add("--target", "X,Y,Z", "Point the sensor looks at, m [the scene; LiDARs: along x]",
            flags.target_m, parse_position);
  group.add("--up-vector", "X,Y,Z",
            "Direction up in the image [0,0,1; 1,0,0 if it looks vertically]", flags.up,
            parse_vector);
  group.add("--sensor-pose", "X,Y,Z,QW,QX,QY,QZ",
            "Position in the world, m, and attitude of the sensor", flags.world_from_sensor,
            parse_pose);
  OptionGroup(command, "Model")
      .add("--scale", "S|X,Y,Z", "Scale of the model, after --unit; negative factors mirror [1]",
           flags.scale, parse_scale);
  require_option(command, {"--target"}, "--eye");
  forbid_together(command, {"--sensor-pose"}, {"--eye", "--target"});
}

void add_woods2016_pose_options(CLI::App& command, PoseFlags& flags) {
  const OptionGroup group(command, kWoods2016Heading);
  const char* const quaternion = "W,X,Y,Z";
  const char* const angle_axis = "ANGLE,X,Y,Z";
  group.add("--model-q", quaternion, "Model attitude, quaternion", flags.model_q, parse_quaternion);
  group.add("--model-r", angle_axis, "Model attitude, radians and axis", flags.model_q,
            parse_angle_axis);
  group.add("--camera-q", quaternion, "Sensor attitude, quaternion", flags.camera_q,
            parse_quaternion);
  group.add("--camera-r", angle_axis, "Sensor attitude, radians and axis", flags.camera_q,
            parse_angle_axis);
  group.add("--camera-z", "D", "Distance from sensor to object, m [1000]", flags.camera_z_m,
            number(-kMaxCoordinate_m, kMaxCoordinate_m, "metres from -1e15 to 1e15"));
  forbid_together(command, {"--model-q"}, {"--model-r"});
  forbid_together(command, {"--camera-q"}, {"--camera-r"});
  forbid_together(command, {"--camera-z", "--camera-q", "--camera-r"},
                  {"--eye", "--target", "--sensor-pose", "--trajectory"});
}

namespace {

Eigen::Vector3d parse_angular_rate(const std::string& text) {
  constexpr double kMax_rad_s = 1e9;
  const Eigen::Vector3d rate = parse_vector(text);
  if (rate.cwiseAbs().maxCoeff() > kMax_rad_s) refuse_value(text, "rad/s from -1e9 to 1e9");
  return rate;
}

/// Recorded commands have "now=SECONDS".
void parse_start_time(const std::string& text, MotionFlags& flags) {
  constexpr std::string_view kNowAt = "now=";
  flags.start_time_ns.reset();
  flags.starts_now = text == "now" || text.starts_with(kNowAt);
  if (text == "trajectory" || text == "now") return;
  const std::string time = flags.starts_now ? text.substr(kNowAt.size()) : text;
  flags.start_time_ns = time.ends_with('Z') ? parse_date_ns(time) : parse_seconds_ns(time);
  if (flags.start_time_ns && *flags.start_time_ns >= 0) return;
  refuse_value(text, "seconds since 1970, a date in UTC, now or trajectory",
               "for example 1767225600.5 or 2026-01-01T00:00:00.5Z");
}

TrajectoryTime parse_trajectory_time(const std::string& text) {
  const std::optional<std::int64_t> t_ns =
      text.ends_with('Z') ? parse_date_ns(text) : parse_seconds_ns(text);
  if (t_ns) return {*t_ns, text.starts_with('+')};
  refuse_value(text, "a time of the trajectory in seconds or as a date in UTC, or + and seconds",
               "for example 1767225600.5, or +2.5 after the first pose");
}

}  // namespace

void add_motion_options(CLI::App& command, MotionFlags& flags) {
  const OptionGroup motion(command, "Motion");
  motion.add("--trajectory", "FILE", "Poses of the sensor over time: TUM, KITTI, EuRoC, CSV",
             flags.trajectory);
  motion.add("--trajectory-rate", "HZ", "Poses per second of a KITTI file, Hz",
             flags.trajectory_rate_hz, parse_number);
  motion.add("--trajectory-times", "FILE", "Times of the poses of a KITTI file, one per line",
             flags.trajectory_times);
  motion.add("--trajectory-interpolation", "NAME",
             "Between poses: linear, or spline, as IMUs need [linear]",
             flags.trajectory_interpolation,
             one_of<Interpolation>(
                 {{"linear", Interpolation::linear}, {"spline", Interpolation::spline}}));
  require_option(command, {"--trajectory-rate", "--trajectory-times", "--trajectory-interpolation"},
                 "--trajectory");
  motion.add("--from", "T", "Start on the trajectory: its time, or +S after its first pose",
             [&flags](const std::string& text) { flags.from = parse_trajectory_time(text); });
  motion.add("--to", "T", "End here on the trajectory, instead of --duration",
             [&flags](const std::string& text) { flags.to = parse_trajectory_time(text); });
  motion.add("--start-time", "T", "Start: s since 1970, a date, now, trajectory [trajectory]",
             [&flags](const std::string& text) { parse_start_time(text, flags); });
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
