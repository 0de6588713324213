// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/waveforms.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/motion/radial_velocity.hpp>
#include <glidar/sensor/lidar/beam_surfaces.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>
#include <glidar/simulate/echo_velocity.hpp>
#include <glidar/simulate/flat_footprints.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/pulse_cast.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

/// The path over a mirror: the light is reflected twice and travels both legs.
EchoContribution ghost_path(const Simulation& s, std::size_t mirrored, double energy) {
  const SubRayWorkspace& memory = s.workspace.sub_rays;
  const Hits& hits = memory.mirrored_hits;
  const std::uint32_t ray = memory.mirrored_from[mirrored];
  const double share = material_hit(s.scene, memory.hits, ray).mirror;
  const double range_m = memory.hits.range_m[ray] + hits.range_m[mirrored];
  const double sent = energy * share * share *
                      backscatter_at(s.scene, s.prepared.sensor.wavelength_m, hits, mirrored);
  return {range_m, received_signal(s.prepared.pulse_model->lidar_equation, sent, range_m), ray,
          ReturnSource::ghost, kGhostSurface};
}

/// All contributions of surfaces to the waveform of a pulse.
void collect_paths(const Simulation& s, std::size_t pulse, BeamSurfaces& surfaces,
                   WaveformBuffer& waveform) {
  const SubRayWorkspace& memory = s.workspace.sub_rays;
  const std::vector<SubRay>& rays = s.prepared.pulse_model->sub_rays;
  const std::size_t first = first_sub_ray(s, pulse);
  const bool is_spread = rays.size() > 1;
  if (is_spread) surfaces.find(memory.beams, memory.hits, first, rays.size());
  waveform.paths = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::size_t ray = first + k;
    if (memory.hits.instance[ray] == kInvalidId) continue;
    waveform.add({memory.hits.range_m[ray], rays[k].share * memory.signals[ray],
                  static_cast<std::uint32_t>(ray), ReturnSource::surface,
                  is_spread ? surfaces.of_ray(k) : std::uint16_t{0}});
  }
  const std::vector<std::uint32_t>& from = memory.mirrored_from;
  std::size_t mirrored = mirrored_beam(memory, first);
  for (; mirrored < from.size() && from[mirrored] < first + rays.size(); ++mirrored) {
    if (memory.mirrored_hits.instance[mirrored] == kInvalidId) continue;
    waveform.add(ghost_path(s, mirrored, rays[from[mirrored] - first].share));
  }
}

/// Adds the echoes of the air before a surface.
void add_weather(const std::optional<PreparedWeather>& weather, const RngKey& key, double surface_m,
                 std::vector<WeatherEcho>& echoes, WaveformBuffer& waveform) {
  if (!weather) return;
  echoes.clear();
  weather_echoes(*weather, surface_m, key, echoes);
  for (const WeatherEcho& echo : echoes) {
    waveform.add({echo.range_m, echo.signal, kInvalidId, echo.return_source});
  }
}

/// Adds the receiver's noise to the echoes and keeps those at or above the threshold of the
/// channel. The k-th echo of a pulse samples block k.
void detect_echoes(const LidarEquation& light, double threshold, const RngKey& key,
                   double first_noise, WaveformBuffer& waveform) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < waveform.echoes; ++k) {
    PulseEcho echo = waveform.echo[k];
    echo.signal /= threshold;
    if (light.noise_sigma > 0.0) {
      RngKey echo_key = key;
      echo_key.block = static_cast<std::uint32_t>(k);
      echo.signal =
          with_noise(light, echo.signal, k == 0 ? first_noise : normals(random_words(echo_key))[0]);
    }
    if (!(echo.signal >= 1.0)) continue;
    echo.signal *= threshold;
    waveform.echo[kept++] = echo;
  }
  waveform.echoes = kept;
}

