// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/io/osi/osi_rig.hpp>
#include <glidar/io/osi/protobuf_message.hpp>

#include <cstdint>
#include <vector>

namespace glidar::osi {

/// The id of the rig as the host vehicle; ids of instances have 32 bits.
inline constexpr std::uint64_t kHostVehicleId = std::uint64_t{1} << 32U;

/// Makes GroundTruth messages (osi_groundtruth.proto) of a rig's frames: the rig as the host
/// vehicle, and the instances as boxes.
class GroundTruthMessages {
 public:
  /// The rig must outlive it.
  explicit GroundTruthMessages(const OsiRig& rig);

  /// The objects at a frame's stamp.
  [[nodiscard]] ProtobufMessage at(const Frame& frame, const Pose& world_from_rig) const;

 private:
  [[nodiscard]] ProtobufMessage host_vehicle(std::int64_t t_ns, const Pose& world_from_rig) const;
  [[nodiscard]] bool is_moving_object(std::size_t instance) const;
  [[nodiscard]] ProtobufMessage moving_object(std::size_t instance, const Frame& frame) const;
  [[nodiscard]] ProtobufMessage stationary_object(std::size_t instance, const Frame& frame) const;
  /// The fields that BaseMoving and BaseStationary share.
  [[nodiscard]] ProtobufMessage base(std::size_t instance, const Pose& world_from_object) const;

  const OsiRig& rig_;
  std::vector<Eigen::AlignedBox3d> boxes_m_;  ///< of each instance, object frame, scaled
};

}  // namespace glidar::osi
