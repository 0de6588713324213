// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/render/lanes.hpp>

#include <cstddef>

namespace glidar {

/// The sensor in the frame of an instance: object units, relative to the mesh's origin.
struct InstanceView {
  Eigen::Matrix3d object_from_sensor;  ///< rotation
  Eigen::Vector3d sensor_in_object;    ///< the sensor's origin
  double scale;                        ///< metres per object unit
};

InstanceView view_of(const Instance& instance, const Mesh& mesh, const Pose& world_from_object,
                     const Pose& world_from_sensor);

/// From a point relative to the mesh's origin into the sensor's frame, metres.
Eigen::Matrix<double, 3, 4> sensor_from_object(const InstanceView& view);

/// A beam in an instance's view: origin and unit direction.
struct ObjectRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

ObjectRay ray_in(const InstanceView& view, const Beams& beams, std::size_t beam);

/// The beams of a block, in the sensor frame.
struct BeamBlock {
  Lanes3<double> direction;
  Lanes3<double> origin_m;
  bool has_origins = false;  ///< else they start at the sensor's origin, and origin_m is unset
};

/// The beams in an instance's frame, lane by lane as ray_in().
void rays_in(const InstanceView& view, const BeamBlock& beams, Lanes3<double>& origin,
             Lanes3<double>& direction);

}  // namespace glidar