void report_echo(const Simulation& s, const PulseEcho& echo, const EchoContribution& path,
                 std::size_t entry) {
  Frame& frame = s.frame;
  const Sensor& sensor = s.prepared.sensor;
  const LidarEquation& light = s.prepared.pulse_model->lidar_equation;
  const double range_m = reported_range_m(sensor.receiver, echo);
  Status status = check_limits(sensor.limits, *s.fired, entry, range_m);
  if (status == Status::hit && light.saturation > 0.0 &&
      echo.signal >= light.saturation * channel_threshold(light, s.fired->rings, entry))
    status = Status::saturated;
  if (status != Status::hit) return invalidate_return(frame, entry, status);
  frame.status[entry] = Status::hit;
  frame.range_m[entry] = range_m;
  frame.intensity[entry] = static_cast<float>(echo.signal);
  const bool is_mixed = echo.is_mixed && path.return_source == ReturnSource::surface;
  frame.return_source[entry] = is_mixed ? ReturnSource::mixed_pixel : path.return_source;
}

void report_velocity(const Simulation& s, std::size_t pulse, const WaveformBuffer& waveform,
                     const PulseEcho& echo, std::size_t entry) {
  if (s.frame.status[entry] != Status::hit) return;
  s.frame.radial_velocity_m_s[entry] = echo_velocity_m_s(s, pulse, waveform, echo);
}

/// The strongest path, whose ground truth a pulse without a return gets.
EchoContribution strongest_surface(const WaveformBuffer& waveform) {
  if (waveform.paths == 0) return {kNaN, 0.0, kInvalidId, ReturnSource::none};
  return *std::max_element(
      waveform.path.begin(), waveform.path.begin() + static_cast<std::ptrdiff_t>(waveform.paths),
      [](const EchoContribution& a, const EchoContribution& b) { return a.signal < b.signal; });
}

/// Why a pulse has no echo: no surface, or too weak a signal, maybe by weather.
Status missing_return_status(const Simulation& s, const EchoContribution& surface,
                             double strongest_signal, std::size_t pulse) {
  if (surface.source == kInvalidId) {
    return std::isnan(s.fired->directions[pulse].x()) ? Status::invalid_pixel : Status::miss;
  }
  return classify_weak_return(s.prepared.pulse_model->lidar_equation, strongest_signal,
                              surface.range_m);
}

/// Writes what a sub-ray hit, or a miss.
void write_ground_truth(const Simulation& s, std::uint32_t source, std::size_t entry) {
  if (s.hit_columns.radial_velocity) {
    s.frame.true_radial_velocity_m_s[entry] =
        source == kInvalidId ? kNaN : s.workspace.sub_rays.velocities_m_s[source];
  }
  if (source == kInvalidId) {
    write_misses(s.hit_columns, entry, 1, s.frame.ground_truth);
    return;
  }
  copy_hit(s.workspace.sub_rays.hits, source, s.hit_columns, s.frame.ground_truth, entry);
}

/// Random numbers of the receiver for a run of pulses.
struct ReceiverSamples {
  RngKey key;  ///< of the first pulse
  Batch<double> noise{};
};

void sample_receiver(const LidarEquation& light, const Frame& frame, std::size_t first,
                     ReceiverSamples& samples) {
  samples.key = rng_key(frame, Purpose::detection, first);
  if (light.noise_sigma > 0.0) sample_normals(samples.key, samples.noise);
}

/// Memory of a thread, for one pulse after the other.
struct PulseMemory {
  WaveformBuffer waveform;
  std::vector<std::size_t> received;  ///< sub-rays whose signals are needed
  Hits received_hits;                 ///< their hits
  std::vector<double> signals;        ///< theirs
  FlatEchoes flat;
  ReceiverSamples samples;
  std::vector<WeatherEcho> weather;
  BeamSurfaces surfaces;
};

bool traces(const Simulation& s, std::size_t pulse) {
  return s.trace != nullptr && s.trace->pulse == pulse;
}

