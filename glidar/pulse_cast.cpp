// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/pulse_cast.hpp>

#include <glidar/core/constants.hpp>
#include <glidar/core/gaussian.hpp>
#include <glidar/moving_cast.hpp>
#include <glidar/sensor/beam_surfaces.hpp>
#include <glidar/sensor/weather_echoes.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

// For every thread: with their hits, some 90 bytes each, they fit into a core's own cache.
constexpr std::size_t kSubBeamsPerBlock = std::size_t{1} << 14U;
constexpr std::size_t kPulsesPerTask = kDrawBatch;

/// One block of beams that is being measured.
struct Block {
  const Setup& setup;
  const PulseLight& light;         ///< as weather lets it through
  const PreparedWeather* weather;  ///< nullptr: clear air
  const std::vector<SubRay>& rays;
  const Beams& aimed;
  const HitFields& fields;  ///< of the frame's truth
  BeamRange range;          ///< of pulses
  Frame& frame;
  PulseTrace* trace;  ///< nullptr: only measured

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

bool has_mirrors(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.mirror > 0.0F; });
}

HitFields with_light(HitFields fields) {
  fields.shading = true;
  fields.diffuse = true;
  return fields;
}

void cast(const Block& block, const Beams& beams, const HitFields& fields, Progress progress,
          Hits& hits) {
  CastRequest request = request_of(block.setup, block.frame, beams, fields);
  request.progress = std::move(progress);
  cast_moving(world_of(block.setup, block.frame), request, block.frame.scratch, hits);
}

/// The beam that goes on from a mirror: d - 2 (d . n) n, from just before the surface so that it
/// does not meet it again.
void add_mirrored(const Beams& from, const Hits& hits, std::size_t ray, Beams& beams) {
  constexpr double kClear = 1e-7;  // of the range; far above rounding, far below what sensors tell
  const Eigen::Vector3d direction = from.directions[ray];
  const Eigen::Vector3d normal = hits.shading_normal[ray].cast<double>().normalized();
  const double range_m = hits.range_m[ray];
  Eigen::Vector3d origin = (range_m - kClear * std::max(1.0, range_m)) * direction;
  if (!from.origins_m.empty()) origin += from.origins_m[ray];
  beams.origins_m.push_back(origin);
  beams.directions.push_back((direction - 2.0 * direction.dot(normal) * normal).normalized());
  if (!from.times_ns.empty()) beams.times_ns.push_back(from.times_ns[ray]);
}

/// Casts the sub-rays that met a mirror once more.
void cast_mirrored(const Block& block) {
  Scratch& memory = block.frame.scratch;
  Beams& beams = memory.mirrored;
  beams.directions.clear();
  beams.origins_m.clear();
  beams.times_ns.clear();
  beams.boresight = block.aimed.boresight;
  memory.mirrored_from.clear();
  const Hits& hits = memory.sub_hits;
  for (std::size_t i = 0; i < hits.range_m.size(); ++i) {
    if (hits.instance[i] == kNoHit || block.material_at(hits, i).mirror <= 0.0F) continue;
    add_mirrored(memory.sub_beams, hits, i, beams);
    memory.mirrored_from.push_back(static_cast<std::uint32_t>(i));
  }
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(beams.directions.size());
  if (beams.directions.empty()) return;
  cast(block, beams, with_light({}), {}, memory.mirrored_hits);
}

/// The way by a mirror: the light passes the mirror twice and travels both legs.
Path ghost_path(const Block& block, std::size_t mirrored, double energy) {
  const Scratch& memory = block.frame.scratch;
  const Hits& hits = memory.mirrored_hits;
  const std::uint32_t ray = memory.mirrored_from[mirrored];
  const double share = block.material_at(memory.sub_hits, ray).mirror;
  const double range_m = memory.sub_hits.range_m[ray] + hits.range_m[mirrored];
  const double sent =
      energy * share * share *
      sent_back_at(block.setup.scene, block.setup.sensor.wavelength_m, hits, mirrored);
  return {range_m, signal_of(block.light, sent, range_m), ray, Cause::ghost, kGhostSurface};
}

