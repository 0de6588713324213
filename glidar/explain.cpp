// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/explain.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/gaussian.hpp>

namespace glidar {
namespace {

Reading reading_of(const Frame& frame, std::size_t entry) {
  const Cause usual = frame.status[entry] == Status::hit ? Cause::surface : Cause::none;
  return {.status = frame.status[entry],
          .cause = frame.cause.empty() ? usual : frame.cause[entry],
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

/// Applies the first steps of the sensor's list, alone, to a frame as it was measured.
void apply_first(const Setup& setup, std::size_t count, const Columns& measured, Frame& frame) {
  const std::vector<NoiseStep>& all = setup.sensor.noise;
  frame.range_m = measured.range_m;
  frame.intensity = measured.intensity;
  frame.status = measured.status;
  frame.cause = measured.cause;
  apply_noise({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)},
              1.0 / setup.sensor.rate_hz, setup.beams, setup.renderer.workers(), frame);
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

}  // namespace

Story explain(const Setup& setup, std::size_t entry, Frame& frame) {
  if (entry >= setup.beams.size()) {
    throw Error({.where = "index",
                 .found = std::to_string(entry),
                 .allowed = "0 to " + std::to_string(setup.beams.size() - 1) +
                            ", the entries of this frame",
                 .remedy = ""});
  }
  Story story;
  story.entry = entry;
  PulseTrace trace;
  trace.pulse = entry % setup.beams.pulses();
  measure(setup, kAllHitFields, frame, &trace);
  if (has_echoes(setup.sensor, setup.scene)) story.pulse = std::move(trace);
  const std::vector<Eigen::Vector3d>& aimed = frame.scratch.aimed.directions;
  story.aimed = aimed.empty() ? setup.beams.directions[entry] : aimed[entry];
  story.receiver_noise = receiver_noise(setup.sensor, frame, story, entry % setup.beams.pulses());
  story.measured = reading_of(frame, entry);

  const double frame_s = 1.0 / setup.sensor.rate_hz;
  const std::vector<NoiseStep>& noise = setup.sensor.noise;
  const Columns measured{frame.range_m, frame.intensity, frame.status, frame.cause};
  apply_first(setup, 0, measured, frame);
  for (std::size_t k = 0; k < noise.size(); ++k) {
    apply_first(setup, k + 1, measured, frame);
    story.noise.push_back(
        {draws_of(noise, k, setup.beams, frame, frame_s, entry), reading_of(frame, entry)});
  }
  return story;
}

}  // namespace glidar