void trace_echoes(const Simulation& s, std::size_t pulse, bool is_in_closed_form,
                  const WaveformBuffer& waveform) {
  WaveformTrace& trace = *s.trace;
  const std::vector<SubRay>& rays = s.prepared.pulse_model->sub_rays;
  const std::size_t first = first_sub_ray(s, pulse);
  RadialVelocities velocities(s.motion);
  trace.sub_rays = rays.size();
  trace.is_in_closed_form = is_in_closed_form;
  trace.light_paths.clear();
  for (std::size_t k = 0; k < waveform.paths; ++k) {
    WaveformTrace::LightPath light_path{.path = waveform.path[k]};
    if (s.prepared.sensor.doppler) {
      light_path.velocity_m_s = path_velocity_m_s(s, pulse, waveform.path[k], velocities);
    }
    if (light_path.path.source != kInvalidId) {
      const SubRayWorkspace& memory = s.workspace.sub_rays;
      light_path.instance = memory.hits.instance[light_path.path.source];
      if (light_path.path.return_source == ReturnSource::ghost)
        light_path.reflected =
            memory.mirrored_hits.instance[mirrored_beam(memory, light_path.path.source)];
      light_path.path.source -= static_cast<std::uint32_t>(first);
      light_path.share = is_in_closed_form ? 1.0 : rays[light_path.path.source].share;
    }
    trace.light_paths.push_back(light_path);
  }
  trace.echoes.assign(waveform.echo.begin(),
                      waveform.echo.begin() + static_cast<std::ptrdiff_t>(waveform.echoes));
}

/// Finds the echoes of all contributions to a pulse. Returns the strongest surface's.
EchoContribution find_echoes(const Simulation& s, std::size_t pulse, const RngKey& key,
                             PulseMemory& memory) {
  WaveformBuffer& waveform = memory.waveform;
  const Sensor& sensor = s.prepared.sensor;
  collect_paths(s, pulse, memory.surfaces, waveform);
  const EchoContribution surface = strongest_surface(waveform);
  const double width_m =
      sensor.footprint && waveform.paths > 0 ? diameter_m(*sensor.footprint, surface.range_m) : 0.0;
  add_weather(s.prepared.pulse_model->weather, key, surface.range_m, memory.weather, waveform);
  detect_peaks(pulse_sigma_m(sensor.receiver), width_m, waveform);
  return surface;
}

/// Keeps the echoes that the receiver detects. Returns the status of a pulse without any.
Status receive_echoes(const Simulation& s, std::size_t pulse, const RngKey& key,
                      const EchoContribution& surface, PulseMemory& memory) {
  WaveformBuffer& waveform = memory.waveform;
  const Sensor& sensor = s.prepared.sensor;
  const PulseModel& model = *s.prepared.pulse_model;
  double strongest_signal = 0.0;
  for (std::size_t k = 0; k < waveform.echoes; ++k) {
    const bool is_surface = waveform.path[waveform.echo[k].strongest].source != kInvalidId;
    if (is_surface) strongest_signal = std::max(strongest_signal, waveform.echo[k].signal);
  }
  const std::size_t in_run = pulse - memory.samples.key.beam;
  const double threshold = channel_threshold(model.lidar_equation, s.fired->rings, pulse);
  detect_echoes(model.lidar_equation, threshold, key, memory.samples.noise[in_run], waveform);
  enforce_min_separation(sensor.receiver.min_return_separation_m, waveform);
  return missing_return_status(s, surface, strongest_signal / threshold, pulse);
}

FlatFootprint& flat_footprint(const Simulation& s, std::size_t pulse) {
  return s.workspace.sub_rays.flat[pulse - s.workspace.sub_rays.first_pulse];
}

/// Takes the echo of a pulse in closed form. Returns its contribution.
EchoContribution take_flat_echo(const Simulation& s, std::size_t pulse, PulseMemory& memory) {
  WaveformBuffer& waveform = memory.waveform;
  const std::size_t in_run = pulse - memory.samples.key.beam;
  const FlatEchoes& flat = memory.flat;
  waveform.paths = 0;
  waveform.add({flat.range_m[in_run], flat.signal[in_run],
                static_cast<std::uint32_t>(first_sub_ray(s, pulse)), ReturnSource::surface});
  PulseEcho& echo = waveform.echo[0];
  echo.range_m = flat.range_m[in_run];
  echo.signal = flat.peak[in_run];
  echo.sigma_m = flat.sigma_m[in_run];
  echo.strongest = 0;
  echo.begin = 0;
  echo.end = 1;
  echo.is_mixed = false;
  waveform.echoes = 1;
  return waveform.path[0];
}

