// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/moving_cast.hpp>

#include <glidar/simulate/start_from_sensor.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace glidar {
namespace {

constexpr std::size_t kMovedBeamsPerTask = 1024;

bool is_static(const Trajectory& trajectory) {
  return std::holds_alternative<ConstantPose>(trajectory);
}

/// A sphere around an instance at the start of the frame, in the sensor's frame of that time.
struct Sphere {
  Eigen::Vector3d centre;
  double radius = std::numeric_limits<double>::infinity();
};

Sphere bounding_sphere(const Instance& instance, const Eigen::AlignedBox3d& box,
                       const Pose& world_from_object, const Pose& world_from_sensor) {
  constexpr double kClear = 1.001;  // also after rounding
  if (box.isEmpty()) return {Eigen::Vector3d::Zero(), 0.0};
  const Eigen::Vector3d middle =
      world_from_object.linear() * (instance.scale * box.center()) +
      (world_from_object.translation() - world_from_sensor.translation());
  return {world_from_sensor.linear().transpose() * middle,
          kClear * instance.scale * 0.5 * box.diagonal().norm()};
}

bool may_hit(const Sphere& sphere, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction) {
  if (std::isinf(sphere.radius)) return true;
  const Eigen::Vector3d to_centre = sphere.centre - origin;
  const double along = std::max(0.0, to_centre.dot(direction));
  return (to_centre - along * direction).squaredNorm() <= sphere.radius * sphere.radius;
}

/// A moving instance and its pose during a frame.
struct Body {
  const Trajectory& world_from_body;
  Pose at_start;
  Sphere sphere;
};

/// The pose of the sensor at a time relative to the body at rest, in the sensor's frame at the
/// start: S0^-1 * B0 * B^-1 * S with the poses B and S at that time. Positions are subtracted
/// first, for full precision far from the world's origin.
Pose start_from_sensor(const Body& body, const Pose& s0, const Pose& b, const Pose& s) {
  Pose pose = Pose::Identity();
  const Eigen::Matrix3d back = s0.linear().transpose();
  const Pose& b0 = body.at_start;
  const Eigen::Matrix3d held = b0.linear() * b.linear().transpose();
  pose.linear() = back * held * s.linear();
  pose.translation() =
      back * (held * (s.translation() - b.translation()) + (b0.translation() - s0.translation()));
  return pose;
}

/// Calls work(beam, world_from_sensor, world_from_body) for beams of a run with the poses at their
/// firing times.
template <class Work>
void for_each_firing(const Trajectory& sensor, const Body& body, std::int64_t stamp_ns,
                     const Beams& beams, BeamRange range, const Work& work) {
  constexpr std::size_t kAtOnce = 128;
  std::array<std::int64_t, kAtOnce> t_ns;
  std::array<Pose, kAtOnce> sensors;
  std::array<Pose, kAtOnce> bodies;
  for (std::size_t first = range.begin; first < range.end; first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, range.end - first);
    for (std::size_t k = 0; k < count; ++k) {
      t_ns[k] = stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[first + k]);
    }
    const std::span<const std::int64_t> times(t_ns.data(), count);
    poses_at(sensor, times, {sensors.data(), count});
    poses_at(body.world_from_body, times, {bodies.data(), count});
    for (std::size_t k = 0; k < count; ++k) work(first + k, sensors[k], bodies[k]);
  }
}

