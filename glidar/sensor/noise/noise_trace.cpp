// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise_trace.hpp>

#include <glidar/math/gaussian.hpp>
#include <glidar/sensor/noise/lateral_noise.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

using Law = RandomSample::Law;
using Draws = std::vector<RandomSample>;

/// Who asks.
struct Asked {
  const Beams& beams;
  const Frame& frame;
  double frame_s;
  std::size_t entry;
  RngKey draw;  ///< of the step, for the entry
};

/// The draw of the run of beams that the entry belongs to.
RngKey run_of(const Asked& asked, std::uint32_t block = 0) {
  RngKey draw = asked.draw;
  draw.beam -= draw.beam % static_cast<std::uint32_t>(kDrawBatch);
  draw.block = block;
  return draw;
}

/// The same for another entry of the frame.
Asked about(const Asked& asked, std::size_t entry) {
  Asked other = asked;
  other.draw.beam = static_cast<std::uint32_t>(entry);
  other.entry = entry;
  return other;
}

double shared_normal(const Asked& asked, std::uint32_t block = 0) {
  Batch<double> normal;
  draw_shared_normals(run_of(asked, block), normal);
  return normal.at(asked.entry % kDrawBatch);
}

double shared_uniform(const Asked& asked) {
  Batch<double> x;
  draw_shared_uniforms(run_of(asked), x);
  return x.at(asked.entry % kDrawBatch);
}

Draws error_of(const Asked& asked, const char* use) {
  return {{Law::normal, shared_normal(asked), use}};
}

Draws aside(const Asked& asked) {
  const auto own = normals(random_words(asked.draw));
  return {{Law::normal, own[0], "to the right in the image"},
          {Law::normal, own[1], "downwards in the image"}};
}

Draws draws(const RangeGaussian& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the range");
}
Draws draws(const RangeSnr& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the range");
}
Draws draws(const RangeCrlb& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the range");
}
Draws draws(const RangeShotNoise& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the range");
}
Draws draws(const RangeUniform& step, const Asked& asked) {
  const RandomWords words = random_words(asked.draw);
  const bool is_normal = step.distribution == RangeUniform::Distribution::normal;
  const auto x = normals(words);
  const Law law = is_normal ? Law::normal : Law::uniform;
  return {{law, is_normal ? x[0] : uniform(words[0]), "additive error"},
          {law, is_normal ? x[1] : uniform(words[1]), "multiplicative error"}};
}
Draws draws(const RangeQuantization& /*step*/, const Asked& /*asked*/) {
  return {};
}
Draws draws(const RangeBias& step, const Asked& asked) {
  if (!(step.sigma_m > 0.0)) return {};
  RngKey of_ring = asked.draw;
  of_ring.frame = kAllFrames;
  of_ring.beam = ring_of(asked.beams, asked.entry);
  return {{Law::normal, normals(random_words(of_ring))[0], "of the ring, for the sensor's life"}};
}
Draws draws(const RangeDrift& step, const Asked& asked) {
  RngKey of_ring = asked.draw;
  of_ring.beam = step.per_ring ? ring_of(asked.beams, asked.entry) : 0;
  const double value = drift_at(asked.frame.number, step.tau_s / asked.frame_s, of_ring);
  return {{Law::normal, value, step.per_ring ? "drift of the ring" : "drift of the sensor"}};
}
Draws draws(const Dropout& step, const Asked& asked) {
  RandomSample chance{Law::uniform, shared_uniform(asked), "lost if below"};
  const std::vector<float>& cosines = asked.frame.ground_truth.cos_incidence;
  if (asked.frame.status[asked.entry] == Status::hit) {
    chance.against = drop_probability(step, asked.frame.range_m[asked.entry],
                                      cosines.empty() ? 1.0 : double{cosines[asked.entry]});
  }
  return {chance};
}
Draws draws(const Crosstalk& step, const Asked& asked) {
  const RandomWords words = random_words(asked.draw);
  return {{Law::uniform, uniform(words[0]), "crosstalk if below", step.probability},
          {Law::uniform, uniform(words[1]), "which other channel"},
          {Law::uniform, uniform(words[2]), "where before that channel's range"}};
}
Draws draws(const FalseAlarms& /*step*/, const Asked& asked) {
  return {{Law::uniform, shared_uniform(asked), "arrival of the first false echo"}};
}
Draws draws(const DisparityQuantization& /*step*/, const Asked& /*asked*/) {
  return {};
}
/// What mean_over_window makes of the draws around a pixel.
double window_mean(const KinectV1& step, const Asked& asked) {
  const std::size_t reach = std::min<std::size_t>(step.window / 2, kMaxWindowReach);
  const std::size_t cols = asked.beams.cols;
  const std::size_t row = asked.entry / cols;
  const std::size_t col = asked.entry % cols;
  const std::size_t end_row = std::min<std::size_t>(asked.beams.rows, row + reach + 1);
  const std::size_t end_col = std::min(cols, col + reach + 1);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t r = row - std::min(row, reach); r < end_row; ++r) {
    for (std::size_t c = col - std::min(col, reach); c < end_col; ++c) {
      sum += shared_normal(about(asked, r * cols + c));
      count += 1.0;
    }
  }
  return sum / std::sqrt(count);
}

