// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/noise.hpp>

#include <glidar/core/dot_product.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kGrain = 8 * kSampleBatch;

template <class Step>
constexpr StepTraits traits_of() {
  if constexpr (requires { Step::kTraits; }) {
    return Step::kTraits;
  } else {
    return {};
  }
}

/// Steps with pointing noise: they change the beams before these are cast.
template <class Step>
constexpr bool kPerturbsBeams = requires(const Step& step, const Sampler& sampler, Beams& beams) {
  perturb(step, sampler, 0, 0, beams);
};

/// Steps that read other beams too: the whole frame is prepared before any of it changes.
template <class Step>
constexpr bool kReadsNeighbours = requires(const Step& step, const NoiseView& view,
                                           NoiseBatch& batch) {
  prepare(step, view, batch);
};

StepTraits traits(const NoiseStep& step) {
  return std::visit([](const auto& s) { return traits_of<std::decay_t<decltype(s)>>(); }, step);
}

bool perturbs_beams(const NoiseStep& step) {
  return std::visit([](const auto& s) { return kPerturbsBeams<std::decay_t<decltype(s)>>; }, step);
}

bool reads_depth(const NoiseStep& step) {
  return traits(step).reads_depth;
}

bool reads_incidence(const NoiseStep& step) {
  return traits(step).reads_incidence;
}

bool adds_returns(const NoiseStep& step) {
  return traits(step).adds_returns;
}

bool reads_neighbours(const NoiseStep& step) {
  if (const auto* waves = std::get_if<ContinuousWave>(&step)) return has_multipath(*waves);
  return std::visit([](const auto& s) { return kReadsNeighbours<std::decay_t<decltype(s)>>; },
                    step);
}

GLIDAR_SIMD void widen(const float* from, std::size_t count, double* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = double{from[i]};
}

GLIDAR_SIMD void square(Batch<double>& values) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) values[i] *= values[i];
}

void copy(const float* from, std::size_t count, double* to) {
  widen(from, count, to);
}
template <class T>
void copy(const T* from, std::size_t count, T* to) {
  std::copy_n(from, count, to);
}

/// Copies a part of a column to a batch and fills the remaining entries.
template <class From, class To>
void load_column(const std::vector<From>& column, const NoiseBatch& batch, To rest,
                 Batch<To>& out) {
  if (column.empty()) {
    out.fill(rest);
    return;
  }
  copy(column.data() + batch.first, batch.count, out.data());
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(batch.count), out.end(), rest);
}

GLIDAR_SIMD void project(const Eigen::Vector3d* vectors, const Eigen::Vector3d& axis,
                         std::size_t count, double* along_axis) {
  const Eigen::Vector3d unit(axis.x(), axis.y(), axis.z());  // a copy, so that the loop vectorises
  for (std::size_t i = 0; i < count; ++i) along_axis[i] = dot_product(vectors[i], unit);
}

void load_depth(const Beams& beams, NoiseBatch& batch) {
  project(beams.directions.data() + batch.first, beams.boresight, batch.count,
          batch.depth_per_m.data());
  if (beams.origins_m.empty()) return;
  project(beams.origins_m.data() + batch.first, beams.boresight, batch.count,
          batch.depth_at_zero.data());
}

void load(const NoisePlan& noise, const NoisePlan::Run& run, const NoiseView& view,
          NoiseBatch& batch) {
  const Frame& frame = view.frame;
  batch.frame_s = noise.frame_s;
  load_column(frame.range_m, batch, kNaN, batch.range_m);
  load_column(frame.sigma_m, batch, 0.0, batch.variance_m2);
  square(batch.variance_m2);
  load_column(frame.intensity, batch, 0.0, batch.intensity);
  load_column(frame.ground_truth.noise_scale, batch, 1.0, batch.scale);
  load_column(frame.ground_truth.cos_incidence, batch, 1.0, batch.cosine);
  load_column(frame.status, batch, Status::invalid_pixel, batch.status);
  batch.depth_per_m.fill(1.0);
  batch.depth_at_zero.fill(0.0);
  if (run.reads_depth) load_depth(view.beams, batch);
}

/// Columns of a frame from the first beam of a batch.
struct Columns {
  double* range_m;
  float* intensity;
  float* sigma_m;
};

