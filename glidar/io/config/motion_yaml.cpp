// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/motion_yaml.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/pose_yaml.hpp>
#include <glidar/io/formats/trajectory_file.hpp>
#include <glidar/math/constants.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr NumberRule kRate = {-1e9, 1e9, false, "a number from -1e9 to 1e9"};
constexpr NumberRule kSpeed = {-kMaxCoordinate_m, kMaxCoordinate_m, false,
                               "a number from -1e15 to 1e15"};
constexpr NumberRule kTime_s = {-9.2e9, 9.2e9, false, "seconds from -9.2e9 to 9.2e9"};
constexpr NumberRule kRate_hz = {0.01, 1e9, false, "a number from 0.01 to 1e9"};

/// rate_rad_s or rate_deg_s; exactly one of them must be there.
Eigen::Vector3d read_rate(const YamlField& map) {
  const auto radians = find(map, "rate_rad_s");
  const auto degrees = find(map, "rate_deg_s");
  if (radians && degrees) {
    reject(*degrees, "given beside 'rate_rad_s'", "one of rate_rad_s, rate_deg_s",
           "remove one of them");
  }
  if (radians) return triple(*radians, kRate);
  if (degrees) return triple(*degrees, kRate) * kDegree;
  reject(map, "the rate is missing", "rate_rad_s or rate_deg_s", "add 'rate_rad_s: [0, 0, 0.1]'");
}

Eigen::Vector3d read_velocity(const YamlField& map) {
  const auto velocity = find(map, "velocity_m_s");
  return velocity ? triple(*velocity, kSpeed) : Eigen::Vector3d::Zero();
}

Trajectory read_spin(const YamlField& field, const Pose& start) {
  require_map(field, {"rate_rad_s", "rate_deg_s"});
  return Spin{.pose = start, .rate_rad_s = read_rate(field)};
}

Trajectory read_twist(const YamlField& field, const Pose& start) {
  require_map(field, {"rate_rad_s", "rate_deg_s", "velocity_m_s", "frame"});
  ConstantTwist twist{.pose = start, .linear_m_s = read_velocity(field)};
  if (find(field, "rate_rad_s") || find(field, "rate_deg_s")) {
    twist.angular_rad_s = read_rate(field);
  }
  if (const auto frame = find(field, "frame")) {
    twist.frame = static_cast<TwistFrame>(one_of(*frame, {"body", "world"}));
  }
  return twist;
}

Trajectory read_tumbling(const YamlField& field, const Pose& start) {
  require_map(field, {"moments_kg_m2", "rate_rad_s", "rate_deg_s", "velocity_m_s", "principal"});
  const YamlField moments = need(field, "moments_kg_m2");
  InitialRotation tumbling{.moments_kg_m2 = triple(moments, kAboveZero),
                           .rate_rad_s = read_rate(field),
                           .world_from_body = start,
                           .velocity_m_s = read_velocity(field)};
  if (const auto axes = find(field, "principal")) tumbling.body_from_principal = read_pose(*axes);
  try {
    return TorqueFreeRotation(tumbling);
  } catch (const Error& error) {
    reject(moments, error.parts().found, error.parts().allowed, error.parts().remedy);
  }
}

/// A path of the file, seen from the file's own folder; the file must be there.
std::string existing_file(const YamlField& field) {
  const std::string path = path_beside(field);
  if (fs::exists(path)) return path;
  reject(field, "no such file: " + path, "the path of a trajectory file",
         "paths are relative to the folder of this file");
}

Trajectory read_trajectory(const YamlField& field, std::vector<std::string>& files) {
  if (!field.node.IsMap()) {
    files.push_back(existing_file(field));
    return load_trajectory_file(files.back());
  }
  require_map(field, {"file", "rate_hz", "times", "start_s"});
  const std::string file = existing_file(need(field, "file"));
  TrajectoryFileOptions options;
  if (const auto rate = find(field, "rate_hz")) options.rate_hz = number(*rate, kRate_hz);
  if (const auto times = find(field, "times")) {
    options.times_file = existing_file(*times);
    files.push_back(options.times_file.string());
  }
  if (const auto start = find(field, "start_s")) {
    options.start_ns = std::llround(number(*start, kTime_s) * 1e9);
  }
  files.push_back(file);
  return load_trajectory_file(file, options);
}

using ReadFromPose = Trajectory (*)(const YamlField&, const Pose&);
constexpr std::array<std::pair<const char*, ReadFromPose>, 3> kFromPose = {
    {{"spin", read_spin}, {"twist", read_twist}, {"tumbling", read_tumbling}}};

}  // namespace

Trajectory read_motion(const YamlField& field, const std::optional<Pose>& start,
                       std::vector<std::string>& files) {
  require_map(field, {"spin", "twist", "tumbling", "trajectory"});
  if (field.node.size() != 1) {
    reject(field, std::to_string(field.node.size()) + " kinds of motion",
           "one of spin, twist, tumbling, trajectory");
  }
  for (const auto& [key, read] : kFromPose) {
    if (const auto kind = find(field, key)) return read(*kind, start.value_or(Pose::Identity()));
  }
  const YamlField file = need(field, "trajectory");
  if (start) {
    reject(file, "given beside a pose", "a pose, or a trajectory, which gives the poses itself",
           "remove one of them");
  }
  return read_trajectory(file, files);
}

}  // namespace glidar
