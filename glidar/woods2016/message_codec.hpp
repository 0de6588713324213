// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// The protocol of the 2015 program: bytes and what they mean. docs/link.md has the tables. All
/// numbers are little-endian, without padding; the first byte is the type and the topic.
namespace glidar::legacy {

using Bytes = std::span<const std::byte>;

inline constexpr char kCloudTopic = 'c';
inline constexpr char kPlacementTopic = 'v';

/// How far from 1 the length of a quaternion may be: attitudes in single precision pass, a
/// forgotten or misplaced component does not.
inline constexpr double kQuaternionTolerance = 1e-3;

/// 'v', from a simulator: where object and sensor are. The quaternions are attitudes, they take
/// inertial vectors into the body:
///   p_sensor = R(sensor) (R(object)^T p_object + translation)
/// in the frame x left, y up, z forward.
struct Placement {
  std::uint64_t timestamp = 0;  ///< of the simulator's clock, in any unit
  Eigen::Quaterniond object = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond sensor = Eigen::Quaterniond::Identity();
};

inline constexpr std::size_t kPlacementBytes = 1 + 8 + 11 * 8;

/// Quaternions come normalised. Throws Error unless the message has its size and topic, every
/// number is finite, positions are within kMaxCoordinate_m and quaternions of length 1.
Placement decode_placement(Bytes message);

std::array<std::byte, kPlacementBytes> encode_placement(const Placement& placement);

/// 'c', to subscribers: x y z in metres (x left, y up, z forward) and intensity.
struct CloudPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float intensity = 0.0F;
};

struct Cloud {
  std::uint64_t timestamp = 0;
  std::vector<CloudPoint> points;
};

/// Throws Error unless the message has the topic and a size of whole points, and every number of
/// them is finite.
Cloud decode_cloud(Bytes message);

/// Bytes of a cloud of so many points.
constexpr std::size_t cloud_bytes(std::size_t points) {
  return 1 + 8 + points * sizeof(CloudPoint);
}

/// Writes the cloud's points that are hits and returns how many bytes they take; `to` must have
/// cloud_bytes(cloud.size()). The cloud's axes must be the protocol's. Throws Error when it lacks
/// the column xyz or intensity, and when `to` is too small.
std::size_t encode_cloud(const PointCloud& cloud, std::uint64_t timestamp, std::span<std::byte> to);

/// The bytes that tell subscribers of a topic that it ends: "cKTHXBAI".
std::vector<std::byte> encode_shutdown(std::string_view topic);

/// True for these bytes, of any topic.
bool is_shutdown(Bytes message);

}  // namespace glidar::legacy
