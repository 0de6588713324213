// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise_trace.hpp>

#include <glidar/math/gaussian.hpp>
#include <glidar/sensor/noise/lateral_noise.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

using Distribution = RandomSample::Distribution;
using Samples = std::vector<RandomSample>;

/// The entry and the step whose random numbers are requested.
struct Query {
  const Beams& beams;
  const Frame& frame;
  double frame_s;
  std::size_t entry;
  RngKey key;  ///< key of the step for the entry
};

/// The key of the batch of beams that contains the entry.
RngKey batch_key(const Query& query, std::uint32_t block = 0) {
  RngKey key = query.key;
  key.beam -= key.beam % static_cast<std::uint32_t>(kSampleBatch);
  key.block = block;
  return key;
}

/// The query for another entry of the frame.
Query at_entry(const Query& query, std::size_t entry) {
  Query other = query;
  other.key.beam = static_cast<std::uint32_t>(entry);
  other.entry = entry;
  return other;
}

double shared_normal(const Query& query, std::uint32_t block = 0) {
  Batch<double> normal;
  sample_shared_normals(batch_key(query, block), normal);
  return normal.at(query.entry % kSampleBatch);
}

double shared_uniform(const Query& query) {
  Batch<double> x;
  sample_shared_uniforms(batch_key(query), x);
  return x.at(query.entry % kSampleBatch);
}

Samples normal_sample(const Query& query, const char* use) {
  return {{Distribution::normal, shared_normal(query), use}};
}

Samples lateral_samples(const Query& query) {
  const auto own = normals(random_words(query.key));
  return {{Distribution::normal, own[0], "offset to the right in the image"},
          {Distribution::normal, own[1], "offset downwards in the image"}};
}

Samples samples(const RangeGaussian& /*step*/, const Query& query) {
  return normal_sample(query, "error of the range");
}
Samples samples(const RangeSnr& /*step*/, const Query& query) {
  return normal_sample(query, "error of the range");
}
Samples samples(const RangeCrlb& /*step*/, const Query& query) {
  return normal_sample(query, "error of the range");
}
Samples samples(const RangeShotNoise& /*step*/, const Query& query) {
  return normal_sample(query, "error of the range");
}
Samples samples(const RangeUniform& step, const Query& query) {
  const RandomWords words = random_words(query.key);
  const bool is_normal = step.distribution == RangeUniform::Distribution::normal;
  const auto x = normals(words);
  const Distribution distribution = is_normal ? Distribution::normal : Distribution::uniform;
  return {{distribution, is_normal ? x[0] : uniform(words[0]), "additive error"},
          {distribution, is_normal ? x[1] : uniform(words[1]), "multiplicative error"}};
}
Samples samples(const RangeQuantization& /*step*/, const Query& /*query*/) {
  return {};
}
Samples samples(const RangeBias& step, const Query& query) {
  if (!(step.sigma_m > 0.0)) return {};
  RngKey of_ring = query.key;
  of_ring.frame = kAllFrames;
  of_ring.beam = ring_of(query.beams, query.entry);
  return {{Distribution::normal, normals(random_words(of_ring))[0],
           "bias of the ring, constant over all frames"}};
}
Samples samples(const RangeDrift& step, const Query& query) {
  RngKey of_ring = query.key;
  of_ring.beam = step.per_ring ? ring_of(query.beams, query.entry) : 0;
  const double value = drift_at(query.frame.number, step.tau_s / query.frame_s, of_ring);
  return {
      {Distribution::normal, value, step.per_ring ? "drift of the ring" : "drift of the sensor"}};
}
Samples samples(const Dropout& step, const Query& query) {
  RandomSample chance{Distribution::uniform, shared_uniform(query), "lost if below"};
  const std::vector<float>& cosines = query.frame.ground_truth.cos_incidence;
  if (query.frame.status[query.entry] == Status::hit) {
    chance.probability = drop_probability(step, query.frame.range_m[query.entry],
                                          cosines.empty() ? 1.0 : double{cosines[query.entry]});
  }
  return {chance};
}
Samples samples(const Crosstalk& step, const Query& query) {
  const RandomWords words = random_words(query.key);
  return {
      {Distribution::uniform, uniform(words[0]), "crosstalk if below", step.probability},
      {Distribution::uniform, uniform(words[1]), "selects the other channel"},
      {Distribution::uniform, uniform(words[2]), "position between near and that channel's range"}};
}
Samples samples(const FalseAlarms& /*step*/, const Query& query) {
  return {{Distribution::uniform, shared_uniform(query), "arrival of the first false alarm"}};
}
Samples samples(const DisparityQuantization& /*step*/, const Query& /*query*/) {
  return {};
}
/// The result of mean_over_window() for the random numbers around a pixel.
double window_mean(const KinectV1& step, const Query& query) {
  const std::size_t reach = std::min<std::size_t>(step.window / 2, kMaxWindowReach);
  const std::size_t cols = query.beams.cols;
  const std::size_t row = query.entry / cols;
  const std::size_t col = query.entry % cols;
  const std::size_t end_row = std::min<std::size_t>(query.beams.rows, row + reach + 1);
  const std::size_t end_col = std::min(cols, col + reach + 1);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t r = row - std::min(row, reach); r < end_row; ++r) {
    for (std::size_t c = col - std::min(col, reach); c < end_col; ++c) {
      sum += shared_normal(at_entry(query, r * cols + c));
      count += 1.0;
    }
  }
  return sum / std::sqrt(count);
}

