// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulate.hpp>

#include <glidar/math/thread_pool.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/motion/radial_velocity.hpp>
#include <glidar/simulate/depth_from_images.hpp>
#include <glidar/simulate/object_boxes.hpp>
#include <glidar/simulate/projector_occlusion.hpp>
#include <glidar/simulate/pulse_cast.hpp>
#include <glidar/simulate/waveforms.hpp>

#include <limits>
#include <vector>

namespace glidar {
namespace {

/// If `wanted`, fills frame.beam_poses with the poses of the sensor and of the instance hit
/// (frame.ground_truth.instance) at each beam's firing time; else clears it.
void record_beam_poses(const Motion& motion, const Beams& beams, bool wanted,
                       ThreadPool& thread_pool, Frame& frame) {
  constexpr std::size_t kBeamsPerTask = 1024;
  Frame::BeamPoses& poses = frame.beam_poses;
  poses.world_from_sensor.resize(wanted ? beams.size() : 0);
  poses.world_from_object.resize(wanted ? beams.size() : 0);
  if (!wanted) return;
  const auto place_beam = [&](std::size_t i) {
    const std::int64_t t_ns = frame.stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[i]);
    const std::uint32_t instance = frame.ground_truth.instance[i];
    poses.world_from_sensor[i] = to_xyz_wxyz(pose_at(motion.world_from_sensor, t_ns));
    if (instance == kInvalidId) {
      poses.world_from_object[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      poses.world_from_object[i] = to_xyz_wxyz(pose_at(motion.world_from_instance[instance], t_ns));
    }
  };
  thread_pool.parallel_for(beams.size(), kBeamsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) place_beam(i);
  });
}

/// Sizes the columns, empties those that not every frame has, and places the sensor and all
/// objects.
void reset_frame(const Simulation& s) {
  Frame& frame = s.frame;
  frame.rows = s.beams.rows;
  frame.cols = s.beams.cols;
  frame.frame_id = s.beams.frame_id;
  sample_poses(s.motion, frame);
  resize(frame, s.beams.size());
  frame.radial_velocity_m_s.resize(s.prepared.sensor.doppler ? s.beams.size() : 0);
  frame.true_radial_velocity_m_s.resize(s.hit_columns.radial_velocity ? s.beams.size() : 0);
  frame.return_source.clear();
  frame.sigma_m.clear();
  frame.true_directions.clear();
  frame.deskewed.directions.clear();
  frame.deskewed.true_directions.clear();
  frame.deskewed.origins_m.clear();
  frame.deskewed.start_from_sensor.clear();
  frame.framebuffer.rgba.clear();
  frame.raw_images.clear();
  clear(frame.tof_images);
  frame.tof_amplitude.clear();
  frame.bounced_share.clear();
  frame.disparity_px.clear();
  frame.projector_px.clear();
  frame.boxes.clear();
}

CastRequest beam_request(const Simulation& s, FunctionRef<void(BeamRange)> on_tile_done) {
  CastRequest request = cast_request(s, *s.fired, s.hit_columns);
  request.on_tile_done = on_tile_done;
  request.progress = s.progress;
  return request;
}

/// Casts the beams of frames that take one cast each.
template <class MeasureTile>
void cast_together(std::span<const Simulation> frames, const MeasureTile& measure) {
  const auto bind = [&measure](const Simulation& s) {
    return [&measure, &s](BeamRange tile) { measure(s, tile); };
  };
  std::vector<decltype(bind(frames.front()))> on_tile_done;
  on_tile_done.reserve(frames.size());  // requests refer to them
  std::vector<CastRequest> requests;
  std::vector<Hits*> hits;
  for (const Simulation& s : frames) {
    on_tile_done.push_back(bind(s));
    requests.push_back(beam_request(s, FunctionRef<void(BeamRange)>(on_tile_done.back())));
    hits.push_back(&s.frame.ground_truth);
  }
  frames.front().renderer.cast_batch(requests, hits);
}

/// Casts all beams; calls measure(simulation, tile) for every beam once, when its hits are known.
template <class MeasureTile>
void cast_beams(std::span<const Simulation> frames, const MeasureTile& measure) {
  if (frames.size() > 1) return cast_together(frames, measure);
  const Simulation& s = frames.front();
  const auto measure_one = [&](BeamRange tile) { measure(s, tile); };
  const FunctionRef<void(BeamRange)> on_tile_done(measure_one);
  if (s.prepared.pulse_model) return cast_pulses(s, {0, s.fired->firings()}, on_tile_done);
  cast(s, beam_request(s, on_tile_done), s.frame.ground_truth);
}

/// Radial velocities: of the ground truth if they are wanted, and with errors if the sensor
/// measures them. Those of pulses are known from their echoes.
void measure_velocities(const Simulation& s) {
  Frame& frame = s.frame;
  ThreadPool& threads = s.renderer.thread_pool();
  if (!s.prepared.pulse_model) {
    record_radial_velocities(s.motion, *s.fired, s.hit_columns.radial_velocity, threads, frame);
    if (s.prepared.sensor.doppler) frame.radial_velocity_m_s = frame.true_radial_velocity_m_s;
  }
  if (s.prepared.sensor.doppler) {
    measure_radial_velocities(*s.prepared.sensor.doppler, threads, frame);
  }
}

}  // namespace

void simulate(std::span<Simulation> frames) {
  for (Simulation& s : frames) {
    reset_frame(s);
    s.fired = &perturb_directions(s.prepared.noise, s.beams, s.frame, s.renderer.thread_pool(),
                                  s.workspace.fired);
  }
  cast_beams(frames, [](const Simulation& s, BeamRange tile) { measure_tile(s, tile); });
  for (const Simulation& s : frames) {
    const Sensor& sensor = s.prepared.sensor;
    ThreadPool& threads = s.renderer.thread_pool();
    if (s.replace_returns) {
      s.replace_returns({sensor, s.beams, *s.fired, s.instance_enabled, threads}, s.frame);
    }
    if (s.prepared.depth_camera) {
      measure_depth(s);
    } else if (sensor.projector_origin_m) {
      occlude_from_projector(s, *sensor.projector_origin_m);
    }
    if (s.is_moving) deskew(timed_scene(s), s.beams, *s.fired, s.frame.deskewed);
    record_beam_poses(s.motion, s.beams, s.hit_columns.poses, threads, s.frame);
    measure_velocities(s);
    apply_noise(s.prepared.noise, s.beams, threads, s.workspace.noise, s.frame, s.noise_steps);
    if (!s.prepared.noise.steps.empty())
      remove_returns_outside(sensor.limits, s.beams, threads, s.frame);
    if (sensor.doppler) complete_radial_velocities(*sensor.doppler, s.frame);
    if (s.fired != &s.beams) s.frame.true_directions.swap(s.workspace.fired.directions);
    if (s.hit_columns.boxes) find_boxes(s, BoxSelection::with_class, s.frame.boxes);
  }
}

void measure_tile(const Simulation& s, BeamRange tile) {
  if (s.prepared.pulse_model) return measure_waveforms(s, tile);
  const Sensor& sensor = s.prepared.sensor;
  classify_surfaces(sensor.limits, *s.fired, tile, s.frame);
  if (sensor.lidar_equation) {
    shade_lidar(*sensor.lidar_equation, s.scene, sensor.wavelength_m, s.fired->rings, tile,
                s.frame);
  } else {
    shade_phong(sensor.light, tile, s.frame);
  }
}

bool takes_one_cast(const Simulation& s) {
  return !s.prepared.pulse_model && !s.prepared.depth_camera && !s.is_moving;
}

}  // namespace glidar
