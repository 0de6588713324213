// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/pulse_cast.hpp>

#include <glidar/core/gaussian.hpp>
#include <glidar/moving_cast.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidar {
namespace {

constexpr std::size_t kSubBeamsPerBlock = std::size_t{1} << 18U;  // some 20 MB of hits
constexpr std::size_t kBeamsPerTask = kDrawBatch;
constexpr double kNoRange = std::numeric_limits<double>::quiet_NaN();

/// One block of beams that is being measured.
struct Block {
  const Setup& setup;
  const PulseLight& light;
  const std::vector<SubRay>& rays;
  const Beams& aimed;
  const HitFields& fields;  ///< of the frame's truth
  BeamRange range;          ///< of pulses
  Frame& frame;

  [[nodiscard]] std::size_t first_ray(std::size_t beam) const {
    return (beam - range.begin) * rays.size();
  }
};

const Material& material_of(const Scene& scene, const Hits& hits, std::size_t i) {
  const Instance& instance = scene.instances[hits.instance[i]];
  return scene
      .materials[instance.materials[material_slot(scene.meshes[instance.mesh], hits.primitive[i])]];
}

bool has_mirrors(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.mirror > 0.0F; });
}

HitFields with_light(HitFields fields) {
  fields.shading = true;
  fields.reflectance = true;
  return fields;
}

/// The block's progress as part of the whole.
Progress progress_of(const Block& block) {
  if (!block.setup.progress) return {};
  const auto all = static_cast<double>(block.aimed.pulses());
  return [&block, all](double fraction) {
    const auto begin = static_cast<double>(block.range.begin);
    const auto end = static_cast<double>(block.range.end);
    block.setup.progress((begin + fraction * (end - begin)) / all);
  };
}

void cast(const Block& block, const Beams& beams, const HitFields& fields, Progress progress,
          Hits& hits) {
  Frame& frame = block.frame;
  cast_moving({block.setup.renderer, block.setup.scene, block.setup.motion, frame.stamp_ns},
              {.beams = beams,
               .world_from_sensor = frame.world_from_sensor,
               .world_from_instance = frame.world_from_instance,
               .fields = fields,
               .cull_back_faces = block.setup.sensor.cull_back_faces,
               .progress = std::move(progress)},
              frame.scratch, hits);
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
    if (hits.instance[i] == kNoHit || material_of(block.setup.scene, hits, i).mirror <= 0.0F)
      continue;
    add_mirrored(memory.sub_beams, hits, i, beams);
    memory.mirrored_from.push_back(static_cast<std::uint32_t>(i));
  }
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(beams.directions.size());
  if (beams.directions.empty()) return;
  cast(block, beams, with_light({}), {}, memory.mirrored_hits);
}

/// What a way by a mirror brings back: the light passes the mirror twice and travels both legs.
double ghost_signal(const Block& block, std::size_t mirrored, double range_m) {
  const Scratch& memory = block.frame.scratch;
  const Hits& hits = memory.mirrored_hits;
  const Setup& setup = block.setup;
  const double share =
      material_of(setup.scene, memory.sub_hits, memory.mirrored_from[mirrored]).mirror;
  const double direct =
      signal_of_hit(block.light, setup.scene, setup.sensor.wavelength_m, hits, mirrored);
  return share * share * direct * signal_of(block.light, 1.0, range_m) /
         signal_of(block.light, 1.0, hits.range_m[mirrored]);
}

/// All ways by which light of a beam comes back.
void collect_paths(const Block& block, std::size_t beam, EchoWork& work) {
  const Scratch& memory = block.frame.scratch;
  const Setup& setup = block.setup;
  const std::size_t first = block.first_ray(beam);
  work.paths = 0;
  for (std::size_t k = 0; k < block.rays.size(); ++k) {
    const std::size_t ray = first + k;
    if (memory.sub_hits.instance[ray] == kNoHit) continue;
    const double signal =
        signal_of_hit(block.light, setup.scene, setup.sensor.wavelength_m, memory.sub_hits, ray);
    work.add({memory.sub_hits.range_m[ray], block.rays[k].share * signal,
              static_cast<std::uint32_t>(ray), Cause::surface});
  }
  const std::vector<std::uint32_t>& from = memory.mirrored_from;
  auto at = std::lower_bound(from.begin(), from.end(), first);
  for (; at != from.end() && *at < first + block.rays.size(); ++at) {
    const auto mirrored = static_cast<std::size_t>(at - from.begin());
    if (memory.mirrored_hits.instance[mirrored] == kNoHit) continue;
    const double range_m = memory.sub_hits.range_m[*at] + memory.mirrored_hits.range_m[mirrored];
    const double share = block.rays[*at - first].share;
    work.add({range_m, share * ghost_signal(block, mirrored, range_m), *at, Cause::ghost});
  }
}