/// Expresses a run of beams in the frame in which a body is at rest; those that cannot hit it get
/// no direction.
void express_beams(const CastRequest& request, const Motion& motion, const Body& body,
                   std::int64_t stamp_ns, BeamRange range, MovingCastWorkspace& memory) {
  const Beams& beams = request.beams;
  const auto move = [&](std::size_t i, const Pose& sensor, const Pose& body_pose) {
    const Pose pose = start_from_sensor(body, request.world_from_sensor, body_pose, sensor);
    memory.start_from_sensor[i] = pose.linear();
    Eigen::Vector3d& direction = memory.beams.directions[i];
    Eigen::Vector3d& origin = memory.beams.origins_m[i];
    direction = (pose.linear() * beams.directions[i]).normalized();
    origin =
        beams.origins_m.empty() ? Eigen::Vector3d(pose.translation()) : pose * beams.origins_m[i];
    if (!may_hit(body.sphere, origin, direction)) {
      direction.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  };
  for_each_firing(motion.world_from_sensor, body, stamp_ns, beams, range, move);
}

/// The part of a column in a run of beams; empty for an empty column.
template <class Column>
auto part_of(Column& column, BeamRange run) {
  const std::span all(column);
  return all.empty() ? all : all.subspan(run.begin, run.end - run.begin);
}

/// Calls work(run, start_from_sensor) for short runs of beams in a range.
template <class Work>
void for_each_run(const MovingSensor& sensor, const Beams& beams, BeamRange range,
                  const Work& work) {
  PoseBlock poses;
  for (std::size_t first = range.begin; first < range.end; first += PoseBlock::kSize) {
    const BeamRange run{first, std::min(first + PoseBlock::kSize, range.end)};
    find_start_from_sensor(sensor, beams, run, poses);
    work(run, poses);
  }
}

/// True when hits have vectors in the sensor's frame.
bool has_vectors(const HitColumnMask& hit_columns) {
  return hit_columns.normal || hit_columns.shading_normal;
}

/// Expresses a run of beams in the sensor's frame at the start, in which all that is static is at
/// rest.
void express_beams(const CastRequest& request, const MovingSensor& sensor, BeamRange range,
                   MovingCastWorkspace& memory) {
  const Beams& beams = request.beams;
  for_each_run(sensor, beams, range, [&](BeamRange run, const PoseBlock& poses) {
    rotate_directions(poses, part_of(beams.directions, run), part_of(memory.beams.directions, run));
    transform_origins(poses, part_of(beams.origins_m, run), part_of(memory.beams.origins_m, run));
    if (!has_vectors(request.hit_columns)) return;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      memory.start_from_sensor[i] = poses.rotation_at(i - run.begin);
    }
  });
}

/// Expresses what depends on the sensor's frame in its frame at the beam's firing time.
void rotate_to_firing_time(const CastRequest& request, const MovingCastWorkspace& memory,
                           BeamRange range, Hits& hits) {
  if (!has_vectors(request.hit_columns) && !request.hit_columns.depth) return;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    const Eigen::Matrix3d back = memory.start_from_sensor[i].transpose();
    const auto rotate = [&](Eigen::Vector3f& v) { v = (back * v.cast<double>()).cast<float>(); };
    if (request.hit_columns.normal) rotate(hits.normal[i]);
    if (request.hit_columns.shading_normal) rotate(hits.shading_normal[i]);
    if (request.hit_columns.depth) hits.depth_m[i] = depth_m(request.beams, i, hits.range_m[i]);
  }
}

/// Keeps the nearer of two hits; at the same range that of the body cast first.
void merge(const Hits& from, const HitColumnMask& hit_columns, BeamRange range, Hits& to) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (from.instance[i] == kInvalidId) continue;
    if (to.instance[i] == kInvalidId || from.range_m[i] < to.range_m[i])
      copy_hit(from, i, hit_columns, to, i);
  }
}

/// Sizes the memory and fills in what all bodies share.
void prepare(const Scene& scene, const Beams& beams, MovingCastWorkspace& memory) {
  memory.beams.rows = beams.rows;
  memory.beams.cols = beams.cols;
  memory.beams.frame_id = beams.frame_id;
  memory.beams.boresight = beams.boresight;
  memory.beams.directions.resize(beams.size());
  memory.beams.origins_m.resize(beams.size());
  memory.start_from_sensor.resize(beams.size());
  memory.mesh_boxes.resize(scene.meshes.size());
}

