// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/pose_options.hpp>

#include <apps/glidar/options/help_text.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>

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

}  // namespace glidar::app
