// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// The bytes of a message of Protocol Buffers, field by field (protobuf.dev, "Encoding"). Fields
/// are written even if they have the default value, as proto2 distinguishes both.
class ProtobufMessage {
 public:
  /// int64, uint32, uint64 and enum.
  ProtobufMessage& integer(std::uint32_t field, std::int64_t value);
  ProtobufMessage& integer(std::uint32_t field, std::uint64_t value);
  ProtobufMessage& real(std::uint32_t field, double value);
  /// Bytes that are not UTF-8, which the format does not allow, become '?'.
  ProtobufMessage& text(std::uint32_t field, std::string_view value);
  ProtobufMessage& message(std::uint32_t field, const ProtobufMessage& value);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value);
  ProtobufMessage& bytes(std::uint32_t field, std::string_view value);

  std::string bytes_;
};

}  // namespace glidar

namespace glidar::osi {

inline constexpr std::uint64_t kOtherType = 1;    ///< of all enumerations of types
inline constexpr std::uint64_t kVehicleType = 2;  ///< of MovingObject::Type

/// The types of a moving object.
struct MovingType {
  std::uint64_t type = kOtherType;          ///< MovingObject::Type
  std::uint64_t vehicle_type = kOtherType;  ///< MovingObject::VehicleClassification::Type
};

/// The types of a class, by its name in any case, with spaces, '-' or '_' between words; other
/// names have the type "other".
MovingType moving_type(std::string_view class_name);

/// StationaryObject::Classification::Type of a class, by the same rules for names.
std::uint64_t stationary_type(std::string_view class_name);

}  // namespace glidar::osi

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

/// A sensor whose frames are written.
struct OsiSensor {
  std::uint64_t id = 0;
  const Sensor& sensor;
  Pose rig_from_sensor = Pose::Identity();
};

/// The motion of the rig and of the scene's instances.
struct OsiMotion {
  Trajectory world_from_rig;
  std::vector<Trajectory> world_from_instance;
};

/// What is measured. The scene must outlive its users.
struct OsiRig {
  const Scene& scene;
  std::vector<OsiSensor> sensors;
  /// Empty: known only at the times of frames, by the frames' poses.
  std::optional<OsiMotion> motion = {};
};

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

/// True for the names of OSI traces: with the suffix .osi.
bool is_osi_trace_name(const std::filesystem::path& path);

/// Writes the frames of a rig as a single-channel trace of ASAM OSI: the messages SensorData, each
/// after its size as a little-endian 32-bit integer. docs/osi.md lists the fields. The file appears
/// in finish().
class OsiTraceWriter {
 public:
  /// Throws Error when the file cannot be created.
  OsiTraceWriter(const std::filesystem::path& path, OsiRig rig);

  /// The cloud columns that it reads.
  [[nodiscard]] static const std::vector<std::string>& columns();
  /// Appends a frame of the rig's sensor with this index. Throws Error when the disk is full, or
  /// the message exceeds the 2 GiB that Protocol Buffers allow.
  void write(std::size_t sensor_index, const Frame& frame, const Beams& beams);
  /// Gives the file its name. Without it nothing of it remains.
  void finish();

 private:
  OsiRig rig_;
  GroundTruthMessages ground_truth_;
  AtomicFile file_;
  PointCloud cloud_;  ///< of the last frame; reuses its memory, like `detected_`
  PointCloud detected_;
};

}  // namespace glidar::osi
