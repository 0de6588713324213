// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/pose_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose.hpp>

#include <algorithm>
#include <vector>

namespace glidar {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr NumberRule kCoordinate = {-kMaxCoordinate_m, kMaxCoordinate_m, false,
                                    "a number from -1e15 to 1e15"};
constexpr const char* kNone = "none";

void describe_quaternion(Quaterniond& q, FieldVisitor& visitor) {
  visitor.number({"w", "scalar part", kNoUnit, kRequired}, kFinite, q.w());
  visitor.number({"x", "vector part", kNoUnit, kRequired}, kFinite, q.x());
  visitor.number({"y", "vector part", kNoUnit, kRequired}, kFinite, q.y());
  visitor.number({"z", "vector part", kNoUnit, kRequired}, kFinite, q.z());
  if (!visitor.is_reading()) return;
  const double max = q.coeffs().cwiseAbs().maxCoeff();
  if (max == 0.0) {
    visitor.reject("", "a quaternion of zeros", "a quaternion of any other length");
  }
  q.coeffs() /= max;  // so that its length neither overflows nor vanishes
}

void visit_quaternion(FieldVisitor& visitor, Quaterniond& rotation) {
  if (visitor.is_list("orientation")) {
    visitor.reject("orientation", "{}", "a map with the keys w, x, y, z",
                   "name the parts: {w: 1, x: 0, y: 0, z: 0}; their order in a list is ambiguous");
  }
  const auto body = [&](FieldVisitor& nested) { describe_quaternion(rotation, nested); };
  visitor.object(
      {"orientation", "quaternion `{w: , x: , y: , z: }`, all four, not all 0; it is normalised",
       kNoUnit, false, kNone},
      visitor.is_writing(), FieldVisitor::Describe(body));
}

void visit_rotation_vector(FieldVisitor& visitor, Quaterniond& rotation) {
  Vector3d vector = Vector3d::Zero();
  const FieldUnit radian = {"rad"};
  if (!visitor.vector({"rotation_vector", "`[x, y, z]`: axis times angle", radian, false, kNone},
                      kFinite, false, vector)) {
    return;
  }
  const double angle_rad = vector.stableNorm();
  rotation = angle_rad == 0.0 ? Quaterniond::Identity() : axis_angle(vector / angle_rad, angle_rad);
}

void visit_euler_angles(FieldVisitor& visitor, Quaterniond& rotation) {
  Vector3d rpy_rad = Vector3d::Zero();
  const auto body = [&](FieldVisitor& nested) {
    nested.number({"roll", "about x", kUnitDegree}, kFinite, rpy_rad.x());
    nested.number({"pitch", "about y", kUnitDegree}, kFinite, rpy_rad.y());
    nested.number({"yaw", "about z", kUnitDegree}, kFinite, rpy_rad.z());
  };
  if (!visitor.object({"euler_deg",
                       "`{roll: , pitch: , yaw: }`, each 0 by default, about the fixed axes x, "
                       "then y, then z (REP-103)",
                       kUnitDegree, false, kNone},
                      false, FieldVisitor::Describe(body))) {
    return;
  }
  rotation = roll_pitch_yaw(rpy_rad);
}

/// The rows [R t] of the matrix, in which documents keep every bit.
void visit_matrix(FieldVisitor& visitor, Pose& pose) {
  constexpr std::size_t kCount = 12;
  for (const char* key : {"position", "orientation", "rotation_vector", "euler_deg"}) {
    visitor.at_most_one({{key, "matrix"}, "matrix alone, or a position and a rotation"});
  }
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows = pose.matrix().topRows<3>();
  std::vector<double> numbers;
  if (visitor.is_writing()) numbers.assign(rows.data(), rows.data() + kCount);
  visitor.numbers({"matrix",
                   "the rotation matrix and the position, `[R t]`, row by row, instead of the "
                   "other keys",
                   kNoUnit, false, kNone},
                  {.number = kCoordinate,
                   .min_size = kCount,
                   .max_size = kCount,
                   .allowed = "a list of 12 numbers"},
                  numbers);
  if (!visitor.is_reading() || numbers.empty()) return;
  constexpr double kRounded = 1e-3;  // of matrices with few digits
  std::copy(numbers.begin(), numbers.end(), rows.data());
  pose.affine() = rows;
  if (is_rigid(pose)) return;
  if (!is_rigid(pose, kRounded)) {
    visitor.reject("matrix", "not a rotation", "a rotation within 0.001, with its position");
  }
  pose = make_pose(pose.translation(), Quaterniond(pose.linear()));
}

void describe_look_at(PoseKeys& keys, FieldVisitor& visitor) {
  Vector3d eye = Vector3d::Zero();
  Vector3d target = Vector3d::Zero();
  Vector3d up = Vector3d::Zero();
  visitor.vector({"eye", "position of the sensor", kUnitMetre, kRequired}, kCoordinate, false, eye);
  visitor.vector({"target", "point that it looks at", kUnitMetre, kRequired}, kCoordinate, false,
                 target);
  const bool has_up = visitor.vector({"up", "direction that is up in the image", kNoUnit, false,
                                      "+z, or +x for a vertical line of sight"},
                                     kFinite, false, up);
  if (!visitor.is_reading()) return;
  keys.looks_at = true;
  try {
    keys.pose = has_up ? look_at(eye, target, up) : look_at(eye, target);
  } catch (const Error& error) {
    visitor.reject("", error.parts().found, error.parts().allowed, error.parts().remedy);
  }
}

void visit_look_at(FieldVisitor& visitor, PoseKeys& keys) {
  for (const char* key : {"position", "orientation", "rotation_vector", "euler_deg", "matrix"}) {
    visitor.at_most_one({{key, "look_at"}, "look_at alone, or a position and a rotation"});
  }
  const auto body = [&](FieldVisitor& nested) { describe_look_at(keys, nested); };
  visitor.object(
      {"look_at", "`{eye: [x, y, z], target: [x, y, z], up: [x, y, z]}` instead of the other keys",
       kUnitMetre, false, kNone},
      false, FieldVisitor::Describe(body));
}

}  // namespace