/// Adds the receiver's noise to the echoes and keeps those that it can tell from it. The k-th echo
/// of a beam draws block k.
void detect(const Block& block, const Draw& draw, double first_noise, EchoWork& work) {
  const double sigma = block.light.noise_sigma;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < work.echoes; ++k) {
    PulseEcho echo = work.echo[k];
    if (sigma > 0.0) {
      Draw of_echo = draw;
      of_echo.block = static_cast<std::uint32_t>(k);
      echo.signal += sigma * (k == 0 ? first_noise : normals(random_words(of_echo))[0]);
    }
    if (echo.signal >= 1.0) work.echo[kept++] = echo;
  }
  work.echoes = kept;
}

void report_nothing(Status why, std::size_t entry, Frame& frame) {
  frame.status[entry] = why;
  frame.range_m[entry] = kNoRange;
  frame.intensity[entry] = 0.0F;
  frame.cause[entry] = Cause::none;
}

void report_echo(const Block& block, const PulseEcho& echo, const Path& path, std::size_t entry) {
  Frame& frame = block.frame;
  const Sensor& sensor = block.setup.sensor;
  const double range_m = told_range_m(sensor.receiver, echo);
  Status status = judge(sensor.limits, block.aimed, entry, range_m);
  if (block.light.saturation > 0.0 && echo.signal >= block.light.saturation)
    status = Status::saturated;
  if (status != Status::hit) return report_nothing(status, entry, frame);
  frame.status[entry] = Status::hit;
  frame.range_m[entry] = range_m;
  frame.intensity[entry] = static_cast<float>(echo.signal);
  const bool is_mixed = echo.is_mixed && path.cause == Cause::surface;
  frame.cause[entry] = is_mixed ? Cause::mixed : path.cause;
}

/// The path that stands for a beam without a return: the strongest.
std::uint32_t strongest_source(const EchoWork& work) {
  if (work.paths == 0) return kNoHit;
  return std::max_element(work.path.begin(),
                          work.path.begin() + static_cast<std::ptrdiff_t>(work.paths),
                          [](const Path& a, const Path& b) { return a.signal < b.signal; })
      ->source;
}

/// The truth of an entry: what a sub-ray met, or a miss.
void keep_truth(const Block& block, std::uint32_t source, std::size_t entry) {
  if (source == kNoHit) {
    write_misses(block.fields, entry, 1, block.frame.truth);
    return;
  }
  copy_hit(block.frame.scratch.sub_hits, source, block.fields, block.frame.truth, entry);
}

/// What noise alone makes of a beam without an echo.
void report_false_alarm(const Block& block, double noise, double place, std::size_t entry) {
  Frame& frame = block.frame;
  const double signal = block.light.noise_sigma * noise;
  if (!(block.light.false_alarm_range_m > 0.0) || signal < 1.0) return;
  frame.status[entry] = Status::hit;
  frame.range_m[entry] = place * block.light.false_alarm_range_m;
  frame.intensity[entry] = static_cast<float>(signal);
  frame.cause[entry] = Cause::false_alarm;
}

/// Random numbers of a run of beams.
struct Draws {
  Draw detection;
  Batch<double> noise{};
  PairBatch places{};
};

void draw(const PulseLight& light, const Frame& frame, std::size_t first, Draws& draws) {
  draws.detection = {.seed = frame.seed,
                     .sensor = frame.sensor_id,
                     .frame = frame.number,
                     .beam = static_cast<std::uint32_t>(first),
                     .purpose = Purpose::detection};
  if (light.noise_sigma > 0.0) draw_normals(draws.detection, draws.noise);
  Draw places = draws.detection;
  places.purpose = Purpose::false_alarm;
  if (light.false_alarm_range_m > 0.0) draw_uniforms(places, draws.places);
}

/// Whether clear air had let any of the echoes through.
Status why_faint(const PulseLight& light, const EchoWork& work) {
  for (std::size_t k = 0; k < work.echoes; ++k) {
    const PulseEcho& echo = work.echo[k];
    if (why_faint(light, echo.signal, 0.0, echo.range_m) == Status::weather) return Status::weather;
  }
  return Status::below_threshold;
}

