// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/pose_yaml.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

namespace glidar {
namespace {

Eigen::Quaterniond read_quaternion(const YamlField& field) {
  if (field.node.IsSequence()) {
    reject(field, content_text(field), "a map with the keys w, x, y, z",
           "name the parts: {w: 1, x: 0, y: 0, z: 0}; their order in a list is ambiguous");
  }
  require_map(field, {"w", "x", "y", "z"});
  const auto part = [&](const char* key) { return number(need(field, key), kFinite); };
  Eigen::Quaterniond q(part("w"), part("x"), part("y"), part("z"));
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (largest == 0.0) reject(field, "a quaternion of zeros", "a quaternion of any other length");
  q.coeffs() /= largest;  // so that its length neither overflows nor vanishes
  return q;
}

Eigen::Quaterniond read_rotation_vector(const YamlField& field) {
  const Eigen::Vector3d vector = triple(field, kFinite);
  const double angle_rad = vector.stableNorm();
  if (angle_rad == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, vector / angle_rad));
}

/// About the fixed axes x, then y, then z (REP-103).
Eigen::Quaterniond read_euler(const YamlField& field) {
  require_map(field, {"roll", "pitch", "yaw"});
  const auto turn = [&](const char* key, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(number_or(field, key, kFinite, 0.0) * kDegree, axis);
  };
  return turn("yaw", Eigen::Vector3d::UnitZ()) * turn("pitch", Eigen::Vector3d::UnitY()) *
         turn("roll", Eigen::Vector3d::UnitX());
}

using ReadRotation = Eigen::Quaterniond (*)(const YamlField&);
constexpr std::pair<const char*, ReadRotation> kRotations[] = {
    {"orientation", read_quaternion},
    {"rotation_vector", read_rotation_vector},
    {"euler_deg", read_euler},
};

/// The pose of a map whose keys are checked already.
Pose pose_of(const YamlField& field) {
  const auto position = find(field, "position");
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  std::string chosen;
  for (const auto& [key, read] : kRotations) {
    const auto given = find(field, key);
    if (!given) continue;
    if (!chosen.empty()) {
      reject(*given, "given beside '" + chosen + "'",
             "one of orientation, rotation_vector, euler_deg", "remove one of them");
    }
    chosen = key;
    rotation = read(*given);
  }
  return make_pose(position ? triple(*position, kCoordinate) : Eigen::Vector3d::Zero(), rotation);
}

Pose read_look_at(const YamlField& field) {
  require_map(field, {"eye", "target", "up"});
  const Eigen::Vector3d eye = triple(need(field, "eye"), kCoordinate);
  const Eigen::Vector3d target = triple(need(field, "target"), kCoordinate);
  const auto up = find(field, "up");
  try {
    return up ? look_at(eye, target, triple(*up, kFinite)) : look_at(eye, target);
  } catch (const Error& error) {
    reject(field, error.parts().found, error.parts().allowed, error.parts().remedy);
  }
}

}  // namespace

Pose read_pose(const YamlField& field) {
  require_map(field, {"position", "orientation", "rotation_vector", "euler_deg"});
  return pose_of(field);
}

Pose read_sensor_pose(const YamlField& field) {
  require_map(field, {"position", "orientation", "rotation_vector", "euler_deg", "look_at"});
  const auto target = find(field, "look_at");
  if (!target) return pose_of(field);
  if (field.node.size() > 1) {
    reject(*target, "given beside other keys", "look_at alone, or a position and a rotation",
           "remove one of them");
  }
  return read_look_at(*target);
}

}  // namespace glidar
