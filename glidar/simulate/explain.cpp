// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/explain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/sensor/noise/noise.hpp>
#include <glidar/simulate/depth_from_images.hpp>
#include <glidar/simulate/simulate.hpp>
#include <glidar/simulate/waveforms.hpp>

#include <utility>

namespace glidar {
namespace {

Measurement measurement_of(const Frame& frame, std::size_t entry) {
  const bool is_hit = frame.status[entry] == Status::hit;
  const ReturnSource source =
      frame.return_source.empty() ? ReturnSource::surface : frame.return_source[entry];
  return {.status = frame.status[entry],
          .return_source = is_hit ? source : ReturnSource::none,
          .range_m = frame.range_m[entry],
          .intensity = frame.intensity[entry],
          .sigma_m = frame.sigma_m.empty() ? 0.0F : frame.sigma_m[entry],
          .radial_velocity_m_s =
              frame.radial_velocity_m_s.empty() ? kNaN : frame.radial_velocity_m_s[entry]};
}

/// The columns that noise changes.
struct Columns {
  std::vector<double> range_m;
  std::vector<float> intensity;
  std::vector<Status> status;
  std::vector<ReturnSource> return_source;
  std::vector<double> radial_velocity_m_s;
};

/// Applies the first noise steps to a frame as it was measured.
void apply_first(const Simulation& s, std::size_t count, const Columns& measured) {
  s.frame.range_m = measured.range_m;
  s.frame.intensity = measured.intensity;
  s.frame.status = measured.status;
  s.frame.return_source = measured.return_source;
  s.frame.radial_velocity_m_s = measured.radial_velocity_m_s;
  apply_noise(s.prepared.noise, s.beams, s.renderer.thread_pool(), s.workspace.noise, s.frame,
              count);
  const Sensor& sensor = s.prepared.sensor;
  if (sensor.doppler) complete_radial_velocities(*sensor.doppler, s.frame);
}

/// The frame as reported.
void apply_all(const Simulation& s, const Columns& measured) {
  const std::size_t steps = s.prepared.noise.steps.size();
  apply_first(s, steps, measured);
  if (steps == 0) return;
  remove_returns_outside(s.prepared.sensor.limits, s.beams, s.renderer.thread_pool(), s.frame);
}

/// Of an entry of a frame before noise steps.
std::optional<VelocityTrace> trace_velocity(const Simulation& s, const PointTrace& trace) {
  const Frame& frame = s.frame;
  const std::size_t i = trace.entry;
  const std::optional<Doppler>& doppler = s.prepared.sensor.doppler;
  if (!doppler || frame.status[i] != Status::hit) return {};
  return VelocityTrace{
      .received_m_s = trace.waveform ? trace.waveform->velocities_m_s[i / s.beams.firings()]
                                     : frame.true_radial_velocity_m_s[i],
      .sigma_m_s = radial_velocity_sigma_m_s(*doppler, double{frame.intensity[i]},
                                             double{frame.ground_truth.noise_scale[i]}),
      .normal = radial_velocity_normal(frame, i)};
}

std::vector<double> receiver_noise(const Sensor& sensor, const Frame& frame,
                                   const PointTrace& trace, std::size_t pulse) {
  if (!sensor.lidar_equation || !(sensor.lidar_equation->noise_sigma > 0.0)) return {};
  const std::size_t count = trace.waveform ? trace.waveform->echoes.size() : 1;
  RngKey draw = rng_key(frame, Purpose::detection, pulse);
  std::vector<double> numbers;
  for (; draw.block < count; ++draw.block) numbers.push_back(normals(random_words(draw))[0]);
  return numbers;
}

void require_entry(std::size_t entry, const Beams& beams) {
  if (entry < beams.size()) return;
  throw Error(
      {.where = "index",
       .found = std::to_string(entry),
       .allowed = "0 to " + std::to_string(beams.size() - 1) + ", the entries of this frame",
       .remedy = ""});
}

/// What is known of a selected entry before the noise.
PointTrace begin_trace(const Simulation& s, std::size_t entry) {
  require_entry(entry, s.beams);
  const Frame& frame = s.frame;
  const std::size_t pulse = entry % s.beams.firings();
  PointTrace trace;
  trace.entry = entry;
  trace.direction = s.fired->directions[entry];
  if (s.prepared.pulse_model) trace.waveform = trace_waveform(s, pulse, frame);
  if (s.prepared.depth_camera) trace.depth = trace_depth(s, entry);
  trace.receiver_noise = receiver_noise(s.prepared.sensor, frame, trace, pulse);
  return trace;
}

}  // namespace

PointTrace explain(Simulator& simulator, const Motion& motion, const EntrySelector& pick,
                   Frame& frame, const ProgressCallback& progress) {
  const std::shared_ptr<const Beams> beams = simulator.beams(frame.number);
  Simulation s = simulator.prepare(*beams, motion, kAllHitColumns, frame, progress);
  s.noise_steps = 0;
  simulate({&s, 1});
  if (s.fired != &s.beams) s.workspace.fired.directions = frame.true_directions;
  const Columns measured{frame.range_m, frame.intensity, frame.status, frame.return_source,
                         frame.radial_velocity_m_s};
  const NoisePlan& noise = s.prepared.noise;
  apply_all(s, measured);
  PointTrace trace = begin_trace(s, pick(frame));
  apply_first(s, 0, measured);
  trace.measured = measurement_of(frame, trace.entry);
  trace.velocity = trace_velocity(s, trace);
  auto samples = trace_samples(noise, *beams, s.renderer.thread_pool(), frame, trace.entry);
  for (std::size_t k = 0; k < noise.steps.size(); ++k) {
    apply_first(s, k + 1, measured);
    trace.noise.push_back({std::move(samples[k]), measurement_of(frame, trace.entry)});
  }
  apply_all(s, measured);
  trace.reported = measurement_of(frame, trace.entry);
  return trace;
}

PointTrace explain(Simulator& simulator, const Motion& motion, std::size_t entry, Frame& frame,
                   const ProgressCallback& progress) {
  require_entry(entry, *simulator.beams(frame.number));
  return explain(
      simulator, motion, [entry](const Frame& /*frame*/) { return entry; }, frame, progress);
}

}  // namespace glidar