/// All ways by which light of a beam comes back from surfaces.
void collect_paths(const Block& block, std::size_t beam, BeamSurfaces& surfaces, EchoWork& work) {
  const Scratch& memory = block.frame.scratch;
  const std::size_t first = block.first_ray(beam);
  const bool is_spread = block.rays.size() > 1;
  if (is_spread) surfaces.find(memory.sub_beams, memory.sub_hits, first, block.rays.size());
  work.paths = 0;
  for (std::size_t k = 0; k < block.rays.size(); ++k) {
    const std::size_t ray = first + k;
    if (memory.sub_hits.instance[ray] == kNoHit) continue;
    work.add({memory.sub_hits.range_m[ray], block.rays[k].share * memory.sub_signals[ray],
              static_cast<std::uint32_t>(ray), Cause::surface,
              is_spread ? surfaces.of_ray(k) : std::uint16_t{0}});
  }
  const std::vector<std::uint32_t>& from = memory.mirrored_from;
  auto at = std::lower_bound(from.begin(), from.end(), first);
  for (; at != from.end() && *at < first + block.rays.size(); ++at) {
    const auto mirrored = static_cast<std::size_t>(at - from.begin());
    if (memory.mirrored_hits.instance[mirrored] == kNoHit) continue;
    work.add(ghost_path(block, mirrored, block.rays[*at - first].share));
  }
}

/// What the air before a surface sends back.
void add_weather(const Block& block, const Draw& draw, double surface_m,
                 std::vector<WeatherEcho>& echoes, EchoWork& work) {
  if (block.weather == nullptr) return;
  echoes.clear();
  weather_echoes(*block.weather, surface_m, draw, echoes);
  for (const WeatherEcho& echo : echoes) {
    work.add({echo.range_m, echo.signal, kNoHit, echo.cause});
  }
}

/// Adds the receiver's noise to the echoes and keeps those that it can tell from it. The k-th echo
/// of a beam draws block k.
void detect(const Block& block, const Draw& draw, double first_noise, EchoWork& work) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < work.echoes; ++k) {
    PulseEcho echo = work.echo[k];
    if (block.light.noise_sigma > 0.0) {
      Draw of_echo = draw;
      of_echo.block = static_cast<std::uint32_t>(k);
      echo.signal = with_noise(block.light, echo.signal,
                               k == 0 ? first_noise : normals(random_words(of_echo))[0]);
    }
    if (echo.signal >= 1.0) work.echo[kept++] = echo;
  }
  work.echoes = kept;
}

void report_echo(const Block& block, const PulseEcho& echo, const Path& path, std::size_t entry) {
  Frame& frame = block.frame;
  const Sensor& sensor = block.setup.sensor;
  const double range_m = told_range_m(sensor.receiver, echo);
  Status status = judge(sensor.limits, block.aimed, entry, range_m);
  if (status == Status::hit && block.light.saturation > 0.0 &&
      echo.signal >= block.light.saturation)
    status = Status::saturated;
  if (status != Status::hit) return lose(frame, entry, status);
  frame.status[entry] = Status::hit;
  frame.range_m[entry] = range_m;
  frame.intensity[entry] = static_cast<float>(echo.signal);
  const bool is_mixed = echo.is_mixed && path.cause == Cause::surface;
  frame.cause[entry] = is_mixed ? Cause::mixed : path.cause;
}

/// The surface that stands for a beam without a return: that of the strongest path.
Path strongest_surface(const EchoWork& work) {
  if (work.paths == 0) return {kNaN, 0.0, kNoHit, Cause::none};
  return *std::max_element(work.path.begin(),
                           work.path.begin() + static_cast<std::ptrdiff_t>(work.paths),
                           [](const Path& a, const Path& b) { return a.signal < b.signal; });
}

/// Why a beam has no echo: nothing to send one back, or too little, or so little by weather.
Status why_silent(const Block& block, const Path& surface, double loudest, std::size_t beam) {
  if (surface.source == kNoHit) {
    return std::isnan(block.aimed.directions[beam].x()) ? Status::no_beam : Status::miss;
  }
  return why_faint(block.light, loudest, surface.range_m);
}

/// The truth of an entry: what a sub-ray met, or a miss.
void keep_truth(const Block& block, std::uint32_t source, std::size_t entry) {
  if (source == kNoHit) {
    write_misses(block.fields, entry, 1, block.frame.truth);
    return;
  }
  copy_hit(block.frame.scratch.sub_hits, source, block.fields, block.frame.truth, entry);
}

