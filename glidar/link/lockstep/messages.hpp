// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/core/pose.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// The lock-step protocol: a client requests measurements of a scene with poses that it specifies,
/// and receives clouds or an error message. docs/link/lockstep.md has the byte tables. All numbers
/// are little-endian.
namespace glidar::lockstep {

using Bytes = std::span<const std::byte>;

inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::size_t kNameBytes = 24;  ///< of a column's name, padded with zeros
inline constexpr std::uint32_t kMaxColumns = 64;
inline constexpr std::uint32_t kMaxMoments = 65536;
inline constexpr std::uint32_t kMaxObjects = 1'000'000;

/// The pose of a body and its motion during the frame: its origin has a constant velocity, and it
/// rotates at a constant rate about an axis fixed in the world.
struct Body {
  Pose world_from_body = Pose::Identity();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();    ///< in world axes
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of its origin, in world axes
};

/// The parameters of one measurement.
struct Moment {
  std::int64_t t_ns = 0;     ///< start of the frame
  std::uint64_t seed = 0;    ///< of all random numbers
  std::uint32_t number = 0;  ///< of the frame; scanner heads continue from frame to frame
  Body sensor;               ///< the sensor, or the rig of several sensors
  std::vector<Body> objects =
      {};  ///< in the order of the scene; empty: at their poses in the scene
};

/// Requests a description of the sensors and objects.
struct Describe {
  std::uint64_t id = 0;
};

/// Requests clouds.
struct Measure {
  std::uint64_t id = 0;       ///< returned in the reply
  std::uint32_t sensor = 0;   ///< index on the rig
  bool drop_invalid = false;  ///< omits beams without a return
  std::vector<std::string> columns;
  std::vector<Moment> moments;
};

using Request = std::variant<Describe, Measure>;

/// Throws Error with the invalid field unless all sizes, numbers and quaternions are valid. `id` is
/// set as soon as it is known, so that errors can be replied to.
Request decode_request(Bytes message, std::uint64_t& id);

std::vector<std::byte> encode(const Request& request);

/// One measured cloud.
struct CloudHead {
  std::int64_t stamp_ns = 0;
  std::uint64_t seed = 0;
  std::uint32_t number = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;  ///< coordinate frame, at most 31 bytes
  Pose world_from_cloud = Pose::Identity();
};

/// The first part of a reply with clouds. Their numbers follow, one part for each column of the
/// first cloud, then of the second, and so on. All clouds must have the same columns.
std::vector<std::byte> encode_head(std::uint64_t id, std::span<const CloudHead> heads,
                                   const PointCloud& like);

/// A column's numbers as in memory.
Bytes bytes_of(const Column& column);

/// The first part of a reply whose second part is text: an error or a description.
enum class TextKind : std::uint16_t { error = 3, description = 4 };
std::vector<std::byte> encode_text_head(std::uint64_t id, TextKind kind);

}  // namespace glidar::lockstep
