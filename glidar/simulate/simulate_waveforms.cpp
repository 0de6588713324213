// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/simulate_waveforms.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/gaussian.hpp>
#include <glidar/sensor/lidar/beam_surfaces.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>
#include <glidar/simulate/mirrors.hpp>
#include <glidar/simulate/moving_cast.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

// For every thread: with their hits, some 90 bytes each, they fit into a core's own cache.
constexpr std::size_t kSubBeamsPerBlock = std::size_t{1} << 14U;
constexpr std::size_t kPulsesPerTask = kSampleBatch;

/// One block of beams that is being measured.
struct Block {
  const Setup& setup;
  const LidarEquation& light;      ///< as weather lets it through
  const PreparedWeather* weather;  ///< nullptr: clear air
  const std::vector<SubRay>& rays;
  const Beams& aimed;
  const HitFieldMask& fields;  ///< of the frame's truth
  BeamRange range;             ///< of pulses
  Frame& frame;
  WaveformTrace* trace;  ///< nullptr: only measured

  [[nodiscard]] const Material& material_at(const Hits& hits, std::size_t i) const {
    const Scene& scene = setup.scene;
    return material_of(scene, scene.instances[hits.instance[i]], hits.primitive[i]);
  }
  [[nodiscard]] bool traces(std::size_t beam) const {
    return trace != nullptr && trace->pulse == beam;
  }
  [[nodiscard]] std::size_t first_ray(std::size_t beam) const {
    return (beam - range.begin) * rays.size();
  }
};

HitFieldMask with_light(HitFieldMask fields) {
  fields.shading = true;
  fields.diffuse = true;
  return fields;
}

void cast(const Block& block, const Beams& beams, const HitFieldMask& fields,
          ProgressCallback progress, Hits& hits) {
  CastRequest request = request_of(block.setup, block.frame, beams, fields);
  request.progress = std::move(progress);
  cast_moving(timed_scene(block.setup, block.frame), request, block.frame.workspace, hits);
}

/// Casts the sub-rays that met a mirror once more.
void cast_mirrored(const Block& block) {
  Workspace& memory = block.frame.workspace;
  Beams& beams = memory.mirrored;
  beams.directions.clear();
  beams.origins_m.clear();
  beams.times_ns.clear();
  beams.boresight = block.aimed.boresight;
  memory.mirrored_from.clear();
  const Hits& hits = memory.sub_hits;
  for (std::size_t i = 0; i < hits.range_m.size(); ++i) {
    if (hits.instance[i] == kInvalidId || block.material_at(hits, i).mirror <= 0.0F) continue;
    add_reflected_beam(memory.sub_beams, hits, i, beams);
    memory.mirrored_from.push_back(static_cast<std::uint32_t>(i));
  }
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(beams.directions.size());
  if (beams.directions.empty()) return;
  cast(block, beams, with_light({}), {}, memory.mirrored_hits);
}

/// The way by a mirror: the light passes the mirror twice and travels both legs.
EchoContribution ghost_path(const Block& block, std::size_t mirrored, double energy) {
  const Workspace& memory = block.frame.workspace;
  const Hits& hits = memory.mirrored_hits;
  const std::uint32_t ray = memory.mirrored_from[mirrored];
  const double share = block.material_at(memory.sub_hits, ray).mirror;
  const double range_m = memory.sub_hits.range_m[ray] + hits.range_m[mirrored];
  const double sent =
      energy * share * share *
      backscatter_at(block.setup.scene, block.setup.sensor.wavelength_m, hits, mirrored);
  return {range_m, received_signal(block.light, sent, range_m), ray, ReturnSource::ghost,
          kGhostSurface};
}

/// All contributions of surfaces to the echo of a beam.
void collect_paths(const Block& block, std::size_t beam, BeamSurfaces& surfaces,
                   WaveformBuffer& work) {
  const Workspace& memory = block.frame.workspace;
  const std::size_t first = block.first_ray(beam);
  const bool is_spread = block.rays.size() > 1;
  if (is_spread) surfaces.find(memory.sub_beams, memory.sub_hits, first, block.rays.size());
  work.paths = 0;
  for (std::size_t k = 0; k < block.rays.size(); ++k) {
    const std::size_t ray = first + k;
    if (memory.sub_hits.instance[ray] == kInvalidId) continue;
    work.add({memory.sub_hits.range_m[ray], block.rays[k].share * memory.sub_signals[ray],
              static_cast<std::uint32_t>(ray), ReturnSource::surface,
              is_spread ? surfaces.of_ray(k) : std::uint16_t{0}});
  }
  const std::vector<std::uint32_t>& from = memory.mirrored_from;
  auto at = std::lower_bound(from.begin(), from.end(), first);
  for (; at != from.end() && *at < first + block.rays.size(); ++at) {
    const auto mirrored = static_cast<std::size_t>(at - from.begin());
    if (memory.mirrored_hits.instance[mirrored] == kInvalidId) continue;
    work.add(ghost_path(block, mirrored, block.rays[*at - first].share));
  }
}

