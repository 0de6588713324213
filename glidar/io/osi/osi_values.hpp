// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/io/osi/protobuf_message.hpp>

#include <cstdint>

// Messages of osi_common.proto and osi_version.proto.

namespace glidar::osi {

/// The identifier that refers to no object.
inline constexpr std::uint64_t kNoObject = ~std::uint64_t{0};

/// InterfaceVersion: the version of OSI whose messages are written.
ProtobufMessage interface_version();
ProtobufMessage timestamp(std::int64_t t_ns);
ProtobufMessage identifier(std::uint64_t value);
ProtobufMessage vector3(const Eigen::Vector3d& value);
/// Orientation3d: the angles of R = Rz(yaw) Ry(pitch) Rx(roll), rad.
ProtobufMessage orientation(const Eigen::Matrix3d& rotation);
ProtobufMessage mounting_position(const Pose& vehicle_from_sensor);
/// Spherical3d of a point: its distance, azimuth to the left and elevation.
ProtobufMessage spherical(const Eigen::Vector3d& point_m);

}  // namespace glidar::osi
