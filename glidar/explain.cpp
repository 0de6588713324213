// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/explain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/gaussian.hpp>

namespace glidar {
namespace {

Reading reading_of(const Frame& frame, std::size_t entry) {
  const bool is_hit = frame.status[entry] == Status::hit;
  const Cause cause = frame.cause.empty() ? Cause::surface : frame.cause[entry];
  return {.status = frame.status[entry],
          .cause = is_hit ? cause : Cause::none,
          .range_m = frame.range_m[entry],
          .intensity = frame.intensity[entry],
          .sigma_m = frame.sigma_m.empty() ? 0.0F : frame.sigma_m[entry]};
}

/// The columns that noise changes.
struct Columns {
  std::vector<double> range_m;
  std::vector<float> intensity;
  std::vector<Status> status;
  std::vector<Cause> cause;
};

/// Applies the first steps of the sensor's list to a frame as it was measured.
void apply_first(const Setup& setup, std::size_t count, const Columns& measured, Frame& frame) {
  frame.range_m = measured.range_m;
  frame.intensity = measured.intensity;
  frame.status = measured.status;
  frame.cause = measured.cause;
  apply_first_steps(setup.sensor.noise, count, 1.0 / setup.sensor.rate_hz, setup.beams,
                    setup.renderer.workers(), frame);
}

std::vector<double> receiver_noise(const Sensor& sensor, const Frame& frame, const Story& story,
                                   std::size_t pulse) {
  if (!sensor.pulse || !(sensor.pulse->noise_sigma > 0.0)) return {};
  const std::size_t count = story.pulse ? story.pulse->echoes.size() : 1;
  Draw draw = draw_of(frame, Purpose::detection, pulse);
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
Story begin_story(const Setup& setup, std::size_t entry, const Frame& frame) {
  require_entry(entry, setup.beams);
  const std::size_t pulse = entry % setup.beams.pulses();
  const Beams& turned = frame.scratch.aimed;
  const Beams& aimed = turned.directions.empty() ? setup.beams : turned;
  Story story;
  story.entry = entry;
  story.direction = aimed.directions[entry];
  if (has_echoes(setup.sensor, setup.scene)) story.pulse = trace_pulse(setup, aimed, pulse, frame);
  story.receiver_noise = receiver_noise(setup.sensor, frame, story, pulse);
  return story;
}

}  // namespace

Story explain(const Setup& setup, const PickEntry& pick, Frame& frame) {
  measure(setup, kAllHitFields, frame);
  const Columns measured{frame.range_m, frame.intensity, frame.status, frame.cause};
  const std::vector<NoiseStep>& noise = setup.sensor.noise;
  apply_first(setup, noise.size(), measured, frame);
  Story story = begin_story(setup, pick(frame), frame);
  apply_first(setup, 0, measured, frame);
  story.measured = reading_of(frame, story.entry);
  for (std::size_t k = 0; k < noise.size(); ++k) {
    std::vector<Drawn> draws =
        draws_of(noise, k, setup.beams, frame, 1.0 / setup.sensor.rate_hz, story.entry);
    apply_first(setup, k + 1, measured, frame);
    story.noise.push_back({std::move(draws), reading_of(frame, story.entry)});
  }
  return story;
}

Story explain(const Setup& setup, std::size_t entry, Frame& frame) {
  require_entry(entry, setup.beams);
  return explain(
      setup, [entry](const Frame& /*frame*/) { return entry; }, frame);
}

}  // namespace glidar