Samples samples(const KinectV1& step, const Query& query) {
  const std::string side = std::to_string(step.window);
  return {{Distribution::normal, shared_normal(query), "of this pixel"},
          {Distribution::normal, window_mean(step, query),
           "error of the disparity: the mean of " + side + " x " + side +
               " pixels' numbers, scaled to standard deviation 1"}};
}
Samples samples(const Khoshelham& /*step*/, const Query& query) {
  return normal_sample(query, "error of the depth");
}
Samples samples(const NguyenAxial& /*step*/, const Query& query) {
  return normal_sample(query, "error of the depth");
}
Samples samples(const NguyenLateral& /*step*/, const Query& query) {
  return lateral_samples(query);
}
Samples samples(const IclKinect& /*step*/, const Query& query) {
  Samples all = lateral_samples(query);
  all.push_back({Distribution::normal, shared_normal(query, 1), "error of the disparity"});
  return all;
}
Samples samples(const Stereo& /*step*/, const Query& query) {
  return normal_sample(query, "error of the disparity");
}
Samples samples(const ContinuousWave& step, const Query& query) {
  Samples all;
  RngKey key = query.key;
  const std::size_t count = std::min(step.frequencies_hz.size(), kMaxFrequencies);
  for (std::size_t k = 0; k < count; ++k) {
    key.block = static_cast<std::uint32_t>(k / 4);
    const char* use = k == 0 ? "error of the highest frequency's phase" : "error of a phase";
    all.push_back({Distribution::normal, normals(random_words(key)).at(k % 4), use});
  }
  return all;
}
Samples samples(const IntensityGaussian& /*step*/, const Query& query) {
  return normal_sample(query, "error of the intensity");
}
Samples samples(const IntensityScale& /*step*/, const Query& /*query*/) {
  return {};
}
Samples samples(const PointingJitter& /*step*/, const Query& query) {
  RngKey key = query.key;
  key.beam = static_cast<std::uint32_t>(query.entry % query.beams.firings());
  const auto own = normals(random_words(key));
  return {{Distribution::normal, own[0], "horizontal pointing error"},
          {Distribution::normal, own[1], "vertical pointing error"}};
}
Samples samples(const EncoderError& step, const Query& query) {
  if (!(step.turn_sigma_rad > 0.0)) return {};
  RngKey of_turn = query.key;
  of_turn.beam = 0;
  return {{Distribution::normal, normals(random_words(of_turn))[0], "error of the whole frame"}};
}

}  // namespace

std::vector<RandomSample> trace_samples(const std::vector<NoiseStep>& noise, std::size_t place,
                                        const Beams& beams, const Frame& frame, double frame_s,
                                        std::size_t entry) {
  const Query query{beams, frame, frame_s, entry, rng_key(frame, rng_purpose(place), entry)};
  return std::visit([&](const auto& step) { return samples(step, query); }, noise.at(place));
}

}  // namespace glidar