/// The box of a mesh, which is computed once.
const Eigen::AlignedBox3d& mesh_box(const Scene& scene, std::uint32_t mesh,
                                    MovingCastWorkspace& memory) {
  std::optional<Eigen::AlignedBox3d>& box = memory.mesh_boxes[mesh];
  if (!box) box = bounds(scene.meshes[mesh]);
  return *box;
}

/// Expresses all beams in the frame in which a body is at rest; nullptr: all that is static.
void express_all_beams(const TimedScene& timed, const CastRequest& request, const Body* body,
                       MovingCastWorkspace& memory) {
  const Motion& motion = timed.motion;
  const MovingSensor sensor{motion.world_from_sensor, request.world_from_sensor, timed.stamp_ns};
  timed.renderer.thread_pool().parallel_for(
      request.beams.size(), kMovedBeamsPerTask, [&](std::size_t begin, std::size_t end) {
        if (body == nullptr) return express_beams(request, sensor, {begin, end}, memory);
        express_beams(request, motion, *body, timed.stamp_ns, {begin, end}, memory);
      });
}

/// An instance as a moving body.
Body body_of(const TimedScene& timed, const CastRequest& request, std::uint32_t i,
             MovingCastWorkspace& memory) {
  const Instance& instance = timed.scene.instances[i];
  const Pose& at_start = request.world_from_instance[i];
  return {.world_from_body = timed.motion.world_from_instance[i],
          .at_start = at_start,
          .sphere = bounding_sphere(instance, mesh_box(timed.scene, instance.mesh, memory),
                                    at_start, request.world_from_sensor)};
}

/// One cast that is in progress.
struct MovingCast {
  const TimedScene& timed;
  const CastRequest& request;
  MovingCastWorkspace& memory;
  Hits& hits;

  template <class Work>
  void parallel_for(const Work& work) const {
    timed.renderer.thread_pool().parallel_for(request.beams.size(), kMovedBeamsPerTask,
                                              [&](std::size_t begin, std::size_t end) {
                                                work(BeamRange{begin, end});
                                              });
  }
};

/// Which of the bodies is cast.
struct BodyIndex {
  std::size_t number = 0;
  std::size_t count = 1;
};

/// Casts the instances of memory.instance_enabled, which are the body; nullptr: all that is static.
/// The first body fills the hits.
void cast_body(const MovingCast& cast, const Body* body, const BodyIndex& body_index) {
  const bool is_first = body_index.number == 0;
  MovingCastWorkspace& memory = cast.memory;
  const CastRequest& request = cast.request;
  Hits& hits = is_first ? cast.hits : memory.hits;
  const auto part = [&](std::size_t number) {
    return static_cast<double>(number) / static_cast<double>(body_index.count);
  };
  express_all_beams(cast.timed, request, body, memory);
  const bool is_sensor_static = is_static(cast.timed.motion.world_from_sensor);
  cast.timed.renderer.cast({.beams = memory.beams,
                            .world_from_sensor = request.world_from_sensor,
                            .world_from_instance = request.world_from_instance,
                            .hit_columns = request.hit_columns,
                            .cull_back_faces = request.cull_back_faces,
                            .instance_enabled = memory.instance_enabled,
                            .beams_recur = body == nullptr && is_sensor_static,
                            .progress = subrange(request.progress, part(body_index.number),
                                                 part(body_index.number + 1))},
                           hits);
  cast.parallel_for([&](BeamRange range) {
    rotate_to_firing_time(request, memory, range, hits);
    if (!is_first) merge(hits, request.hit_columns, range, cast.hits);
  });
}

