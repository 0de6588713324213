// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/dropout.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/lateral_noise.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

namespace glidar {
namespace {

/// The ranges of the first arrivals, from uniform numbers.
GLIDAR_SIMD void first_arrivals(double near_m, double metres, Batch<double>& x) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) x[i] = near_m - portable_log(x[i]) * metres;
}

/// The incidence angles of a batch.
GLIDAR_SIMD void find_angles(const Batch<double>& cosine, Batch<double>& angle_rad) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) angle_rad[i] = angle_of(cosine[i]);
}

/// The incidence angle is not used without a table of angles.
double drop_probability(const Dropout& step, double range_m, double incidence_rad) {
  double kept = 1.0 - step.probability;
  kept *= 1.0 - interpolate(step.by_range_m, range_m);
  if (!step.by_incidence_rad.empty()) {
    kept *= 1.0 - interpolate(step.by_incidence_rad, incidence_rad);
  }
  return 1.0 - kept;
}

}  // namespace

void apply(const Dropout& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> x;
  sample_shared_uniforms(batch.sampler.key, x);
  Batch<double> incidence_rad{};
  if (!step.by_incidence_rad.empty()) find_angles(batch.cosine, incidence_rad);
  const auto probability = [&](std::size_t i) {
    return drop_probability(step, batch.range_m[i], incidence_rad[i]);
  };
  record(batch.sampler, [&](std::size_t i) {
    return RandomSample{RandomSample::Distribution::uniform, x[i], "lost if below",
                        is_hit(batch, i) ? std::optional(probability(i)) : std::nullopt};
  });
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (is_hit(batch, i) && x[i] < probability(i)) invalidate_return(batch, i, Status::dropped);
  }
}

void prepare(const Crosstalk& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    view.workspace.before[batch.first + i] = batch.range_m[i];
  }
}

void apply(const Crosstalk& step, const NoiseView& view, NoiseBatch& batch) {
  const std::uint32_t rows = view.beams.rows / view.beams.returns;  // channels
  const std::uint32_t cols = view.beams.cols;
  if (rows < 2) return;
  WordBatch words;
  sample_words(batch.sampler,
               {{"crosstalk if below", step.probability},
                {"selects the other channel"},
                {"position between near and that channel's range"}},
               words);
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i) || uniform(words.word[0][i]) >= step.probability) continue;
    const std::size_t beam = batch.first + i;
    // One of the other rows; the bias of this selection is below rows / 2^32.
    const std::uint64_t pick = std::uint64_t{words.word[1][i]} * (rows - 1U) >> 32U;
    const std::size_t block = beam / (std::size_t{rows} * cols) * rows;  // of this return
    const std::size_t row = block + (beam / cols % rows + 1U + pick) % rows;
    const double other_m = view.workspace.before[row * cols + beam % cols];
    if (!(other_m > step.near_m)) continue;  // that channel has no echo
    set_return_source(view, batch, i, ReturnSource::crosstalk);
    batch.range_m[i] = step.near_m + (other_m - step.near_m) * uniform(words.word[2][i]);
  }
}

void apply(const FalseAlarms& step, const NoiseView& view, NoiseBatch& batch) {
  if (!(step.rate_hz > 0.0)) return;
  Batch<double> x;
  sample_shared_uniforms(batch.sampler, "arrival of the first false alarm", x);
  first_arrivals(step.near_m - view.beams.range_offset_m, kHalfLight_m_per_s / step.rate_hz, x);
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (batch.first + i >= view.beams.firings()) break;  // the first return only
    const Status status = batch.status[i];
    const bool listens = status != Status::invalid_pixel && status != Status::dropped;
    const double false_m = x[i];
    if (!listens || !(false_m < step.far_m) || !(false_m > 0.0)) continue;
    if (status == Status::hit && batch.range_m[i] <= false_m) continue;
    batch.range_m[i] = false_m;
    batch.intensity[i] = step.intensity;
    batch.status[i] = Status::hit;
    set_return_source(view, batch, i, ReturnSource::false_alarm);
  }
}

void describe(Dropout& step, FieldVisitor& visitor) {
  visitor.number({"probability", "p, for every return"}, kZeroToOne, step.probability);
  visitor.table({"by_range_m", "p(R): pairs [range, probability]", kUnitMetre}, kFromZero,
                kZeroToOne, step.by_range_m);
  visitor.table({"by_incidence_deg", "p(θ): pairs [incidence, probability]", kUnitDegree},
                kFromZero, kZeroToOne, step.by_incidence_rad);
}

void describe(Crosstalk& step, FieldVisitor& visitor) {
  visitor.number({"probability", "of a wrong range", kNoUnit, kRequired}, kZeroToOne,
                 step.probability);
  visitor.number({"near_m", "shortest wrong range", kUnitMetre}, kFromZero, step.near_m);
}

void describe(FalseAlarms& step, FieldVisitor& visitor) {
  visitor.number(
      {"rate_hz", "false alarms per second while the gate is open", kUnitHertz, kRequired},
      kFromZero, step.rate_hz);
  visitor.number({"near_m", "start of the gate", kUnitMetre}, kFromZero, step.near_m);
  visitor.number({"far_m", "end of the gate, beyond `near_m`", kUnitMetre, kRequired}, kAboveZero,
                 step.far_m);
  visitor.number({"intensity", "of a false alarm"}, kFromZero, step.intensity);
  if (visitor.is_reading() && step.far_m <= step.near_m) {
    visitor.reject("far_m", "{}, not beyond near_m", "a finite number above near_m");
  }
}

}  // namespace glidar
