// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/osi/ground_truth.hpp>

#include <glidar/core/excerpt.hpp>
#include <glidar/io/osi/object_types.hpp>
#include <glidar/io/osi/osi_values.hpp>
#include <glidar/motion/kinematics.hpp>

#include <cstdint>
#include <string>
#include <variant>

namespace glidar::osi {
namespace {

const std::string& class_name_of(const Scene& scene, const Instance& instance) {
  return scene.class_names.at(instance.class_id);
}

Eigen::AlignedBox3d scaled_box_m(const Scene& scene, const Instance& instance) {
  const Eigen::AlignedBox3d box = bounds(scene.meshes[instance.mesh]);
  if (box.isEmpty()) return Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  return {instance.scale * box.min(), instance.scale * box.max()};
}

ProtobufMessage dimension(const Eigen::Vector3d& size_m) {
  return vector3(size_m);  // length, width and height have the numbers of x, y and z
}

/// Fields 4 and 5 of BaseMoving: the velocity and acceleration of a point fixed to a body.
void add_derivatives(const Trajectory& trajectory, std::int64_t t_ns,
                     const Eigen::Vector3d& point_m, ProtobufMessage& base) {
  Pose body_from_point = Pose::Identity();
  body_from_point.translation() = point_m;
  const KinematicState state = compose_extrinsic(state_at(trajectory, t_ns), body_from_point);
  base.message(4, vector3(state.velocity_m_s)).message(5, vector3(state.acceleration_m_s2));
}

/// ExternalReference: the object's name and class in the scene file.
ProtobufMessage source_reference(const Scene& scene, const Instance& instance) {
  return ProtobufMessage()
      .text(2, "glidar.scene")
      .text(3, printable_line(instance.name))  // texts of Protocol Buffers are UTF-8
      .text(3, printable_line(class_name_of(scene, instance)));
}

ProtobufMessage vehicle_classification(std::uint64_t type) {
  return ProtobufMessage().integer(1, type);
}

}  // namespace

GroundTruthMessages::GroundTruthMessages(const OsiRig& rig) : rig_(rig) {
  for (const Instance& instance : rig.scene.instances)
    boxes_m_.push_back(scaled_box_m(rig.scene, instance));
}

ProtobufMessage GroundTruthMessages::at(const Frame& frame, const Pose& world_from_rig) const {
  ProtobufMessage truth;
  truth.message(1, interface_version())
      .message(2, timestamp(frame.stamp_ns))
      .message(3, identifier(kHostVehicleId));
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (!is_moving_object(i)) truth.message(4, stationary_object(i, frame));
  }
  truth.message(5, host_vehicle(frame.stamp_ns, world_from_rig));
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    if (is_moving_object(i)) truth.message(5, moving_object(i, frame));
  }
  return truth;
}

ProtobufMessage GroundTruthMessages::host_vehicle(std::int64_t t_ns,
                                                  const Pose& world_from_rig) const {
  ProtobufMessage base;
  base.message(1, dimension(Eigen::Vector3d::Zero()))
      .message(2, vector3(world_from_rig.translation()))
      .message(3, orientation(world_from_rig.linear()));
  if (rig_.motion)
    add_derivatives(rig_.motion->world_from_rig, t_ns, Eigen::Vector3d::Zero(), base);
  // bbcenter_to_rear: mounting positions are relative to the rear axle, here the rig's origin
  const ProtobufMessage attributes = ProtobufMessage().message(4, vector3(Eigen::Vector3d::Zero()));
  return ProtobufMessage()
      .message(1, identifier(kHostVehicleId))
      .message(2, base)
      .integer(3, kVehicleType)
      .message(5, attributes)
      .message(6, vehicle_classification(kOtherType));
}

bool GroundTruthMessages::is_moving_object(std::size_t instance) const {
  const Instance& object = rig_.scene.instances[instance];
  if (moving_type(class_name_of(rig_.scene, object)).type != kOtherType) return true;
  if (!rig_.motion) return true;  // a client may move it
  return !std::holds_alternative<ConstantPose>(rig_.motion->world_from_instance[instance]);
}

ProtobufMessage GroundTruthMessages::base(std::size_t instance,
                                          const Pose& world_from_object) const {
  const Eigen::AlignedBox3d& box = boxes_m_[instance];
  return ProtobufMessage()
      .message(1, dimension(box.sizes()))
      .message(2, vector3(world_from_object * box.center()))
      .message(3, orientation(world_from_object.linear()));
}

ProtobufMessage GroundTruthMessages::moving_object(std::size_t instance, const Frame& frame) const {
  const Instance& object = rig_.scene.instances[instance];
  ProtobufMessage base_moving = base(instance, frame.world_from_instance[instance]);
  if (rig_.motion) {
    add_derivatives(rig_.motion->world_from_instance[instance], frame.stamp_ns,
                    boxes_m_[instance].center(), base_moving);
  }
  const MovingType type = moving_type(class_name_of(rig_.scene, object));
  ProtobufMessage moving;
  moving.message(1, identifier(object.id)).message(2, base_moving).integer(3, type.type);
  if (type.type == kVehicleType) moving.message(6, vehicle_classification(type.vehicle_type));
  return moving.text(7, rig_.scene.sources[object.mesh].path)
      .message(10, source_reference(rig_.scene, object));
}

ProtobufMessage GroundTruthMessages::stationary_object(std::size_t instance,
                                                       const Frame& frame) const {
  const Instance& object = rig_.scene.instances[instance];
  const std::uint64_t type = stationary_type(class_name_of(rig_.scene, object));
  return ProtobufMessage()
      .message(1, identifier(object.id))
      .message(2, base(instance, frame.world_from_instance[instance]))
      .message(3, ProtobufMessage().integer(1, type))
      .text(4, rig_.scene.sources[object.mesh].path)
      .message(5, source_reference(rig_.scene, object));
}

}  // namespace glidar::osi
