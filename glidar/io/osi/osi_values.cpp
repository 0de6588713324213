// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/osi_values.hpp>

#include <glidar/math/elementary.hpp>

#include <cmath>
#include <numbers>

namespace glidar::osi {
namespace {

/// -pi to pi, the same bits on every machine.
double angle_rad(double y, double x) {
  const double turns = atan2_turns(y, x);
  return 2.0 * std::numbers::pi * (turns > 0.5 ? turns - 1.0 : turns);
}

}  // namespace

ProtobufMessage interface_version() {
  constexpr std::uint64_t kMajor = 3;
  constexpr std::uint64_t kMinor = 8;
  constexpr std::uint64_t kPatch = 0;
  return ProtobufMessage().integer(1, kMajor).integer(2, kMinor).integer(3, kPatch);
}

ProtobufMessage timestamp(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t rest_ns = t_ns % kSecond_ns;
  const std::int64_t nanos = rest_ns < 0 ? rest_ns + kSecond_ns : rest_ns;
  const std::int64_t seconds = t_ns / kSecond_ns - (rest_ns < 0 ? 1 : 0);
  return ProtobufMessage().integer(1, seconds).integer(2, nanos);
}

ProtobufMessage identifier(std::uint64_t value) {
  return ProtobufMessage().integer(1, value);
}

ProtobufMessage vector3(const Eigen::Vector3d& value) {
  return ProtobufMessage().real(1, value.x()).real(2, value.y()).real(3, value.z());
}

ProtobufMessage orientation(const Eigen::Matrix3d& rotation) {
  const double cos_pitch =
      std::sqrt(rotation(0, 0) * rotation(0, 0) + rotation(1, 0) * rotation(1, 0));
  const double pitch = angle_rad(-rotation(2, 0), cos_pitch);
  // looking straight up or down, only yaw - roll or yaw + roll is defined: roll is 0 then
  constexpr double kLocked = 1e-12;
  const bool is_locked = cos_pitch < kLocked;
  const double roll = is_locked ? 0.0 : angle_rad(rotation(2, 1), rotation(2, 2));
  const double yaw = is_locked ? angle_rad(-rotation(0, 1), rotation(1, 1))
                               : angle_rad(rotation(1, 0), rotation(0, 0));
  return ProtobufMessage().real(1, roll).real(2, pitch).real(3, yaw);
}

ProtobufMessage mounting_position(const Pose& vehicle_from_sensor) {
  return ProtobufMessage()
      .message(1, vector3(vehicle_from_sensor.translation()))
      .message(2, orientation(vehicle_from_sensor.linear()));
}

ProtobufMessage spherical(const Eigen::Vector3d& point_m) {
  const double level_m = std::sqrt(point_m.x() * point_m.x() + point_m.y() * point_m.y());
  return ProtobufMessage()
      .real(1, std::sqrt(level_m * level_m + point_m.z() * point_m.z()))
      .real(2, angle_rad(point_m.y(), point_m.x()))
      .real(3, angle_rad(point_m.z(), level_m));
}

}  // namespace glidar::osi