/// Casts all that is static, then every moving instance.
void cast_bodies(const MovingCast& cast) {
  MovingCastWorkspace& memory = cast.memory;
  const Scene& scene = cast.timed.scene;
  const std::vector<Trajectory>& trajectories = cast.timed.motion.world_from_instance;
  const auto is_cast_apart = [&](std::size_t i) {
    return !is_static(trajectories[i]) && is_enabled(cast.request, i);
  };
  memory.instance_enabled.assign(scene.instances.size(), 0);
  BodyIndex body_index;
  for (std::size_t i = 0; i < memory.instance_enabled.size(); ++i) {
    const bool is_enabled_here = is_static(trajectories[i]) && is_enabled(cast.request, i);
    memory.instance_enabled[i] = static_cast<std::uint8_t>(is_enabled_here);
    body_index.count += is_cast_apart(i) ? 1 : 0;
  }
  cast_body(cast, nullptr, body_index);
  for (std::uint32_t i = 0; i < memory.instance_enabled.size(); ++i) {
    if (!is_cast_apart(i)) continue;
    memory.instance_enabled.assign(scene.instances.size(), 0);
    memory.instance_enabled[i] = 1;
    ++body_index.number;
    const Body body = body_of(cast.timed, cast.request, i, memory);
    cast_body(cast, &body, body_index);
  }
}

}  // namespace

bool moves(const Motion& motion) {
  return !is_static(motion.world_from_sensor) ||
         !std::all_of(motion.world_from_instance.begin(), motion.world_from_instance.end(),
                      is_static);
}

bool moves_during_frame(const Motion& motion, const Beams& beams) {
  return !beams.times_ns.empty() && moves(motion);
}

void cast_moving(const TimedScene& scene, const CastRequest& request,
                 MovingCastWorkspace& workspace, Hits& hits) {
  prepare(scene.scene, request.beams, workspace);
  const MovingCast cast{scene, request, workspace, hits};
  cast_bodies(cast);
  if (request.on_tile_done) cast.parallel_for(request.on_tile_done);
}

const Beams& beams_at_rest(const TimedScene& scene, const CastRequest& request,
                           std::uint32_t instance, MovingCastWorkspace& workspace) {
  prepare(scene.scene, request.beams, workspace);
  if (instance == kInvalidId || is_static(scene.motion.world_from_instance[instance])) {
    express_all_beams(scene, request, nullptr, workspace);
  } else {
    const Body body = body_of(scene, request, instance, workspace);
    express_all_beams(scene, request, &body, workspace);
  }
  return workspace.beams;
}

void deskew(const TimedScene& scene, const Beams& reported, const Beams& fired,
            Frame::Deskewed& deskewed) {
  const Trajectory& trajectory = scene.motion.world_from_sensor;
  if (reported.times_ns.empty() || is_static(trajectory)) return;

  const bool has_errors = &reported != &fired;
  deskewed.directions.resize(reported.size());
  deskewed.true_directions.resize(has_errors ? reported.size() : 0);
  deskewed.origins_m.resize(reported.size());
  deskewed.start_from_sensor.resize(reported.size());
  const Pose at_start = pose_at(trajectory, scene.stamp_ns);
  const MovingSensor sensor{trajectory, at_start, scene.stamp_ns};
  const auto place = [&](BeamRange run, const PoseBlock& poses) {
    rotate_directions(poses, part_of(reported.directions, run), part_of(deskewed.directions, run));
    if (has_errors) {
      rotate_directions(poses, part_of(fired.directions, run),
                        part_of(deskewed.true_directions, run));
    }
    transform_origins(poses, part_of(fired.origins_m, run), part_of(deskewed.origins_m, run));
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Eigen::Quaterniond rotation(poses.rotation_at(i - run.begin));
      deskewed.start_from_sensor[i] = rotation.cast<float>();
    }
  };
  scene.renderer.thread_pool().parallel_for(reported.size(), kMovedBeamsPerTask,
                                            [&](std::size_t begin, std::size_t end) {
                                              for_each_run(sensor, reported, {begin, end}, place);
                                            });
}

}  // namespace glidar