GLIDAR_SIMD void write(const NoiseBatch& batch, const Columns& to) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    const double range_m = batch.range_m[i];
    const double sigma_m = std::sqrt(batch.variance_m2[i]);
    to.range_m[i] = range_m;
    to.intensity[i] = static_cast<float>(batch.intensity[i]);
    to.sigma_m[i] = static_cast<float>(range_m == range_m ? sigma_m : 0.0);
  }
}

/// Removes returns with a final range <= 0.
void invalidate_nonpositive_ranges(NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (is_hit(batch, i) && !(batch.range_m[i] > 0.0))
      invalidate_return(batch, i, Status::too_near);
  }
}

void store(const NoiseView& view, NoiseBatch& batch) {
  Frame& frame = view.frame;
  const std::size_t at = batch.first;
  write(batch, {frame.range_m.data() + at, frame.intensity.data() + at, frame.sigma_m.data() + at});
  std::copy_n(batch.status.begin(), batch.count, frame.status.data() + at);
  if (frame.return_source.empty()) return;
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (!is_hit(batch, i)) frame.return_source[at + i] = ReturnSource::none;
  }
}

/// Calls body(batch) for all batches of a frame, loaded.
template <class Load, class Body>
void for_batches(const Load& load_batch, const NoiseView& view, ThreadPool& thread_pool,
                 const Body& body) {
  const std::size_t size = view.frame.range_m.size();
  const std::size_t batches = (size + kSampleBatch - 1) / kSampleBatch;
  thread_pool.parallel_for(batches, kGrain / kSampleBatch, [&](std::size_t begin, std::size_t end) {
    NoiseBatch batch;
    for (std::size_t number = begin; number < end; ++number) {
      batch.first = number * kSampleBatch;
      batch.count = std::min(kSampleBatch, size - batch.first);
      load_batch(batch);
      body(batch);
    }
  });
}

/// The random numbers of step k, from a beam.
Sampler sampler_of(const NoisePlan& noise, const Frame& frame, std::size_t k, std::size_t first) {
  Sampler sampler{.key = rng_key(frame, rng_purpose(k), 0)};
  if (noise.recorder != nullptr) {
    sampler.recorded = &noise.recorder->steps[k];
    sampler.traced = noise.recorder->entry;
  }
  return later_batch(sampler, first);
}

void prepare_step(const NoisePlan& noise, std::size_t k, const NoiseView& view, NoiseBatch& batch) {
  batch.sampler = sampler_of(noise, view.frame, k, batch.first);
  std::visit(
      [&](const auto& step) {
        if constexpr (kReadsNeighbours<std::decay_t<decltype(step)>>) prepare(step, view, batch);
      },
      noise.steps[k]);
}

void apply_steps(const NoisePlan& noise, const NoisePlan::Run& run, const NoiseView& view,
                 NoiseBatch& batch) {
  for (std::size_t k = run.begin; k < run.end; ++k) {
    batch.sampler = sampler_of(noise, view.frame, k, batch.first);
    std::visit(
        [&](const auto& step) {
          if constexpr (!kPerturbsBeams<std::decay_t<decltype(step)>>) apply(step, view, batch);
        },
        noise.steps[k]);
  }
}

template <class Step>
void perturb_if_pointing(const Step& step, const Sampler& sampler, BeamRange range, Beams& beams) {
  if constexpr (kPerturbsBeams<Step>)
    perturb(step, sampler, range.begin, range.end - range.begin, beams);
}

void perturb_beams(const NoisePlan& noise, const Frame& frame, BeamRange range, Beams& beams) {
  for (std::size_t k = 0; k < noise.steps.size(); ++k) {
    Sampler sampler = sampler_of(noise, frame, k, 0);
    sampler.traced %= beams.firings();  // all returns of a pulse have its direction
    std::visit([&](const auto& step) { perturb_if_pointing(step, sampler, range, beams); },
               noise.steps[k]);
  }
}