/// Random numbers of a run of beams.
struct Draws {
  Draw detection;
  Batch<double> noise{};
};

void draw(const PulseLight& light, const Frame& frame, std::size_t first, Draws& draws) {
  draws.detection = draw_of(frame, Purpose::detection, first);
  if (light.noise_sigma > 0.0) draw_normals(draws.detection, draws.noise);
}

/// What a thread needs for one beam after the other.
struct Tools {
  EchoWork work;
  Draws draws;
  std::vector<WeatherEcho> weather;
  BeamSurfaces surfaces;
};

/// What a ghost's light met by way of the mirror.
std::uint32_t reflected_by(const Scratch& memory, std::uint32_t sub_ray) {
  const auto at =
      std::lower_bound(memory.mirrored_from.begin(), memory.mirrored_from.end(), sub_ray);
  return memory.mirrored_hits.instance[static_cast<std::size_t>(at - memory.mirrored_from.begin())];
}

void trace_echoes(const Block& block, std::size_t beam, const EchoWork& work) {
  PulseTrace& trace = *block.trace;
  const std::size_t first = block.first_ray(beam);
  trace.sub_rays = block.rays.size();
  trace.ways.clear();
  for (std::size_t k = 0; k < work.paths; ++k) {
    PulseTrace::Way way{.path = work.path[k]};
    if (way.path.source != kNoHit) {
      const Scratch& memory = block.frame.scratch;
      way.instance = memory.sub_hits.instance[way.path.source];
      if (way.path.cause == Cause::ghost) way.reflected = reflected_by(memory, way.path.source);
      way.path.source -= static_cast<std::uint32_t>(first);
      way.share = block.rays[way.path.source].share;
    }
    trace.ways.push_back(way);
  }
  trace.echoes.assign(work.echo.begin(),
                      work.echo.begin() + static_cast<std::ptrdiff_t>(work.echoes));
}

/// Finds the echoes that the receiver can tell; returns why there is none, should there be none.
Status find_returns(const Block& block, std::size_t beam, const Path& surface, Tools& tools) {
  EchoWork& work = tools.work;
  const Sensor& sensor = block.setup.sensor;
  const double wide_m =
      sensor.footprint && work.paths > 0 ? diameter_m(*sensor.footprint, surface.range_m) : 0.0;
  Draw draw = tools.draws.detection;
  draw.beam = static_cast<std::uint32_t>(beam);
  add_weather(block, draw, surface.range_m, tools.weather, work);
  find_echoes(pulse_sigma_m(sensor.receiver), wide_m, work);
  if (block.traces(beam)) trace_echoes(block, beam, work);
  double loudest = 0.0;
  for (std::size_t k = 0; k < work.echoes; ++k) {
    const bool is_surface = work.path[work.echo[k].strongest].source != kNoHit;
    if (is_surface) loudest = std::max(loudest, work.echo[k].signal);
  }
  const std::size_t in_run = beam - tools.draws.detection.beam;
  detect(block, draw, tools.draws.noise[in_run], work);
  keep_separate(sensor.receiver.separation_m, work);
  return why_silent(block, surface, loudest, beam);
}

