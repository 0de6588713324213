// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/displacement_text.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glidar {
namespace {

constexpr double kNegligible = 1e-3;

std::string rounded_text(double value) {
  constexpr std::size_t kRoom = 32;
  std::array<char, kRoom> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.4g", value + 0.0);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string triple_text(const Eigen::Vector3d& v, double negligible) {
  std::string text;
  for (const double value : {v.x(), v.y(), v.z()}) {
    text += (text.empty() ? "(" : ", ") + rounded_text(std::abs(value) < negligible ? 0.0 : value);
  }
  return text + ")";
}

/// "x" for the directions +x and -x, and so on, else the components.
std::string axis_text(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  const double length = direction.cwiseAbs().maxCoeff(&axis);
  const double others = std::sqrt(std::max(0.0, direction.squaredNorm() - length * length));
  if (others < kNegligible * length) return std::string(1, "xyz"[axis]);
  return triple_text(direction[axis] < 0.0 ? Eigen::Vector3d(-direction) : direction, 1e-4);
}

}  // namespace

std::string describe_displacement(const Vector6& displacement, double length_m) {
  const Eigen::Vector3d rotation = displacement.head<3>();
  const Eigen::Vector3d translation = displacement.tail<3>();
  if (rotation.norm() * length_m < kNegligible * translation.norm()) {
    return "translation along " + axis_text(translation.normalized());
  }
  // Chasles: every displacement is a screw. Lynch & Park, "Modern Robotics" (2017),
  // section 3.3.2.2.
  const double turn2 = rotation.squaredNorm();
  const Eigen::Vector3d point = rotation.cross(translation) / turn2;
  const double pitch = rotation.dot(translation) / turn2;
  const double negligible = kNegligible * length_m;
  std::string text = "rotation about " + axis_text(rotation.normalized());
  if (point.norm() > negligible) text += " through " + triple_text(point, negligible) + " m";
  if (std::abs(pitch) > negligible) text += ", with " + rounded_text(pitch) + " m along it per rad";
  return text;
}

}  // namespace glidar