void apply_run(const NoisePlan& noise, const NoisePlan::Run& run, const NoiseView& view,
               ThreadPool& thread_pool) {
  const auto load_batch = [&](NoiseBatch& batch) { load(noise, run, view, batch); };
  if (run.reads_neighbours) {
    const bool needs_columns = !traits(noise.steps[run.begin]).prepares_without_columns;
    const auto load_columns = [&](NoiseBatch& batch) {
      if (needs_columns) load_batch(batch);
    };
    for_batches(load_columns, view, thread_pool,
                [&](NoiseBatch& batch) { prepare_step(noise, run.begin, view, batch); });
  }
  const bool is_last = run.end == noise.steps.size();
  for_batches(load_batch, view, thread_pool, [&](NoiseBatch& batch) {
    apply_steps(noise, run, view, batch);
    if (is_last) invalidate_nonpositive_ranges(batch);
    store(view, batch);
  });
}

/// Splits the steps before those that read neighbours.
std::vector<NoisePlan::Run> runs_of(const std::vector<NoiseStep>& steps) {
  std::vector<NoisePlan::Run> runs;
  for (std::size_t begin = 0, end = 0; begin < steps.size(); begin = end) {
    const auto first = steps.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = std::find_if(first + 1, steps.end(), reads_neighbours);
    end = static_cast<std::size_t>(last - steps.begin());
    runs.push_back({.begin = begin,
                    .end = end,
                    .reads_neighbours = reads_neighbours(*first),
                    .reads_depth = std::any_of(first, last, reads_depth)});
  }
  return runs;
}

}  // namespace

void describe(NoiseStep& step, FieldVisitor& visitor) {
  visit_variant(visitor, {"type", "the noise model", kNoUnit, kRequired}, step);
}

Purpose rng_purpose(std::size_t step) {
  return static_cast<Purpose>(static_cast<std::size_t>(Purpose::first_noise_step) + step);
}

void add_required_hit_columns(const std::vector<NoiseStep>& noise, HitColumnMask& hit_columns) {
  hit_columns.noise_scale = hit_columns.noise_scale || !noise.empty();
  hit_columns.incidence =
      hit_columns.incidence || std::any_of(noise.begin(), noise.end(), reads_incidence);
}

NoisePlan plan_noise(std::vector<NoiseStep> steps, double frame_s) {
  NoisePlan plan{.steps = std::move(steps), .frame_s = frame_s};
  const auto any = [&](const auto& holds) {
    return std::any_of(plan.steps.begin(), plan.steps.end(), holds);
  };
  plan.runs = runs_of(plan.steps);
  plan.perturbs_directions = any(perturbs_beams);
  plan.changes_returns = any([](const NoiseStep& step) { return !perturbs_beams(step); });
  plan.reads_neighbours = any(reads_neighbours);
  plan.adds_returns = any(adds_returns);
  return plan;
}

const Beams& perturb_directions(const NoisePlan& noise, const Beams& beams, const Frame& frame,
                                ThreadPool& thread_pool, Beams& perturbed) {
  if (!noise.perturbs_directions) return beams;
  perturbed = beams;
  perturbed.pinhole.reset();  // no longer a regular grid
  const std::size_t firings = beams.firings();
  const std::size_t batches = (firings + kSampleBatch - 1) / kSampleBatch;
  thread_pool.parallel_for(batches, kGrain / kSampleBatch, [&](std::size_t begin, std::size_t end) {
    perturb_beams(noise, frame, {begin * kSampleBatch, std::min(end * kSampleBatch, firings)},
                  perturbed);
  });
  for (std::size_t i = firings; i < perturbed.size(); ++i) {
    // all returns of a pulse have its direction
    perturbed.directions[i] = perturbed.directions[i - firings];
  }
  return perturbed;
}

void apply_noise(const NoisePlan& noise, const Beams& beams, ThreadPool& thread_pool,
                 NoiseWorkspace& workspace, Frame& frame, std::size_t count) {
  if (!noise.changes_returns) {
    frame.sigma_m.clear();
    return;
  }
  frame.sigma_m.assign(frame.range_m.size(), 0.0F);
  if (noise.reads_neighbours) {
    workspace.before.resize(frame.range_m.size());
    workspace.amplitude.resize(frame.range_m.size());
  }
  if (frame.return_source.empty() && noise.adds_returns) {
    frame.return_source.assign(frame.range_m.size(), ReturnSource::surface);
  }
  const NoiseView view{beams, frame, workspace};
  for (NoisePlan::Run run : noise.runs) {
    if (run.begin >= count) break;
    run.end = std::min(run.end, count);
    apply_run(noise, run, view, thread_pool);
  }
}

}  // namespace glidar