/// What the air before a surface sends back.
void add_weather(const Block& block, const RngKey& draw, double surface_m,
                 std::vector<WeatherEcho>& echoes, WaveformBuffer& work) {
  if (block.weather == nullptr) return;
  echoes.clear();
  weather_echoes(*block.weather, surface_m, draw, echoes);
  for (const WeatherEcho& echo : echoes) {
    work.add({echo.range_m, echo.signal, kInvalidId, echo.return_source});
  }
}

/// Adds the receiver's noise to the echoes and keeps those that it can tell from it. The k-th echo
/// of a beam draws block k.
void detect(const Block& block, const RngKey& draw, double first_noise, WaveformBuffer& work) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < work.echoes; ++k) {
    PulseEcho echo = work.echo[k];
    if (block.light.noise_sigma > 0.0) {
      RngKey of_echo = draw;
      of_echo.block = static_cast<std::uint32_t>(k);
      echo.signal = with_noise(block.light, echo.signal,
                               k == 0 ? first_noise : normals(random_words(of_echo))[0]);
    }
    if (echo.signal >= 1.0) work.echo[kept++] = echo;
  }
  work.echoes = kept;
}

void report_echo(const Block& block, const PulseEcho& echo, const EchoContribution& path,
                 std::size_t entry) {
  Frame& frame = block.frame;
  const Sensor& sensor = block.setup.sensor;
  const double range_m = reported_range_m(sensor.receiver, echo);
  Status status = check_limits(sensor.limits, block.aimed, entry, range_m);
  if (status == Status::hit && block.light.saturation > 0.0 &&
      echo.signal >= block.light.saturation)
    status = Status::saturated;
  if (status != Status::hit) return invalidate_return(frame, entry, status);
  frame.status[entry] = Status::hit;
  frame.range_m[entry] = range_m;
  frame.intensity[entry] = static_cast<float>(echo.signal);
  const bool is_mixed = echo.is_mixed && path.return_source == ReturnSource::surface;
  frame.return_source[entry] = is_mixed ? ReturnSource::mixed_pixel : path.return_source;
}

/// The surface that stands for a beam without a return: that of the strongest path.
EchoContribution strongest_surface(const WaveformBuffer& work) {
  if (work.paths == 0) return {kNaN, 0.0, kInvalidId, ReturnSource::none};
  return *std::max_element(
      work.path.begin(), work.path.begin() + static_cast<std::ptrdiff_t>(work.paths),
      [](const EchoContribution& a, const EchoContribution& b) { return a.signal < b.signal; });
}

/// Why a beam has no echo: nothing to send one back, or too little, or so little by weather.
Status why_silent(const Block& block, const EchoContribution& surface, double loudest,
                  std::size_t beam) {
  if (surface.source == kInvalidId) {
    return std::isnan(block.aimed.directions[beam].x()) ? Status::invalid_pixel : Status::miss;
  }
  return classify_weak_return(block.light, loudest, surface.range_m);
}

/// The truth of an entry: what a sub-ray met, or a miss.
void keep_truth(const Block& block, std::uint32_t source, std::size_t entry) {
  if (source == kInvalidId) {
    write_misses(block.fields, entry, 1, block.frame.ground_truth);
    return;
  }
  copy_hit(block.frame.workspace.sub_hits, source, block.fields, block.frame.ground_truth, entry);
}

/// Random numbers of a run of beams.
struct Draws {
  RngKey detection;
  Batch<double> noise{};
};

void draw(const LidarEquation& light, const Frame& frame, std::size_t first, Draws& draws) {
  draws.detection = rng_key(frame, Purpose::detection, first);
  if (light.noise_sigma > 0.0) sample_normals(draws.detection, draws.noise);
}

/// What a thread needs for one beam after the other.
struct Tools {
  WaveformBuffer work;
  Draws draws;
  std::vector<WeatherEcho> weather;
  BeamSurfaces surfaces;
};

