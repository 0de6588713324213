// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/limits.hpp>

#include <glidar/core/dot_product.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/math/thread_pool.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

bool is_unlimited(const Limits& limits) {
  return limits.near_m <= 0.0 && std::isinf(limits.far_m);
}

Status status_at(const Limits& limits, double distance_m) {
  if (limits.near_m > 0.0 && distance_m < limits.near_m) return Status::too_near;
  if (distance_m > limits.far_m) return Status::too_far;
  return Status::hit;
}

/// What the limits apply to: depths, or ranges as reported.
GLIDAR_SIMD void find_distances(const Limits& limits, const Beams& beams, BeamRange range,
                                const std::vector<double>& ranges_m, Batch<double>& distance_m) {
  const std::size_t count = range.end - range.begin;
  const double* const range_m = ranges_m.data() + range.begin;
  if (limits.along == Limits::Along::range) {
    const double offset_m = beams.range_offset_m;
    for (std::size_t k = 0; k < count; ++k) distance_m[k] = range_m[k] + offset_m;
    return;
  }
  const Eigen::Vector3d boresight = beams.boresight;
  const Eigen::Vector3d* const directions = beams.directions.data() + range.begin;
  for (std::size_t k = 0; k < count; ++k) {
    distance_m[k] = range_m[k] * dot_product(directions[k], boresight);  // as depth_m()
  }
  if (beams.origins_m.empty()) return;
  const Eigen::Vector3d* const origins_m = beams.origins_m.data() + range.begin;
  for (std::size_t k = 0; k < count; ++k) {
    distance_m[k] += dot_product(origins_m[k], boresight);
  }
}

/// Ranges and statuses, as check_limits() of each hit.
GLIDAR_SIMD void classify_batch(const Limits& limits, const Batch<double>& distance_m,
                                BeamRange range, Frame& frame) {
  static_assert(static_cast<unsigned>(Status::hit) == 0);
  constexpr auto kMiss = static_cast<unsigned>(Status::miss);
  constexpr auto kTooNear = static_cast<unsigned>(Status::too_near);
  constexpr auto kTooFar = static_cast<unsigned>(Status::too_far);
  const double near_m = limits.near_m > 0.0 ? limits.near_m : -kInfinity;
  const double far_m = limits.far_m;
  const double* const true_range_m = frame.ground_truth.range_m.data() + range.begin;
  double* const range_m = frame.range_m.data() + range.begin;
  Status* const status = frame.status.data() + range.begin;
  for (std::size_t k = 0; k < range.end - range.begin; ++k) {
    // Integers, of which at most one is 1, so that the loop vectorises.
    const auto is_miss = static_cast<unsigned>(true_range_m[k] != true_range_m[k]);
    const auto is_near = static_cast<unsigned>(distance_m[k] < near_m);
    const auto is_far = static_cast<unsigned>(distance_m[k] > far_m) & (is_near ^ 1U);
    status[k] = static_cast<Status>(is_miss * kMiss + is_near * kTooNear + is_far * kTooFar);
    range_m[k] = (is_near | is_far) != 0 ? kNaN : true_range_m[k];
  }
}

/// Calls body(batch) for the batches of a run of beams.
template <class Body>
void for_sample_batches(BeamRange beams, const Body& body) {
  for (std::size_t begin = beams.begin; begin < beams.end; begin += kSampleBatch)
    body(BeamRange{begin, std::min(begin + kSampleBatch, beams.end)});
}

void remove_batch(const Limits& limits, const Beams& beams, BeamRange run, Frame& frame) {
  Batch<double> distance_m{};
  find_distances(limits, beams, run, frame.range_m, distance_m);
  for (std::size_t i = run.begin; i < run.end; ++i) {
    if (frame.status[i] != Status::hit) continue;
    const Status status = status_at(limits, distance_m[i - run.begin]);
    if (status != Status::hit) invalidate_return(frame, i, status);
  }
}

}  // namespace

Status check_limits(const Limits& limits, const Beams& beams, std::size_t beam, double range_m) {
  const double distance = limits.along == Limits::Along::depth ? depth_m(beams, beam, range_m)
                                                               : range_m + beams.range_offset_m;
  return status_at(limits, distance);
}

void classify_surfaces(const Limits& limits, const Beams& beams, BeamRange tile, Frame& frame) {
  Batch<double> distance_m{};
  for_sample_batches(tile, [&](BeamRange run) {
    if (!is_unlimited(limits))
      find_distances(limits, beams, run, frame.ground_truth.range_m, distance_m);
    classify_batch(limits, distance_m, run, frame);
  });
  if (beams.pinhole) return;
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    if (frame.status[i] != Status::miss) continue;
    if (std::isnan(beams.directions[i].x())) frame.status[i] = Status::invalid_pixel;
  }
}

void remove_returns_outside(const Limits& limits, const Beams& beams, ThreadPool& thread_pool,
                            Frame& frame) {
  if (is_unlimited(limits)) return;
  thread_pool.parallel_for(beams.size(), 8 * kSampleBatch, [&](std::size_t begin, std::size_t end) {
    for_sample_batches({begin, end},
                       [&](BeamRange run) { remove_batch(limits, beams, run, frame); });
  });
}

double to_whole_units(const Limits& limits, Limits::Along along, double distance_m, double unit_m) {
  constexpr double kRounding = 1e-6;  // of the quotients, in units
  const double nearest = std::floor(distance_m / unit_m + 0.5);
  if (limits.along != along) return nearest;
  const double min =
      limits.near_m > 0.0 ? std::ceil(limits.near_m / unit_m - kRounding) : -kInfinity;
  const double max = std::floor(limits.far_m / unit_m + kRounding);
  const double within = std::min(std::max(nearest, min), max);
  return std::abs(within - nearest) <= 1.0 ? within : nearest;
}

void describe(Limits& limits, FieldVisitor& visitor) {
  using Along = Limits::Along;
  constexpr std::array<Named<Along>, 2> kNames = {
      {{"depth", Along::depth}, {"range", Along::range}}};
  visitor.number({"near_m", "shortest reported distance", kUnitMetre}, kFromZero, limits.near_m);
  visitor.number(
      {"far_m", "longest reported distance, beyond `near_m`", kUnitMetre, false, "no limit"},
      kAboveZero, limits.far_m);
  visit_choice(visitor,
               {"along", "whether limits apply along the boresight or along the beam", kNoUnit,
                false, "`depth` for cameras, else `range`"},
               kNames, limits.along);
  if (visitor.is_reading() && limits.far_m <= limits.near_m) {
    visitor.reject("far_m", "{}, not beyond near_m", "a finite number above near_m");
  }
}

}  // namespace glidar
