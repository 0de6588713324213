// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/moving_cast.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace glidar {
namespace {

constexpr std::size_t kMovedBeamsPerTask = 1024;

bool stands(const Trajectory& trajectory) {
  return std::holds_alternative<ConstantPose>(trajectory);
}

/// A sphere around an instance, where it is at the start of the frame, in the sensor's frame then.
struct Sphere {
  Eigen::Vector3d centre;
  double radius = std::numeric_limits<double>::infinity();
};

Sphere sphere_around(const Scene& scene, std::uint32_t index, const Pose& world_from_object,
                     const Pose& world_from_sensor) {
  constexpr double kClear = 1.001;  // also after rounding
  const Instance& instance = scene.instances[index];
  const Eigen::AlignedBox3d box = bounds(scene.meshes[instance.mesh]);
  if (box.isEmpty()) return {Eigen::Vector3d::Zero(), 0.0};
  const Eigen::Vector3d middle =
      world_from_object.linear() * (instance.scale * box.center()) +
      (world_from_object.translation() - world_from_sensor.translation());
  return {world_from_sensor.linear().transpose() * middle,
          kClear * instance.scale * 0.5 * box.diagonal().norm()};
}

bool may_meet(const Sphere& sphere, const Eigen::Vector3d& origin,
              const Eigen::Vector3d& direction) {
  if (std::isinf(sphere.radius)) return true;
  const Eigen::Vector3d to_centre = sphere.centre - origin;
  const double along = std::max(0.0, to_centre.dot(direction));
  return (to_centre - along * direction).squaredNorm() <= sphere.radius * sphere.radius;
}

/// One rigid part of the world and where it is while a frame is taken.
struct Body {
  const Trajectory* world_from_body = nullptr;  ///< nullptr: what stands still
  Pose at_start = Pose::Identity();
  Sphere sphere = {};
};

/// The sensor at a time as the resting body sees it, in the frame of the sensor at the start:
/// S0^-1 * B0 * B^-1 * S, B and S being their poses at that time. Differences of positions come
/// first, so that a world far from its zero loses nothing.
Pose start_from_sensor(const Body& body, const Pose& s0, const Pose& b, const Pose& s) {
  Pose pose = Pose::Identity();
  const Eigen::Matrix3d back = s0.linear().transpose();
  if (body.world_from_body == nullptr) {
    pose.linear() = back * s.linear();
    pose.translation() = back * (s.translation() - s0.translation());
    return pose;
  }
  const Pose& b0 = body.at_start;
  const Eigen::Matrix3d held = b0.linear() * b.linear().transpose();
  pose.linear() = back * held * s.linear();
  pose.translation() =
      back * (held * (s.translation() - b.translation()) + (b0.translation() - s0.translation()));
  return pose;
}

/// Calls work(beam, world_from_sensor, world_from_body) for beams of a run, each at its own time.
/// Of what stands still the body's pose is left as it is.
template <class Work>
void at_their_times(const Trajectory& sensor, const Body& body, std::int64_t stamp_ns,
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
    if (body.world_from_body != nullptr) {
      poses_at(*body.world_from_body, times, {bodies.data(), count});
    }
    for (std::size_t k = 0; k < count; ++k) work(first + k, sensors[k], bodies[k]);
  }
}

/// Expresses a run of beams in the frame in which a body rests; those that cannot meet it get no
/// direction.
void move_beams(const CastRequest& request, const Motion& motion, const Body& body,
                std::int64_t stamp_ns, BeamRange range, Workspace& memory) {
  const Beams& beams = request.beams;
  const auto move = [&](std::size_t i, const Pose& sensor, const Pose& of_body) {
    const Pose pose = start_from_sensor(body, request.world_from_sensor, of_body, sensor);
    memory.start_from_sensor[i] = pose;
    Eigen::Vector3d& direction = memory.moved.directions[i];
    Eigen::Vector3d& origin = memory.moved.origins_m[i];
    direction = (pose.linear() * beams.directions[i]).normalized();
    origin =
        beams.origins_m.empty() ? Eigen::Vector3d(pose.translation()) : pose * beams.origins_m[i];
    if (!may_meet(body.sphere, origin, direction)) {
      direction.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  };
  at_their_times(motion.world_from_sensor, body, stamp_ns, beams, range, move);
}

/// Puts what depends on the sensor's frame into the one of the beam's own time.
void turn_back(const CastRequest& request, const Workspace& memory, BeamRange range, Hits& hits) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    const Eigen::Matrix3d back = memory.start_from_sensor[i].linear().transpose();
    const auto turn = [&](Eigen::Vector3f& v) { v = (back * v.cast<double>()).cast<float>(); };
    if (request.fields.normal) turn(hits.normal[i]);
    if (request.fields.shading_normal) turn(hits.shading_normal[i]);
    if (request.fields.depth) hits.depth_m[i] = depth_m(request.beams, i, hits.range_m[i]);
  }
}

/// Keeps the nearer of two hits; at the same range that of the body cast first.
void merge(const Hits& from, const HitFieldMask& fields, BeamRange range, Hits& to) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (from.instance[i] == kInvalidId) continue;
    if (to.instance[i] == kInvalidId || from.range_m[i] < to.range_m[i])
      copy_hit(from, i, fields, to, i);
  }
}

/// The beams of `memory` sized and filled with what all bodies share.
void prepare(const Beams& beams, Workspace& memory) {
  memory.moved.rows = beams.rows;
  memory.moved.cols = beams.cols;
  memory.moved.frame_id = beams.frame_id;
  memory.moved.boresight = beams.boresight;
  memory.moved.directions.resize(beams.size());
  memory.moved.origins_m.resize(beams.size());
  memory.start_from_sensor.resize(beams.size());
}