/// What a ghost's light met by way of the mirror.
std::uint32_t reflected_by(const Workspace& memory, std::uint32_t sub_ray) {
  const auto at =
      std::lower_bound(memory.mirrored_from.begin(), memory.mirrored_from.end(), sub_ray);
  return memory.mirrored_hits.instance[static_cast<std::size_t>(at - memory.mirrored_from.begin())];
}

void trace_echoes(const Block& block, std::size_t beam, const WaveformBuffer& work) {
  WaveformTrace& trace = *block.trace;
  const std::size_t first = block.first_ray(beam);
  trace.sub_rays = block.rays.size();
  trace.light_paths.clear();
  for (std::size_t k = 0; k < work.paths; ++k) {
    WaveformTrace::LightPath way{.path = work.path[k]};
    if (way.path.source != kInvalidId) {
      const Workspace& memory = block.frame.workspace;
      way.instance = memory.sub_hits.instance[way.path.source];
      if (way.path.return_source == ReturnSource::ghost)
        way.reflected = reflected_by(memory, way.path.source);
      way.path.source -= static_cast<std::uint32_t>(first);
      way.share = block.rays[way.path.source].share;
    }
    trace.light_paths.push_back(way);
  }
  trace.echoes.assign(work.echo.begin(),
                      work.echo.begin() + static_cast<std::ptrdiff_t>(work.echoes));
}

/// Finds the echoes that the receiver can tell; returns why there is none, should there be none.
Status find_returns(const Block& block, std::size_t beam, const EchoContribution& surface,
                    Tools& tools) {
  WaveformBuffer& work = tools.work;
  const Sensor& sensor = block.setup.sensor;
  const double wide_m =
      sensor.footprint && work.paths > 0 ? diameter_m(*sensor.footprint, surface.range_m) : 0.0;
  RngKey draw = tools.draws.detection;
  draw.beam = static_cast<std::uint32_t>(beam);
  add_weather(block, draw, surface.range_m, tools.weather, work);
  detect_peaks(pulse_sigma_m(sensor.receiver), wide_m, work);
  if (block.traces(beam)) trace_echoes(block, beam, work);
  double loudest = 0.0;
  for (std::size_t k = 0; k < work.echoes; ++k) {
    const bool is_surface = work.path[work.echo[k].strongest].source != kInvalidId;
    if (is_surface) loudest = std::max(loudest, work.echo[k].signal);
  }
  const std::size_t in_run = beam - tools.draws.detection.beam;
  detect(block, draw, tools.draws.noise[in_run], work);
  enforce_min_separation(sensor.receiver.separation_m, work);
  return why_silent(block, surface, loudest, beam);
}

void measure_beam(const Block& block, std::size_t beam, Tools& tools) {
  WaveformBuffer& work = tools.work;
  const Receiver& receiver = block.setup.sensor.receiver;
  collect_paths(block, beam, tools.surfaces, work);
  const EchoContribution surface = strongest_surface(work);
  const Status silent = find_returns(block, beam, surface, tools);
  std::array<int, kMaxReturns> chosen;
  select_returns(receiver, {work.echo.data(), work.echoes}, chosen);
  if (block.traces(beam)) {
    block.trace->received.assign(work.echo.begin(),
                                 work.echo.begin() + static_cast<std::ptrdiff_t>(work.echoes));
    block.trace->returns.assign(
        chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(receiver.returns.size()));
  }
  for (std::size_t r = 0; r < receiver.returns.size(); ++r) {
    const std::size_t entry = r * block.aimed.firings() + beam;
    if (chosen[r] >= 0) {
      const PulseEcho& echo = work.echo[static_cast<std::size_t>(chosen[r])];
      const EchoContribution& path = work.path[echo.strongest];
      keep_truth(block, path.source == kInvalidId ? surface.source : path.source, entry);
      report_echo(block, echo, path, entry);
    } else {
      const bool tells_why = (r == 0 && work.echoes == 0) || silent == Status::invalid_pixel;
      keep_truth(block, surface.source, entry);
      invalidate_return(block.frame, entry, tells_why ? silent : Status::no_return_of_rank);
    }
  }
}

/// The weather for this sensor's beams; without a footprint they are those of BeamShape.
std::optional<PreparedWeather> weather_of(const Sensor& sensor) {
  if (!sensor.weather) return {};
  check_weather(sensor);
  BeamShape beam;
  if (sensor.footprint) {
    const Footprint& f = *sensor.footprint;
    beam = {.divergence_rad = std::sqrt(f.divergence_x_rad * f.divergence_y_rad),
            .exit_diameter_m = std::sqrt(f.exit_x_m * f.exit_y_m)};
  }
  return prepare_weather(*sensor.weather, *sensor.pulse, sensor.wavelength_m, beam,
                         sensor.receiver.pulse_fwhm_s);
}

