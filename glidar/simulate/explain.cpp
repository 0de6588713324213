// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/explain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/gaussian.hpp>

namespace glidar {
namespace {

Measurement reading_of(const Frame& frame, std::size_t entry) {
  const bool is_hit = frame.status[entry] == Status::hit;
  const ReturnSource cause =
      frame.return_source.empty() ? ReturnSource::surface : frame.return_source[entry];
  return {.status = frame.status[entry],
          .return_source = is_hit ? cause : ReturnSource::none,
          .range_m = frame.range_m[entry],
          .intensity = frame.intensity[entry],
          .sigma_m = frame.sigma_m.empty() ? 0.0F : frame.sigma_m[entry]};
}

/// The columns that noise changes.
struct Columns {
  std::vector<double> range_m;
  std::vector<float> intensity;
  std::vector<Status> status;
  std::vector<ReturnSource> return_source;
};

/// Applies the first steps of the sensor's list to a frame as it was measured.
void apply_first(const Setup& setup, std::size_t count, const Columns& measured, Frame& frame) {
  frame.range_m = measured.range_m;
  frame.intensity = measured.intensity;
  frame.status = measured.status;
  frame.return_source = measured.return_source;
  apply_noise_prefix(setup.sensor.noise, count, 1.0 / setup.sensor.rate_hz, setup.beams,
                     setup.renderer.thread_pool(), frame);
}

std::vector<double> receiver_noise(const Sensor& sensor, const Frame& frame,
                                   const PointTrace& story, std::size_t pulse) {
  if (!sensor.pulse || !(sensor.pulse->noise_sigma > 0.0)) return {};
  const std::size_t count = story.pulse ? story.pulse->echoes.size() : 1;
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

/// What is known of a picked entry before the noise.
PointTrace begin_story(const Setup& setup, std::size_t entry, const Frame& frame) {
  require_entry(entry, setup.beams);
  const std::size_t pulse = entry % setup.beams.firings();
  const Beams& turned = frame.workspace.aimed;
  const Beams& aimed = turned.directions.empty() ? setup.beams : turned;
  PointTrace story;
  story.entry = entry;
  story.direction = aimed.directions[entry];
  if (needs_waveform(setup.sensor, setup.scene))
    story.pulse = trace_waveform(setup, aimed, pulse, frame);
  story.receiver_noise = receiver_noise(setup.sensor, frame, story, pulse);
  return story;
}

}  // namespace

PointTrace explain(const Setup& setup, const EntrySelector& pick, Frame& frame) {
  measure(setup, kAllHitFields, frame);
  const Columns measured{frame.range_m, frame.intensity, frame.status, frame.return_source};
  const std::vector<NoiseStep>& noise = setup.sensor.noise;
  apply_first(setup, noise.size(), measured, frame);
  PointTrace story = begin_story(setup, pick(frame), frame);
  apply_first(setup, 0, measured, frame);
  story.measured = reading_of(frame, story.entry);
  for (std::size_t k = 0; k < noise.size(); ++k) {
    std::vector<RandomSample> draws =
        trace_samples(noise, k, setup.beams, frame, 1.0 / setup.sensor.rate_hz, story.entry);
    apply_first(setup, k + 1, measured, frame);
    story.noise.push_back({std::move(draws), reading_of(frame, story.entry)});
  }
  return story;
}

PointTrace explain(const Setup& setup, std::size_t entry, Frame& frame) {
  require_entry(entry, setup.beams);
  return explain(
      setup, [entry](const Frame& /*frame*/) { return entry; }, frame);
}

}  // namespace glidar