void measure_beam(const Block& block, std::size_t beam, Tools& tools) {
  EchoWork& work = tools.work;
  const Receiver& receiver = block.setup.sensor.receiver;
  collect_paths(block, beam, tools.surfaces, work);
  const Path surface = strongest_surface(work);
  const Status silent = find_returns(block, beam, surface, tools);
  std::array<int, kMostReturns> chosen;
  choose(receiver, {work.echo.data(), work.echoes}, chosen);
  if (block.traces(beam)) {
    block.trace->received.assign(work.echo.begin(),
                                 work.echo.begin() + static_cast<std::ptrdiff_t>(work.echoes));
    block.trace->returns.assign(
        chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(receiver.returns.size()));
  }
  for (std::size_t r = 0; r < receiver.returns.size(); ++r) {
    const std::size_t entry = r * block.aimed.pulses() + beam;
    if (chosen[r] >= 0) {
      const PulseEcho& echo = work.echo[static_cast<std::size_t>(chosen[r])];
      const Path& path = work.path[echo.strongest];
      keep_truth(block, path.source == kNoHit ? surface.source : path.source, entry);
      report_echo(block, echo, path, entry);
    } else {
      const bool tells_why = (r == 0 && work.echoes == 0) || silent == Status::no_beam;
      keep_truth(block, surface.source, entry);
      lose(block.frame, entry, tells_why ? silent : Status::no_echo);
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
  Scratch& memory = block.frame.scratch;
  const BeamRange of_rays{block.first_ray(range.begin), block.first_ray(range.end)};
  signals_of_hits(block.light, block.setup.scene, block.setup.sensor.wavelength_m, memory.sub_hits,
                  of_rays, std::span(memory.sub_signals).subspan(of_rays.begin));
}

void measure_block(const Block& block, bool mirrors) {
  Scratch& memory = block.frame.scratch;
  HitFields fields = with_light(block.fields);
  fields.shading_normal = fields.shading_normal || mirrors;
  fields.normal = fields.normal || block.rays.size() > 1;
  spread(block.rays, block.aimed, block.range, block.setup.renderer.workers(), memory.sub_beams);
  const auto part = [&](std::size_t beam) {
    return static_cast<double>(beam) / static_cast<double>(block.aimed.pulses());
  };
  cast(block, memory.sub_beams, fields,
       part_of(block.setup.progress, part(block.range.begin), part(block.range.end)),
       memory.sub_hits);
  memory.mirrored_from.clear();
  if (mirrors) cast_mirrored(block);
  memory.sub_signals.resize(memory.sub_beams.size());
  const std::size_t count = block.range.end - block.range.begin;
  const std::size_t runs = (count + kPulsesPerTask - 1) / kPulsesPerTask;
  block.setup.renderer.workers().for_ranges(runs, 1, [&](std::size_t begin, std::size_t end) {
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
void measure_some(const Setup& setup, const HitFields& fields, const Beams& aimed, BeamRange pulses,
                  Frame& frame, PulseTrace* trace) {
  resize(frame.truth, aimed.size(), fields);
  frame.cause.resize(aimed.size());
  const std::vector<SubRay> rays =
      setup.sensor.footprint ? sub_rays(*setup.sensor.footprint) : std::vector<SubRay>(1);
  const std::size_t step =
      std::max<std::size_t>(1, kSubBeamsPerBlock * setup.renderer.workers().threads() /
                                   rays.size() / kPulsesPerTask) *
      kPulsesPerTask;
  const bool mirrors = has_mirrors(setup.scene);
  const std::optional<PreparedWeather> weather = weather_of(setup.sensor);
  const PulseLight& light = weather ? weather->light : *setup.sensor.pulse;
  for (std::size_t begin = pulses.begin; begin < pulses.end; begin += step) {
    const BeamRange range{begin, std::min(begin + step, pulses.end)};
    measure_block(
        {setup, light, weather ? &*weather : nullptr, rays, aimed, fields, range, frame, trace},
        mirrors);
  }
}

}  // namespace

bool has_echoes(const Sensor& sensor, const Scene& scene) {
  if (sensor.weather) return true;
  if (!sensor.pulse) return false;
  const Receiver& receiver = sensor.receiver;
  const Return& first = receiver.returns[0];
  const bool tells_strongest =
      receiver.returns.size() == 1 && first.order == Return::Order::strongest && first.rank == 0;
  return sensor.footprint || !tells_strongest || receiver.timing != Receiver::Timing::centroid ||
         has_mirrors(scene);
}

void measure_pulses(const Setup& setup, const HitFields& fields, const Beams& aimed, Frame& frame) {
  measure_some(setup, fields, aimed, {0, aimed.pulses()}, frame, nullptr);
}

PulseTrace trace_pulse(const Setup& setup, const Beams& aimed, std::size_t pulse, Frame frame) {
  PulseTrace trace;
  trace.pulse = pulse;
  const std::size_t first = pulse - pulse % kPulsesPerTask;
  const std::size_t last = std::min(first + kPulsesPerTask, aimed.pulses());
  measure_some(setup, {}, aimed, {first, last}, frame, &trace);
  return trace;
}

}  // namespace glidar
