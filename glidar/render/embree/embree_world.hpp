// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/embree/embree_api.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/render/resolve.hpp>

#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace glidar::embree {

/// Where rays are traced: a frame near the geometry, so that single precision suffices.
struct TraceSpace {
  RTCScene scene;
  Eigen::Matrix3d trace_from_sensor;  ///< rotation
  Eigen::Vector3d sensor_in_trace;
  double metres_per_unit;  ///< of this frame
  Eigen::Vector3d centre;  ///< of a sphere around all geometry
  double radius;
  double least_reach;  ///< World::reach() of those instances that are there
};

/// What a cast hands through Embree to the filter function.
struct FilterContext {
  QueryContext embree;
  const Resolver* resolver;
  const Beams* beams;
  bool cull_back_faces;
};

/// The scene in Embree's structures: one tree per mesh; above them one of instances, unless there
/// is a single instance, whose tree is then entered directly in the object's frame.
class World {
 public:
  explicit World(const Scene& scene);

  /// Takes the poses of the next cast from the resolver's arguments. Meshes are not rebuilt.
  void place(const CastRequest& request);

  /// Lets a filter see every triangle, not only those of materials with an alpha mask.
  void filter_everything();

  [[nodiscard]] const TraceSpace& space() const { return space_; }
  /// Per mesh, in the object's frame.
  [[nodiscard]] const std::vector<Eigen::AlignedBox3d>& mesh_boxes() const { return mesh_boxes_; }
  /// How large coordinates of the trace space may be where an instance is hit: from the space's
  /// zero, or from the middle of a single one, to the far end of a sphere around it.
  [[nodiscard]] double reach(std::uint32_t instance) const { return reach_[instance]; }
  /// See triangle_narrowness().
  [[nodiscard]] const float* narrowness(std::uint32_t instance, std::uint32_t primitive) const {
    return narrowness_of_[instance] + primitive;
  }
  [[nodiscard]] bool has_wide_packets() const { return has_wide_packets_; }

 private:
  struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
  using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

  void add_mesh(const Mesh& mesh, bool filtered);
  void give_vertices(const Mesh& mesh, RTCGeometry geometry) const;
  void add_instances();
  void place_single(const Pose& world_from_sensor, const Pose& world_from_object);
  void place_many(const CastRequest& request);
  void commit_instances(const CastRequest& request);

  const Scene& scene_;
  Device device_;
  bool has_wide_packets_ = false;
  bool filters_everything_ = false;
  std::vector<OwnedScene> mesh_scenes_;          ///< per mesh
  std::vector<Eigen::AlignedBox3d> mesh_boxes_;  ///< per mesh, object frame
  std::vector<std::vector<float>> narrowness_;   ///< per mesh
  std::vector<const float*> narrowness_of_;      ///< per instance
  OwnedScene top_scene_;                         ///< of instances
  std::vector<std::uint8_t> present_;            ///< per instance, as last given to Embree
  std::vector<Pose> placed_;                     ///< per instance, as last given to Embree
  Eigen::Vector3d trace_origin_ =
      Eigen::Vector3d::Zero();  ///< of the instances' frame, in the world
  TraceSpace space_;
  std::vector<double> reach_;  ///< per instance
};

}  // namespace glidar::embree
