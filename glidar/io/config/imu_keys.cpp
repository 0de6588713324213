// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/imu_keys.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/io/config/imu_file.hpp>
#include <glidar/io/config/rig_keys.hpp>

#include <algorithm>
#include <utility>

namespace glidar {
namespace {

struct RigImuPlan {
  RigImu on_rig;
  std::string file = {};        ///< that it was read from; empty: none
  std::string where_name = {};  ///< for errors
};

/// The IMU of a file or preset; errors state both places.
void load_named_imu(const FieldVisitor& visitor, const char* key, const std::string& name,
                    RigImuPlan& plan) {
  try {
    plan.file = find_imu_file(name).string();
  } catch (const Error& error) {
    const ErrorParts& parts = error.parts();
    visitor.reject(key, parts.found, "a map, " + parts.allowed, parts.remedy);
  }
  try {
    plan.on_rig.imu = load_imu_file(plan.file);
  } catch (const Error& error) {
    reject_at(visitor.where(key), error);
  }
}

/// An IMU: a map, the path of an IMU file, or the name of a preset.
void visit_imu(FieldVisitor& visitor, RigImuPlan& plan) {
  const FieldInfo field = {"imu",
                           "path of an [IMU file](../imu.md), its content as a map, or the name of "
                           "a preset such as `BMI088`",
                           kNoUnit, kRequired};
  std::string name;
  Imu imu = plan.on_rig.imu;
  const auto body = [&](FieldVisitor& nested) { describe(imu, nested); };
  visitor.text_or_object(field, "a map, or the path of an IMU file", name,
                         FieldVisitor::Describe(body));
  if (!visitor.is_reading()) return;
  plan.on_rig.imu = std::move(imu);
  if (name.empty()) return;
  const std::filesystem::path given = name;
  std::string path = name;
  if (given.has_parent_path() || given.has_extension()) visitor.path(field, path);
  load_named_imu(visitor, field.key, path, plan);
}

void describe(RigImuPlan& plan, FieldVisitor& visitor) {
  plan.where_name = visit_rig_name(visitor, plan.on_rig.name);
  visit_imu(visitor, plan);
  visit_pose(visitor,
             {"pose", "rig_from_imu, a [pose](motion.md#poses); of a single sensor sensor_from_imu",
              kNoUnit, false, "identity"},
             true, plan.on_rig.rig_from_imu);
}

/// Names are unique among IMUs and sensors.
void require_unique_names(const std::vector<RigImuPlan>& imus, const ScenePlan& scene) {
  std::vector<std::string> taken;
  for (const RigSensor& sensor : scene.sensors) taken.push_back(sensor.name);
  for (const RigImuPlan& plan : imus) {
    const std::string& name = plan.on_rig.name;
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw Error({plan.where_name, "the name '" + name + "' is given twice", "each name once",
                   "choose another name"});
    }
    taken.push_back(name);
  }
}

void visit_gravity(FieldVisitor& visitor, Eigen::Vector3d& gravity_m_s2) {
  visitor.vector({"gravity_m_s2",
                  "`[x, y, z]`: acceleration of free fall in the world, which IMUs measure; "
                  "`[0, 0, 0]` in space",
                  {"m/s²"},
                  false,
                  "`[0, 0, -9.80665]`"},
                 {-1e6, 1e6, false, "a number from -1e6 to 1e6"}, visitor.is_writing(),
                 gravity_m_s2);
}

}  // namespace

void visit_imus(FieldVisitor& visitor, ScenePlan& plan) {
  std::vector<RigImuPlan> imus;
  for (const RigImu& imu : plan.imus) {
    if (visitor.is_writing()) imus.push_back({imu});
  }
  visit_list(visitor, {"imus", "IMUs on the rig, see [IMUs](../imu.md)", kNoUnit, false, "none"},
             {0, 64}, "at most 64 IMUs", imus);
  visit_gravity(visitor, plan.gravity_m_s2);
  if (!visitor.is_reading()) return;
  require_unique_names(imus, plan);
  for (RigImuPlan& one : imus) {
    if (!one.file.empty()) plan.files.push_back(std::move(one.file));
    plan.imus.push_back(std::move(one.on_rig));
  }
}

}  // namespace glidar
