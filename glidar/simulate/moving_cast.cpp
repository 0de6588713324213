// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/moving_cast.hpp>

#include <glidar/simulate/start_from_sensor.hpp>

#include <algorithm>
#include <span>

namespace glidar {
namespace {

constexpr std::size_t kMovedBeamsPerTask = 1024;

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

/// Expresses a hit's vectors in the sensor's frame at the beam's firing time.
void rotate_to_firing_time(const CastRequest& request, const Eigen::Matrix3d& start_from_sensor,
                           std::size_t beam, Hits& hits) {
  const Eigen::Matrix3d back = start_from_sensor.transpose();
  const auto rotate = [&](Eigen::Vector3f& v) { v = (back * v.cast<double>()).cast<float>(); };
  if (request.hit_columns.normal) rotate(hits.normal[beam]);
  if (request.hit_columns.shading_normal) rotate(hits.shading_normal[beam]);
}

/// One cast that is in progress.
struct MovingCast {
  const TimedScene& timed;
  const CastRequest& request;
  MovingCastWorkspace& memory;

  template <class Work>
  void parallel_for(std::size_t size, std::size_t grain, const Work& work) const {
    timed.renderer.thread_pool().parallel_for(size, grain, work);
  }
};

/// Expresses all beams in the sensor's frame at the start.
void express_all_beams(const MovingCast& cast) {
  MovingCastWorkspace& memory = cast.memory;
  const Beams& beams = cast.request.beams;
  memory.beams.rows = beams.rows;
  memory.beams.cols = beams.cols;
  memory.beams.frame_id = beams.frame_id;
  memory.beams.boresight = beams.boresight;
  memory.beams.directions.resize(beams.size());
  memory.beams.origins_m.resize(beams.size());
  memory.start_from_sensor.resize(beams.size());
  const MovingSensor sensor{cast.timed.motion.world_from_sensor, cast.request.world_from_sensor,
                            cast.timed.stamp_ns};
  cast.parallel_for(beams.size(), kMovedBeamsPerTask, [&](std::size_t begin, std::size_t end) {
    express_beams(cast.request, sensor, {begin, end}, memory);
  });
}

/// Expresses hits on all that is static in the sensor's frame at the firing times.
void express_static_hits(const MovingCast& cast, BeamRange range, Hits& hits) {
  const HitColumnMask& columns = cast.request.hit_columns;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (hits.instance[i] == kInvalidId) continue;
    if (has_vectors(columns)) {
      rotate_to_firing_time(cast.request, cast.memory.start_from_sensor[i], i, hits);
    }
    if (columns.depth) hits.depth_m[i] = depth_m(cast.request.beams, i, hits.range_m[i]);
  }
}

/// Casts the beams of the workspace into all that is static.
void cast_static(const MovingCast& cast, const ProgressCallback& progress, Hits& hits) {
  const CastRequest& request = cast.request;
  MovingCastWorkspace& memory = cast.memory;
  const std::vector<Trajectory>& trajectories = cast.timed.motion.world_from_instance;
  memory.instance_enabled.resize(trajectories.size());
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    memory.instance_enabled[i] =
        static_cast<std::uint8_t>(is_static(trajectories[i]) && is_enabled(request, i));
  }
  cast.timed.renderer.cast({.beams = memory.beams,
                            .world_from_sensor = request.world_from_sensor,
                            .world_from_instance = request.world_from_instance,
                            .hit_columns = request.hit_columns,
                            .cull_back_faces = request.cull_back_faces,
                            .instance_enabled = memory.instance_enabled,
                            .footprints = request.footprints,
                            .progress = progress},
                           hits);
  cast.parallel_for(hits.instance.size(), kMovedBeamsPerTask,
                    [&](std::size_t begin, std::size_t end) {
                      express_static_hits(cast, {begin, end}, hits);
                    });
}

/// Copies a slice's body beams to their place among all.
void copy_slice(std::size_t slice, MovingCastWorkspace& memory) {
  std::size_t to = memory.first_of_slice[slice];
  for (const BodyBeam& found : memory.search.slices[slice]) {
    memory.body_beams.directions[to] = found.direction;
    memory.body_beams.origins_m[to] = found.origin_m;
    memory.targets[to++] = {found.instance, found.instance + 1};
  }
}