void measure_beam(const Block& block, std::size_t beam, const Draws& draws, EchoWork& work) {
  const Receiver& receiver = block.setup.sensor.receiver;
  const std::size_t k = beam - draws.detection.beam;
  collect_paths(block, beam, work);
  const std::uint32_t strongest = strongest_source(work);
  const double nearest_m = work.paths == 0 ? 0.0 : work.path[0].range_m;
  const double wide_m =
      block.setup.sensor.footprint ? diameter_m(*block.setup.sensor.footprint, nearest_m) : 0.0;
  find_echoes(pulse_sigma_m(receiver), wide_m, work);
  const Status faint = why_faint(block.light, work);
  Draw of_beam = draws.detection;
  of_beam.beam = static_cast<std::uint32_t>(beam);
  detect(block, of_beam, draws.noise[k], work);
  keep_separate(receiver.separation_m, work);

  std::array<int, kMostReturns> chosen;
  choose(receiver, {work.echo.data(), work.echoes}, chosen);
  const bool has_beam = !std::isnan(block.aimed.directions[beam].x());
  const Status nothing = strongest != kNoHit ? faint : has_beam ? Status::miss : Status::no_beam;
  for (std::size_t r = 0; r < receiver.returns.size(); ++r) {
    const std::size_t entry = r * block.aimed.pulses() + beam;
    if (chosen[r] >= 0) {
      const PulseEcho& echo = work.echo[static_cast<std::size_t>(chosen[r])];
      const Path& path = work.path[echo.strongest];
      keep_truth(block, path.source == kNoHit ? strongest : path.source, entry);
      report_echo(block, echo, path, entry);
      continue;
    }
    const bool is_first = r == 0;
    keep_truth(block, is_first ? strongest : kNoHit, entry);
    report_nothing(is_first || !has_beam ? nothing : Status::no_echo, entry, block.frame);
    if (is_first && nothing == Status::miss)
      report_false_alarm(block, draws.noise[k], draws.places.first[k], entry);
  }
}

void measure_block(const Block& block, bool mirrors) {
  Scratch& memory = block.frame.scratch;
  HitFields fields = with_light(block.fields);
  fields.shading_normal = fields.shading_normal || mirrors;
  spread(block.rays, block.aimed, block.range, memory.sub_beams);
  cast(block, memory.sub_beams, fields, progress_of(block), memory.sub_hits);
  memory.mirrored_from.clear();
  if (mirrors) cast_mirrored(block);
  const std::size_t count = block.range.end - block.range.begin;
  const std::size_t runs = (count + kBeamsPerTask - 1) / kBeamsPerTask;
  block.setup.renderer.workers().for_ranges(runs, 1, [&](std::size_t begin, std::size_t end) {
    EchoWork work;
    Draws draws;
    for (std::size_t run = begin; run < end; ++run) {
      const std::size_t first = block.range.begin + run * kBeamsPerTask;
      const std::size_t last = std::min(first + kBeamsPerTask, block.range.end);
      draw(block.light, block.frame, first, draws);
      for (std::size_t beam = first; beam < last; ++beam) measure_beam(block, beam, draws, work);
    }
  });
}

}  // namespace

bool has_echoes(const Sensor& sensor, const Scene& scene) {
  if (!sensor.pulse) return false;
  const Receiver& receiver = sensor.receiver;
  const Return& first = receiver.returns[0];
  const bool tells_strongest =
      receiver.returns.size() == 1 && first.order == Return::Order::strongest && first.rank == 0;
  return sensor.footprint || !tells_strongest || receiver.timing != Receiver::Timing::centroid ||
         has_mirrors(scene);
}

void measure_pulses(const Setup& setup, const HitFields& fields, const Beams& aimed, Frame& frame) {
  resize(frame.truth, aimed.size(), fields);
  frame.cause.resize(aimed.size());
  const std::vector<SubRay> rays =
      setup.sensor.footprint ? sub_rays(*setup.sensor.footprint) : std::vector<SubRay>(1);
  const std::size_t step =
      std::max<std::size_t>(1, kSubBeamsPerBlock / rays.size() / kBeamsPerTask) * kBeamsPerTask;
  const bool mirrors = has_mirrors(setup.scene);
  const PulseLight light = *light_in_weather(setup.sensor);
  for (std::size_t begin = 0; begin < aimed.pulses(); begin += step) {
    const BeamRange range{begin, std::min(begin + step, aimed.pulses())};
    measure_block({setup, light, rays, aimed, fields, range, frame}, mirrors);
  }
}

}  // namespace glidar
