// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/core/pose.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The lock-step protocol: a client asks for measurements of a world that it places, and gets the
/// clouds or an error in words. docs/link.md has the tables of bytes. All numbers are
/// little-endian.
namespace glidar::lockstep {

using Bytes = std::span<const std::byte>;

inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::size_t kNameBytes = 24;  ///< of a column's name, filled up with zeros
inline constexpr std::uint32_t kMaxColumns = 64;
inline constexpr std::uint32_t kMaxMoments = 65536;
inline constexpr std::uint32_t kMaxObjects = 1'000'000;
inline constexpr std::size_t kMaxRequest_bytes = std::size_t{256} << 20;

/// A body at a moment and how it goes on while the frame is taken: its origin straight on at a
/// constant velocity, turning at a constant rate about an axis fixed in the world.
struct Body {
  Pose world_from_body = Pose::Identity();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();    ///< along the world's axes
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of its origin, likewise
};

/// One measurement.
struct Moment {
  std::int64_t t_ns = 0;           ///< start of the frame
  std::uint64_t seed = 0;          ///< of all random numbers
  std::uint32_t number = 0;        ///< of the frame; scanners' heads turn on from frame to frame
  Body sensor;                     ///< or the rig that several sensors are on
  std::vector<Body> objects = {};  ///< in the order of the scene; empty: where the scene has them
};

/// Asks what there is.
struct Describe {
  std::uint64_t id = 0;
};

/// Asks for clouds.
struct Measure {
  std::uint64_t id = 0;      ///< comes back in the reply
  std::uint32_t sensor = 0;  ///< index on the rig
  bool hits_only = false;    ///< beams without a return are left out
  std::vector<std::string> columns;
  std::vector<Moment> moments;
};

using Request = std::variant<Describe, Measure>;

/// Throws Error naming the field unless every size, number and quaternion is what it should be.
/// `id` is set as soon as it is known, so that errors can be answered.
Request decode_request(Bytes message, std::uint64_t& id);

std::vector<std::byte> encode(const Request& request);

/// One measured cloud.
struct CloudHead {
  std::int64_t stamp_ns = 0;
  std::uint64_t seed = 0;
  std::uint32_t number = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;  ///< that coordinates are in, at most 31 letters
  Pose world_from_cloud = Pose::Identity();
};

/// The first part of a reply with clouds. Their numbers follow, one part for each column of the
/// first cloud, then of the second, ... All clouds must have the same columns.
std::vector<std::byte> encode_head(std::uint64_t id, std::span<const CloudHead> heads,
                                   const PointCloud& like);

/// A column's numbers as they lie in memory.
Bytes bytes_of(const Column& column);

/// The first part of a reply that is a text, which is the second: an error, or a description.
enum class TextKind : std::uint16_t { error = 3, description = 4 };
std::vector<std::byte> encode_text_head(std::uint64_t id, TextKind kind);

}  // namespace glidar::lockstep
