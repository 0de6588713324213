// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/io/model/model.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/imu.hpp>
#include <glidar/sensor/sensor.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// A sensor and where it sits on the rig.
struct RigSensor {
  std::string name;  ///< fit for file names and topics; empty: the only one needs none
  Sensor sensor;
  Pose rig_from_sensor = Pose::Identity();
};

/// An IMU and where it sits on the rig.
struct RigImu {
  std::string name;  ///< fit for file names and topics, unique among sensors and IMUs
  Imu imu;
  Pose rig_from_imu = Pose::Identity();
};

/// What a scene file holds: the world and how it moves, and perhaps sensors and where they are. A
/// single sensor is a rig of its own.
struct SceneFile {
  Scene scene;                         ///< poses are those at time 0
  std::vector<RigSensor> sensors;      ///< on the rig; none: the file names no sensor
  std::optional<Pose> world_from_rig;  ///< at time 0
  bool looks_at = false;               ///< the pose is that of look_at(), for a boresight +z
  std::vector<std::string> files;      ///< this file, and the sensor and trajectory files it names
  std::vector<Trajectory> world_from_instance = {};  ///< one per instance; empty: all are static
  std::optional<Trajectory> rig_motion = {};         ///< empty: the rig is static
  std::vector<RigImu> imus = {};                     ///< on the rig
  Eigen::Vector3d gravity_m_s2 = standard_gravity_m_s2();  ///< that IMUs measure, world axes
  /// Names of the classes whose objects have boxes, see boxed_classes().
  std::vector<std::string> box_classes = {};
};

/// Reads a scene from YAML (docs/files.md) and loads the models it names, each file once.
/// Paths are relative to the file. Every error names file:line:column, the field, what is allowed
/// and the nearest known key.
SceneFile load_scene_file(const std::filesystem::path& path, const ModelOptions& defaults,
                          const Report& report);

/// The same from the content of the file that is given, such as with other values.
SceneFile load_scene_content(const std::filesystem::path& path, const std::string& content,
                             const ModelOptions& defaults, const Report& report);

/// The same from a text, YAML or JSON. Paths are relative to `folder`, or to the working folder
/// when it is empty. Errors name the field.
SceneFile parse_scene(const std::string& text, const Report& report,
                      const std::filesystem::path& folder = {});

/// Adds models to a scene by a text, YAML or JSON, with the key `models` of scene files. Paths and
/// errors are as for parse_scene(); `sensors` are the names that `visible_to` and `hidden_from`
/// refer to, by their id.
void add_models(Scene& scene, const std::string& text, const ModelOptions& defaults,
                const std::vector<std::string>& sensors, const Report& report,
                const std::filesystem::path& folder = {});

/// Changes the materials of one instance by a text, YAML or JSON, with the keys of `materials` in
/// scene files. Paths are relative to `folder`, or to the working folder when
/// it is empty. Errors name the field.
void set_materials(Scene& scene, std::size_t instance, const std::string& text,
                   const std::filesystem::path& folder = {});

}  // namespace glidar