/// What each sub-ray of a run of beams brings back, were it alone.
void find_signals(const Block& block, BeamRange range) {
  Workspace& memory = block.frame.workspace;
  const BeamRange of_rays{block.first_ray(range.begin), block.first_ray(range.end)};
  received_signals(block.light, block.setup.scene, block.setup.sensor.wavelength_m, memory.sub_hits,
                   of_rays, std::span(memory.sub_signals).subspan(of_rays.begin));
}

void measure_block(const Block& block, bool mirrors) {
  Workspace& memory = block.frame.workspace;
  HitFieldMask fields = with_light(block.fields);
  fields.shading_normal = fields.shading_normal || mirrors;
  fields.normal = fields.normal || block.rays.size() > 1;
  expand_beams(block.rays, block.aimed, block.range, block.setup.renderer.thread_pool(),
               memory.sub_beams);
  const auto part = [&](std::size_t beam) {
    return static_cast<double>(beam) / static_cast<double>(block.aimed.firings());
  };
  cast(block, memory.sub_beams, fields,
       subrange(block.setup.progress, part(block.range.begin), part(block.range.end)),
       memory.sub_hits);
  memory.mirrored_from.clear();
  if (mirrors) cast_mirrored(block);
  memory.sub_signals.resize(memory.sub_beams.size());
  const std::size_t count = block.range.end - block.range.begin;
  const std::size_t runs = (count + kPulsesPerTask - 1) / kPulsesPerTask;
  block.setup.renderer.thread_pool().parallel_for(runs, 1, [&](std::size_t begin, std::size_t end) {
    Tools tools;
    for (std::size_t run = begin; run < end; ++run) {
      const std::size_t first = block.range.begin + run * kPulsesPerTask;
      const std::size_t last = std::min(first + kPulsesPerTask, block.range.end);
      find_signals(block, {first, last});
      draw(block.light, block.frame, first, tools.draws);
      for (std::size_t beam = first; beam < last; ++beam) measure_beam(block, beam, tools);
    }
  });
}

/// Measures a run of pulses that starts with a run of draws.
void measure_some(const Setup& setup, const HitFieldMask& fields, const Beams& aimed,
                  BeamRange pulses, Frame& frame, WaveformTrace* trace) {
  resize(frame.ground_truth, aimed.size(), fields);
  frame.return_source.resize(aimed.size());
  const std::vector<SubRay> rays =
      setup.sensor.footprint ? sample_footprint(*setup.sensor.footprint) : std::vector<SubRay>(1);
  const std::size_t step =
      std::max<std::size_t>(1, kSubBeamsPerBlock * setup.renderer.thread_pool().threads() /
                                   rays.size() / kPulsesPerTask) *
      kPulsesPerTask;
  const bool mirrors = has_mirrors(setup.scene);
  const std::optional<PreparedWeather> weather = weather_of(setup.sensor);
  const LidarEquation& light = weather ? weather->light : *setup.sensor.pulse;
  for (std::size_t begin = pulses.begin; begin < pulses.end; begin += step) {
    const BeamRange range{begin, std::min(begin + step, pulses.end)};
    measure_block(
        {setup, light, weather ? &*weather : nullptr, rays, aimed, fields, range, frame, trace},
        mirrors);
  }
}

}  // namespace

bool needs_waveform(const Sensor& sensor, const Scene& scene) {
  if (sensor.weather) return true;
  if (!sensor.pulse) return false;
  const Receiver& receiver = sensor.receiver;
  const Return& first = receiver.returns[0];
  const bool tells_strongest =
      receiver.returns.size() == 1 && first.order == Return::Order::strongest && first.rank == 0;
  return sensor.footprint || !tells_strongest || receiver.timing != Receiver::Timing::centroid ||
         has_mirrors(scene);
}

void simulate_waveforms(const Setup& setup, const HitFieldMask& fields, const Beams& aimed,
                        Frame& frame) {
  measure_some(setup, fields, aimed, {0, aimed.firings()}, frame, nullptr);
}

WaveformTrace trace_waveform(const Setup& setup, const Beams& aimed, std::size_t pulse,
                             Frame frame) {
  WaveformTrace trace;
  trace.pulse = pulse;
  const std::size_t first = pulse - pulse % kPulsesPerTask;
  const std::size_t last = std::min(first + kPulsesPerTask, aimed.firings());
  measure_some(setup, {}, aimed, {first, last}, frame, &trace);
  return trace;
}

}  // namespace glidar