void measure_pulse(const Simulation& s, std::size_t pulse, PulseMemory& memory) {
  WaveformBuffer& waveform = memory.waveform;
  const Receiver& receiver = s.prepared.sensor.receiver;
  RngKey key = memory.samples.key;
  key.beam = static_cast<std::uint32_t>(pulse);
  const bool is_flat = flat_footprint(s, pulse).is_in_closed_form();
  const EchoContribution surface =
      is_flat ? take_flat_echo(s, pulse, memory) : find_echoes(s, pulse, key, memory);
  if (traces(s, pulse)) trace_echoes(s, pulse, is_flat, waveform);
  const Status missing = receive_echoes(s, pulse, key, surface, memory);
  std::array<int, kMaxReturns> chosen;
  select_returns(receiver, {waveform.echo.data(), waveform.echoes}, chosen);
  if (traces(s, pulse)) {
    s.trace->received.assign(waveform.echo.begin(),
                             waveform.echo.begin() + static_cast<std::ptrdiff_t>(waveform.echoes));
    s.trace->returns.assign(chosen.begin(),
                            chosen.begin() + static_cast<std::ptrdiff_t>(receiver.returns.size()));
  }
  for (std::size_t r = 0; r < receiver.returns.size(); ++r) {
    const std::size_t entry = r * s.fired->firings() + pulse;
    if (chosen[r] >= 0) {
      const PulseEcho& echo = waveform.echo[static_cast<std::size_t>(chosen[r])];
      const EchoContribution& path = waveform.path[echo.strongest];
      write_ground_truth(s, path.source == kInvalidId ? surface.source : path.source, entry);
      report_echo(s, echo, path, entry);
      if (s.prepared.sensor.doppler) report_velocity(s, pulse, waveform, echo, entry);
    } else {
      const bool has_reason = (r == 0 && waveform.echoes == 0) || missing == Status::invalid_pixel;
      write_ground_truth(s, surface.source, entry);
      invalidate_return(s.frame, entry, has_reason ? missing : Status::no_return_of_rank);
    }
  }
}

/// The end of the pulses from the first on that meet nothing.
std::size_t end_of_nothing(const Simulation& s, BeamRange pulses) {
  std::size_t end = pulses.begin;
  while (end < pulses.end && flat_footprint(s, end).kind == FlatFootprint::Kind::nothing &&
         !traces(s, end)) {
    ++end;
  }
  return end;
}

/// Writes pulses without any echo.
void report_nothing(const Simulation& s, BeamRange pulses) {
  Frame& frame = s.frame;
  for (std::size_t r = 0; r < s.prepared.sensor.receiver.returns.size(); ++r) {
    const std::size_t first = r * s.fired->firings();
    write_misses(s.hit_columns, first + pulses.begin, pulses.end - pulses.begin,
                 frame.ground_truth);
    for (std::size_t pulse = pulses.begin; pulse < pulses.end; ++pulse) {
      const bool has_beam = !std::isnan(s.fired->directions[pulse].x());
      const Status missing = r == 0 ? Status::miss : Status::no_return_of_rank;
      invalidate_return(frame, first + pulse, has_beam ? missing : Status::invalid_pixel);
      if (s.hit_columns.radial_velocity) frame.true_radial_velocity_m_s[first + pulse] = kNaN;
    }
  }
}

