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

/// Messages of the Woods 2016 protocol; docs/link/woods2016-protocol.md has the tables. All numbers
/// are little-endian, without padding; the first byte is both the type and the topic.
namespace glidar::woods2016 {

using Bytes = std::span<const std::byte>;

inline constexpr char kCloudTopic = 'c';
inline constexpr char kPlacementTopic = 'v';

/// Maximum deviation of a quaternion's length from 1: attitudes in single precision are valid, a
/// missing or misplaced component is not.
inline constexpr double kQuaternionTolerance = 1e-3;

/// 'v', from a simulator: the poses of object and sensor. The quaternions are attitudes, which
/// rotate inertial vectors into the body:
///   p_sensor = R(sensor) (R(object)^T p_object + translation)
/// in the frame x left, y up, z forward.
struct Placement {
  std::uint64_t timestamp = 0;  ///< of the simulator's clock, in any unit
  Eigen::Quaterniond object = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond sensor = Eigen::Quaterniond::Identity();
};

inline constexpr std::size_t kPlacementBytes = 1 + 8 + 11 * 8;

/// Quaternions are returned normalised. Throws Error unless size and topic are correct, every
/// number is finite, positions are within kMaxCoordinate_m and quaternions have length 1.
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

/// Throws Error unless the topic is correct, the size is that of whole points, and every number is
/// finite.
Cloud decode_cloud(Bytes message);

/// Size in bytes of a cloud message with this number of points.
constexpr std::size_t cloud_bytes(std::size_t points) {
  return 1 + 8 + points * sizeof(CloudPoint);
}

/// Writes the points that are hits and returns the size of the message; `to` must have
/// cloud_bytes(cloud.size()) bytes. The cloud must have the protocol's axes. Throws Error if the
/// column xyz or intensity is missing, or if `to` is too small.
std::size_t encode_cloud(const PointCloud& cloud, std::uint64_t timestamp, std::span<std::byte> to);

/// The message that ends a topic: for example "cKTHXBAI".
std::vector<std::byte> encode_shutdown(std::string_view topic);

/// True for the end message of any topic.
bool is_shutdown(Bytes message);

}  // namespace glidar::woods2016