Draws draws(const KinectV1& step, const Asked& asked) {
  const std::string side = std::to_string(step.window);
  return {{Law::normal, shared_normal(asked), "of the pixel alone"},
          {Law::normal, window_mean(step, asked),
           "error of the disparity: the mean of " + side + " x " + side +
               " pixels' numbers, brought to deviation 1"}};
}
Draws draws(const Khoshelham& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the depth");
}
Draws draws(const NguyenAxial& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the depth");
}
Draws draws(const NguyenLateral& /*step*/, const Asked& asked) {
  return aside(asked);
}
Draws draws(const IclKinect& /*step*/, const Asked& asked) {
  Draws all = aside(asked);
  all.push_back({Law::normal, shared_normal(asked, 1), "error of the disparity"});
  return all;
}
Draws draws(const Stereo& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the disparity");
}
Draws draws(const ContinuousWave& step, const Asked& asked) {
  Draws all;
  RngKey draw = asked.draw;
  const std::size_t count = std::min(step.frequencies_hz.size(), kMaxFrequencies);
  for (std::size_t k = 0; k < count; ++k) {
    draw.block = static_cast<std::uint32_t>(k / 4);
    const char* use = k == 0 ? "error of the highest frequency's phase" : "error of a phase";
    all.push_back({Law::normal, normals(random_words(draw)).at(k % 4), use});
  }
  return all;
}
Draws draws(const IntensityGaussian& /*step*/, const Asked& asked) {
  return error_of(asked, "error of the intensity");
}
Draws draws(const IntensityScale& /*step*/, const Asked& /*asked*/) {
  return {};
}
Draws draws(const PointingJitter& /*step*/, const Asked& asked) {
  RngKey draw = asked.draw;
  draw.beam = static_cast<std::uint32_t>(asked.entry % asked.beams.firings());
  const auto own = normals(random_words(draw));
  return {{Law::normal, own[0], "turn to the side"}, {Law::normal, own[1], "turn upwards"}};
}
Draws draws(const EncoderError& step, const Asked& asked) {
  if (!(step.turn_sigma_rad > 0.0)) return {};
  RngKey of_turn = asked.draw;
  of_turn.beam = 0;
  return {{Law::normal, normals(random_words(of_turn))[0], "error of the whole turn"}};
}

}  // namespace

std::vector<RandomSample> trace_samples(const std::vector<NoiseStep>& noise, std::size_t place,
                                        const Beams& beams, const Frame& frame, double frame_s,
                                        std::size_t entry) {
  const Asked asked{beams, frame, frame_s, entry, rng_key(frame, rng_purpose(place), entry)};
  return std::visit([&](const auto& step) { return draws(step, asked); }, noise.at(place));
}

}  // namespace glidar