/// The signal of each sub-ray of a run of pulses alone, of pulses in closed form that of the
/// central one, and their radial velocities if they are wanted.
void find_signals(const Simulation& s, BeamRange range, const FlatFootprints& flat_footprints,
                  PulseMemory& of_run) {
  SubRayWorkspace& memory = s.workspace.sub_rays;
  const BeamRange sub_rays{first_sub_ray(s, range.begin), first_sub_ray(s, range.end)};
  if (s.hit_columns.radial_velocity) {
    find_radial_velocities(s.motion, memory.beams, s.frame.stamp_ns, memory.hits, sub_rays,
                           memory.velocities_m_s);
  }
  if (flat_footprint(s, range.begin).kind == FlatFootprint::Kind::unknown)
    flat_footprints.find(range);
  of_run.received.clear();
  for (std::size_t pulse = range.begin; pulse < range.end; ++pulse) {
    const FlatFootprint& flat = flat_footprint(s, pulse);
    if (flat.kind == FlatFootprint::Kind::nothing) continue;
    const std::size_t first = first_sub_ray(s, pulse);
    const std::size_t end = flat.is_in_closed_form() ? first + 1 : first_sub_ray(s, pulse + 1);
    for (std::size_t ray = first; ray < end; ++ray) of_run.received.push_back(ray);
  }
  const std::size_t count = of_run.received.size();
  Hits& hits = of_run.received_hits;
  resize(hits, count, kSignalFields);
  of_run.signals.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t ray = of_run.received[k];
    hits.range_m[k] = memory.hits.range_m[ray];
    hits.instance[k] = memory.hits.instance[ray];
    hits.primitive[k] = memory.hits.primitive[ray];
    hits.cos_shading[k] = memory.hits.cos_shading[ray];
    hits.diffuse[k] = memory.hits.diffuse[ray];
  }
  received_signals(s.prepared.pulse_model->lidar_equation, s.scene, s.prepared.sensor.wavelength_m,
                   hits, {0, count}, of_run.signals);
  for (std::size_t k = 0; k < count; ++k) memory.signals[of_run.received[k]] = of_run.signals[k];
}

}  // namespace

void measure_waveforms(const Simulation& s, BeamRange tile) {
  PulseMemory memory;
  const FlatFootprints flat_footprints(s);
  for (std::size_t first = tile.begin; first < tile.end; first += kPulsesPerTask) {
    const BeamRange run{first, std::min(first + kPulsesPerTask, tile.end)};
    find_signals(s, run, flat_footprints, memory);
    flat_footprints.measure(run, memory.flat);
    sample_receiver(s.prepared.pulse_model->lidar_equation, s.frame, first, memory.samples);
    for (std::size_t pulse = run.begin; pulse < run.end; ++pulse) {
      const std::size_t end_of_misses = end_of_nothing(s, {pulse, run.end});
      if (end_of_misses > pulse) report_nothing(s, {pulse, end_of_misses});
      pulse = end_of_misses;
      if (pulse < run.end) measure_pulse(s, pulse, memory);
    }
  }
}

WaveformTrace trace_waveform(const Simulation& s, std::size_t pulse, Frame frame) {
  WaveformTrace trace;
  trace.pulse = pulse;
  const Simulation again{.scene = s.scene,
                         .prepared = s.prepared,
                         .renderer = s.renderer,
                         .beams = s.beams,
                         .motion = s.motion,
                         .hit_columns = {.radial_velocity = s.hit_columns.radial_velocity},
                         .workspace = s.workspace,
                         .frame = frame,
                         .progress = s.progress,
                         .replace_returns = s.replace_returns,
                         .fired = s.fired,
                         .trace = &trace};
  const std::size_t first = pulse - pulse % kPulsesPerTask;
  const std::size_t last = std::min(first + kPulsesPerTask, s.fired->firings());
  const auto measure = [&](BeamRange tile) { measure_waveforms(again, tile); };
  cast_pulses(again, {first, last}, FunctionRef<void(BeamRange)>(measure));
  for (std::size_t i = pulse; i < frame.radial_velocity_m_s.size(); i += s.fired->firings()) {
    trace.velocities_m_s.push_back(frame.radial_velocity_m_s[i]);
  }
  return trace;
}

}  // namespace glidar