void describe(PoseKeys& keys, FieldVisitor& visitor) {
  if (visitor.is_document()) return visit_matrix(visitor, keys.pose);
  visitor.at_most_one({{"orientation", "rotation_vector", "euler_deg"},
                       "one of orientation, rotation_vector, euler_deg"});
  Vector3d position_m = keys.pose.translation();
  Quaterniond rotation(keys.pose.linear());
  visitor.vector({"position", "x, y, z", kUnitMetre, false, "`[0, 0, 0]`"}, kCoordinate,
                 visitor.is_writing(), position_m);
  visit_quaternion(visitor, rotation);
  visit_rotation_vector(visitor, rotation);
  visit_euler_angles(visitor, rotation);
  if (visitor.is_reading()) keys.pose = make_pose(position_m, rotation);
  if (!visitor.is_report()) visit_matrix(visitor, keys.pose);
  if (keys.takes_look_at) visit_look_at(visitor, keys);
}

bool visit_pose(FieldVisitor& visitor, const FieldInfo& field, bool is_present, PoseKeys& keys) {
  const auto body = [&](FieldVisitor& nested) { describe(keys, nested); };
  return visitor.object(field, is_present, FieldVisitor::Describe(body));
}

bool visit_pose(FieldVisitor& visitor, const FieldInfo& field, bool is_present, Pose& pose) {
  PoseKeys keys;
  if (is_present) keys.pose = pose;
  const bool is_given = visit_pose(visitor, field, is_present, keys);
  if (visitor.is_reading() && is_given) pose = keys.pose;
  return is_given;
}

}  // namespace glidar
