// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/moving_cast.hpp>

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/motion/pose_block.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace glidar {
namespace {

/// A sensor that moves during a frame.
struct MovingSensor {
  const Trajectory& world_from_sensor;
  const Pose& at_start;  ///< at stamp_ns
  std::int64_t stamp_ns = 0;
};

/// Vectors component by component.
using VectorBlock = std::array<PoseBlock::Component, 3>;

void gather(std::span<const Eigen::Vector3d> vectors, VectorBlock& block) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    block[0][i] = vectors[i].x();
    block[1][i] = vectors[i].y();
    block[2][i] = vectors[i].z();
  }
}

void scatter(const VectorBlock& block, std::span<Eigen::Vector3d> vectors) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = {block[0][i], block[1][i], block[2][i]};
  }
}

// Products are added in the order of Eigen's products of 3x3 matrices, which add those of the third
// row from the last one. Blocks and single poses therefore give the same bits.

/// block = S0^-1 * block, with the rotation of S0^-1 and the position of S0.
GLIDAR_SIMD void multiply_from_left(const Eigen::Matrix3d& rotation,
                                    const Eigen::Vector3d& position_m, std::size_t count,
                                    PoseBlock& block) {
  const Eigen::Matrix3d& m = rotation;
  const auto multiply = [&](double& x, double& y, double& z) {
    const double a = (m(0, 0) * x + m(0, 1) * y) + m(0, 2) * z;
    const double b = (m(1, 0) * x + m(1, 1) * y) + m(1, 2) * z;
    const double c = m(2, 0) * x + (m(2, 1) * y + m(2, 2) * z);
    x = a;
    y = b;
    z = c;
  };
  for (std::size_t column = 0; column < 9; column += 3) {
    PoseBlock::Component& x = block.rotation[column];
    PoseBlock::Component& y = block.rotation[column + 1];
    PoseBlock::Component& z = block.rotation[column + 2];
    for (std::size_t i = 0; i < count; ++i) multiply(x[i], y[i], z[i]);
  }
  auto& [x, y, z] = block.position_m;
  const double x0 = position_m.x();
  const double y0 = position_m.y();
  const double z0 = position_m.z();
  for (std::size_t i = 0; i < count; ++i) {
    x[i] -= x0;
    y[i] -= y0;
    z[i] -= z0;
    multiply(x[i], y[i], z[i]);
  }
}

GLIDAR_SIMD void rotate(const PoseBlock& poses, std::size_t count, VectorBlock& vectors) {
  const auto& r = poses.rotation;
  auto& [x, y, z] = vectors;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = (r[0][i] * x[i] + r[3][i] * y[i]) + r[6][i] * z[i];
    const double b = (r[1][i] * x[i] + r[4][i] * y[i]) + r[7][i] * z[i];
    const double c = r[2][i] * x[i] + (r[5][i] * y[i] + r[8][i] * z[i]);
    const double squared = a * a + b * b + c * c;
    const double length = squared > 0.0 ? std::sqrt(squared) : 1.0;
    x[i] = a / length;
    y[i] = b / length;
    z[i] = c / length;
  }
}

/// As Eigen's product of a pose and a point: here all rows are added from their start.
GLIDAR_SIMD void transform(const PoseBlock& poses, const VectorBlock& points, std::size_t count,
                           VectorBlock& transformed) {
  const auto& [x, y, z] = points;
  for (std::size_t row = 0; row < 3; ++row) {
    const PoseBlock::Component& a = poses.rotation[row];
    const PoseBlock::Component& b = poses.rotation[row + 3];
    const PoseBlock::Component& c = poses.rotation[row + 6];
    const PoseBlock::Component& t = poses.position_m[row];
    PoseBlock::Component& out = transformed[row];
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = t[i] + ((a[i] * x[i] + b[i] * y[i]) + c[i] * z[i]);
    }
  }
}

/// The poses of the sensor at the firing times of beams, at most PoseBlock::kSize, relative to its
/// pose at the start: S0^-1 * S. Positions are subtracted first, for full precision far from
/// the world's origin.
void find_start_from_sensor(const MovingSensor& sensor, const Beams& beams, BeamRange range,
                            PoseBlock& start_from_sensor) {
  const std::size_t count = range.end - range.begin;
  std::array<std::int64_t, PoseBlock::kSize> t_ns;
  for (std::size_t i = 0; i < count; ++i) {
    t_ns[i] = sensor.stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[range.begin + i]);
  }
  poses_at(sensor.world_from_sensor, {t_ns.data(), count}, start_from_sensor);
  multiply_from_left(sensor.at_start.linear().transpose(), sensor.at_start.translation(), count,
                     start_from_sensor);
}

/// Rotates directions by one pose each, and normalises them.
void rotate_directions(const PoseBlock& poses, std::span<const Eigen::Vector3d> directions,
                       std::span<Eigen::Vector3d> rotated) {
  VectorBlock block;
  gather(directions, block);
  rotate(poses, directions.size(), block);
  scatter(block, rotated);
}

/// Transforms origins by one pose each; empty `origins_m`: all zero.
void transform_origins(const PoseBlock& poses, std::span<const Eigen::Vector3d> origins_m,
                       std::span<Eigen::Vector3d> transformed_m) {
  if (origins_m.empty()) return scatter(poses.position_m, transformed_m);
  VectorBlock block;
  VectorBlock transformed;
  gather(origins_m, block);
  transform(poses, block, origins_m.size(), transformed);
  scatter(transformed, transformed_m);
}

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