/// One cast that is in progress.
struct MovingCast {
  const TimedScene& world;
  const CastRequest& request;
  Workspace& memory;
  Hits& hits;

  template <class Work>
  void in_runs(const Work& work) const {
    world.renderer.thread_pool().parallel_for(request.beams.size(), kMovedBeamsPerTask,
                                              [&](std::size_t begin, std::size_t end) {
                                                work(BeamRange{begin, end});
                                              });
  }
};

/// Which of the casts at bodies this is.
struct Turn {
  std::size_t number = 0;
  std::size_t all = 1;
};

/// Casts at what of memory.instance_enabled belongs to the body. The first fills the hits.
void cast_body(const MovingCast& job, const Body& body, const Turn& turn) {
  const bool is_first = turn.number == 0;
  Workspace& memory = job.memory;
  const CastRequest& request = job.request;
  Hits& hits = is_first ? job.hits : memory.body_hits;
  const auto part = [&](std::size_t number) {
    return static_cast<double>(number) / static_cast<double>(turn.all);
  };
  job.in_runs([&](BeamRange range) {
    move_beams(request, job.world.motion, body, job.world.stamp_ns, range, memory);
  });
  job.world.renderer.cast(
      {.beams = memory.moved,
       .world_from_sensor = request.world_from_sensor,
       .world_from_instance = request.world_from_instance,
       .fields = request.fields,
       .cull_back_faces = request.cull_back_faces,
       .instance_enabled = memory.instance_enabled,
       .progress = subrange(request.progress, part(turn.number), part(turn.number + 1))},
      hits);
  job.in_runs([&](BeamRange range) {
    turn_back(request, memory, range, hits);
    if (!is_first) merge(hits, request.fields, range, job.hits);
  });
}

/// Casts at what stands still, then at every moving instance.
void cast_bodies(const MovingCast& job) {
  Workspace& memory = job.memory;
  const Scene& scene = job.world.scene;
  const std::vector<Trajectory>& trajectories = job.world.motion.world_from_instance;
  memory.instance_enabled.assign(scene.instances.size(), 0);
  for (std::size_t i = 0; i < memory.instance_enabled.size(); ++i) {
    memory.instance_enabled[i] = static_cast<std::uint8_t>(stands(trajectories[i]));
  }
  const auto standing = std::count_if(trajectories.begin(), trajectories.end(), stands);
  Turn turn{.all = 1 + memory.instance_enabled.size() - static_cast<std::size_t>(standing)};
  cast_body(job, {}, turn);
  for (std::uint32_t i = 0; i < memory.instance_enabled.size(); ++i) {
    if (stands(trajectories[i])) continue;
    memory.instance_enabled.assign(scene.instances.size(), 0);
    memory.instance_enabled[i] = 1;
    ++turn.number;
    const Pose& at_start = job.request.world_from_instance[i];
    cast_body(job,
              {.world_from_body = &trajectories[i],
               .at_start = at_start,
               .sphere = sphere_around(scene, i, at_start, job.request.world_from_sensor)},
              turn);
  }
}

}  // namespace

bool moves_during_frame(const Motion& motion, const Beams& beams) {
  if (beams.times_ns.empty()) return false;
  return !stands(motion.world_from_sensor) ||
         !std::all_of(motion.world_from_instance.begin(), motion.world_from_instance.end(), stands);
}

void cast_moving(const TimedScene& world, const CastRequest& request, Workspace& memory,
                 Hits& hits) {
  if (!moves_during_frame(world.motion, request.beams)) {
    world.renderer.cast(request, hits);
    return;
  }
  prepare(request.beams, memory);
  const MovingCast job{world, request, memory, hits};
  cast_bodies(job);
  if (request.on_tile_done) job.in_runs(request.on_tile_done);
}

void deskew(const TimedScene& world, const Beams& nominal, const Beams& aimed,
            Frame::Deskewed& deskewed) {
  deskewed.directions.clear();
  deskewed.true_directions.clear();
  deskewed.origins_m.clear();
  deskewed.start_from_sensor.clear();
  const Trajectory& trajectory = world.motion.world_from_sensor;
  if (nominal.times_ns.empty() || stands(trajectory)) return;

  const bool is_nominal = &nominal == &aimed;
  deskewed.directions.resize(nominal.size());
  if (!is_nominal) deskewed.true_directions.resize(nominal.size());
  deskewed.origins_m.resize(nominal.size());
  deskewed.start_from_sensor.resize(nominal.size());
  const Pose at_start = pose_at(trajectory, world.stamp_ns);
  const auto place = [&](std::size_t i, const Pose& sensor, const Pose& /*body*/) {
    const Pose pose = start_from_sensor({}, at_start, {}, sensor);
    deskewed.directions[i] = (pose.linear() * nominal.directions[i]).normalized();
    if (!is_nominal)
      deskewed.true_directions[i] = (pose.linear() * aimed.directions[i]).normalized();
    deskewed.origins_m[i] =
        aimed.origins_m.empty() ? Eigen::Vector3d(pose.translation()) : pose * aimed.origins_m[i];
    deskewed.start_from_sensor[i] = Eigen::Quaterniond(pose.linear()).cast<float>();
  };
  world.renderer.thread_pool().parallel_for(
      nominal.size(), kMovedBeamsPerTask, [&](std::size_t begin, std::size_t end) {
        at_their_times(trajectory, {}, world.stamp_ns, nominal, {begin, end}, place);
      });
}

}  // namespace glidar