/// Collects the body beams of all slices.
void collect_body_beams(const MovingCast& cast) {
  MovingCastWorkspace& memory = cast.memory;
  const std::vector<std::vector<BodyBeam>>& slices = memory.search.slices;
  memory.first_of_slice.assign(1, 0);
  for (const std::vector<BodyBeam>& slice : slices) {
    memory.first_of_slice.push_back(memory.first_of_slice.back() + slice.size());
  }
  const std::size_t count = memory.first_of_slice.back();
  Beams& beams = memory.body_beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(count);
  beams.frame_id = cast.request.beams.frame_id;
  beams.boresight = cast.request.beams.boresight;
  beams.directions.resize(count);
  beams.origins_m.resize(count);
  memory.targets.resize(count);
  cast.parallel_for(slices.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slice = begin; slice < end; ++slice) copy_slice(slice, memory);
  });
}

/// Casts the body beams that were found.
void cast_body_beams(const MovingCast& cast, const HitColumnMask& hit_columns) {
  MovingCastWorkspace& memory = cast.memory;
  collect_body_beams(cast);
  cast.timed.renderer.cast({.beams = memory.body_beams,
                            .world_from_sensor = cast.request.world_from_sensor,
                            .world_from_instance = cast.request.world_from_instance,
                            .hit_columns = hit_columns,
                            .cull_back_faces = cast.request.cull_back_faces,
                            .instance_enabled = cast.request.instance_enabled,
                            .targets = memory.targets},
                           memory.body_hits);
}

/// Keeps the nearer of two hits; at the same range that of the scene at rest, then that of the
/// instance with the lowest index.
void merge_body_hits(const MovingCast& cast, Hits& hits) {
  MovingCastWorkspace& memory = cast.memory;
  const CastRequest& request = cast.request;
  const Hits& found = memory.body_hits;
  const auto merge = [&](std::size_t from, const BodyBeam& body_beam) {
    const std::size_t to = body_beam.beam;
    if (found.instance[from] == kInvalidId) return;
    if (hits.instance[to] != kInvalidId && !(found.range_m[from] < hits.range_m[to])) return;
    copy_hit(found, from, request.hit_columns, hits, to);
    if (has_vectors(request.hit_columns)) {
      rotate_to_firing_time(request, body_beam.start_from_sensor, to, hits);
    }
    if (request.hit_columns.depth) hits.depth_m[to] = depth_m(request.beams, to, hits.range_m[to]);
  };
  const std::vector<std::vector<BodyBeam>>& slices = memory.search.slices;
  cast.parallel_for(slices.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slice = begin; slice < end; ++slice) {
      std::size_t from = memory.first_of_slice[slice];
      for (const BodyBeam& body_beam : slices[slice]) merge(from++, body_beam);
    }
  });
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
  const MovingCast cast{scene, request, workspace};
  const std::vector<Trajectory>& trajectories = scene.motion.world_from_instance;
  const bool has_bodies = !std::all_of(trajectories.begin(), trajectories.end(), is_static);
  express_all_beams(cast);
  cast_static(cast, subrange(request.progress, 0.0, has_bodies ? 0.5 : 1.0), hits);
  workspace.search.next_body.clear();
  while (has_bodies &&
         find_body_beams(scene, request, workspace.beams, hits.range_m, workspace.search)) {
    cast_body_beams(cast, request.hit_columns);
    merge_body_hits(cast, hits);
  }
  if (request.progress) request.progress(1.0);
  if (request.on_tile_done) {
    cast.parallel_for(request.beams.size(), kMovedBeamsPerTask,
                      [&](std::size_t begin, std::size_t end) {
                        request.on_tile_done({begin, end});
                      });
  }
}

const Beams& beams_at_rest(const TimedScene& scene, const CastRequest& request,
                           MovingCastWorkspace& workspace) {
  express_all_beams({scene, request, workspace});
  return workspace.beams;
}

void count_body_hits(const TimedScene& scene, const CastRequest& request,
                     MovingCastWorkspace& workspace, std::span<std::uint32_t> count) {
  const MovingCast cast{scene, request, workspace};
  express_all_beams(cast);
  workspace.search.next_body.clear();
  while (find_body_beams(scene, request, workspace.beams, {}, workspace.search)) {
    cast_body_beams(cast, {});
    for (const std::uint32_t instance : workspace.body_hits.instance) {
      if (instance != kInvalidId) ++count[instance];
    }
  }
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
