// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/depth_noise.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/lateral_noise.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// Disparity in steps: K / z with a normal error, rounded to whole steps plus an offset.
struct Disparity {
  double k_m = 0.0;
  double sigma_steps = 0.0;
  double offset_steps = 0.0;
  bool rounds = true;
};

/// Beams with a disparity <= 0 get an infinite range.
GLIDAR_SIMD void measure(const Disparity& model, const Batch<double>& normal, NoiseBatch& b) {
  const double rounding = model.rounds ? 1.0 / 12.0 : 0.0;
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double z = b.depth_at_zero[i] + b.depth_per_m[i] * b.range_m[i];
    const double sigma = model.sigma_steps * b.scale[i];
    const double steps = model.k_m / z + sigma * normal[i];
    const double whole = std::floor(steps - model.offset_steps + 0.5) + model.offset_steps;
    const double reported = model.rounds ? whole : steps;
    const double reported_z =
        reported > 0.0 ? model.k_m / reported : std::numeric_limits<double>::infinity();
    const double per_step = z * z / model.k_m / b.depth_per_m[i];
    b.range_m[i] = z == z ? (reported_z - b.depth_at_zero[i]) / b.depth_per_m[i] : z;
    b.variance_m2[i] += (sigma * sigma + rounding) * per_step * per_step;
  }
}

void invalidate_infinite_ranges(NoiseBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (is_hit(batch, i) && std::isinf(batch.range_m[i]))
      invalidate_return(batch, i, Status::too_far);
  }
}

inline double complement_rad(double incidence_rad) {
  const double left = 0.5 * std::numbers::pi - incidence_rad;
  return left > kMinGrazing_rad ? left : kMinGrazing_rad;
}

inline double axial_sigma_m(const NguyenAxial& model, double z_m, double incidence_rad) {
  const double beyond = z_m - model.c_m;
  const double sigma = model.a_m + model.b_per_m * beyond * beyond;
  const double share = incidence_rad / complement_rad(incidence_rad);
  const double grazing_coefficient = model.grazing_coefficient / std::sqrt(z_m) * share * share;
  return incidence_rad <= std::numbers::pi / 3.0 ? sigma : sigma + grazing_coefficient;
}

inline double lateral_sigma_px(const NguyenLateral& model, double incidence_rad) {
  return model.a_px + model.b_px * incidence_rad / complement_rad(incidence_rad);
}

GLIDAR_SIMD void add_axial(const NguyenAxial& model, const Batch<double>& normal, NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double z = b.depth_at_zero[i] + b.depth_per_m[i] * b.range_m[i];
    const double sigma =
        axial_sigma_m(model, z, angle_of(b.cosine[i])) * b.scale[i] / b.depth_per_m[i];
    b.range_m[i] += sigma * normal[i];
    b.variance_m2[i] += sigma * sigma;
  }
}

GLIDAR_SIMD void scale_lateral(const NguyenLateral& model, const NoiseBatch& b, PairBatch& shift) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double sigma = lateral_sigma_px(model, angle_of(b.cosine[i])) * b.scale[i];
    shift.first[i] *= sigma;
    shift.second[i] *= sigma;
  }
}

void sample_lateral_normals(const Sampler& sampler, PairBatch& normals) {
  sample_normals(sampler, "offset to the right in the image", "offset downwards in the image",
                 normals);
}

/// A normal error of depth: sigma = a + b (z - c)^2.
GLIDAR_SIMD void add_parabola(const NguyenAxial& model, const Batch<double>& normal,
                              NoiseBatch& b) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const double beyond = b.depth_at_zero[i] + b.depth_per_m[i] * b.range_m[i] - model.c_m;
    const double sigma =
        (model.a_m + model.b_per_m * beyond * beyond) * b.scale[i] / b.depth_per_m[i];
    b.range_m[i] += sigma * normal[i];
    b.variance_m2[i] += sigma * sigma;
  }
}

}  // namespace

double nguyen_axial_sigma_m(const NguyenAxial& model, double z_m, double incidence_rad) {
  return axial_sigma_m(model, z_m, incidence_rad);
}

double nguyen_lateral_sigma_px(const NguyenLateral& model, double incidence_rad) {
  return lateral_sigma_px(model, incidence_rad);
}

void apply(const DisparityQuantization& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  const Batch<double> none{};
  measure({.k_m = step.k_m, .offset_steps = step.offset_steps}, none, batch);
  invalidate_infinite_ranges(batch);
}

void apply(const Khoshelham& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the depth", normal);
  add_parabola({.a_m = 0.0, .b_per_m = step.sigma_per_m, .c_m = 0.0, .grazing_coefficient = 0.0},
               normal, batch);
}

void apply(const NguyenAxial& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the depth", normal);
  add_axial(step, normal, batch);
}

void prepare(const NguyenLateral& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  store_depth(view, batch);
}

void apply(const NguyenLateral& step, const NoiseView& view, NoiseBatch& batch) {
  PairBatch shift;
  sample_lateral_normals(batch.sampler, shift);
  scale_lateral(step, batch, shift);
  shift_laterally(shift, view, batch);
}

void prepare(const IclKinect& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  store_depth(view, batch);
}

void apply(const IclKinect& step, const NoiseView& view, NoiseBatch& batch) {
  PairBatch shift;
  sample_lateral_normals(batch.sampler, shift);
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    shift.first[i] *= step.lateral_px * batch.scale[i];
    shift.second[i] *= step.lateral_px * batch.scale[i];
  }
  shift_laterally(shift, view, batch);
  Batch<double> normal;
  sample_shared_normals(block(batch.sampler, 1), "error of the disparity", normal);
  measure({.k_m = step.k_m, .sigma_steps = step.sigma_steps}, normal, batch);
  invalidate_infinite_ranges(batch);
}

void prepare(const KinectV1& /*step*/, const NoiseView& view, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "of this pixel", normal);
  std::copy_n(normal.begin(), batch.count,
              view.workspace.before.begin() + static_cast<std::ptrdiff_t>(batch.first));
}

void apply(const KinectV1& step, const NoiseView& view, NoiseBatch& batch) {
  Batch<double> normal{};
  mean_over_window(step.window, view, batch, normal);
  record(batch.sampler, [&](std::size_t i) {
    const std::string side = std::to_string(step.window);
    return RandomSample{.value = normal[i],
                        .use = "error of the disparity: the mean of " + side + " x " + side +
                               " pixels' numbers, scaled to standard deviation 1"};
  });
  measure({.k_m = step.k_m, .sigma_steps = step.sigma_steps, .offset_steps = step.offset_steps},
          normal, batch);
  invalidate_infinite_ranges(batch);
}

void apply(const Stereo& step, const NoiseView& /*view*/, NoiseBatch& batch) {
  Batch<double> normal;
  sample_shared_normals(batch.sampler, "error of the disparity", normal);
  const double unit_px = step.step_px > 0.0 ? step.step_px : 1.0;
  measure({.k_m = step.focal_px * step.baseline_m / unit_px,
           .sigma_steps = step.sigma_px / unit_px,
           .rounds = step.step_px > 0.0},
          normal, batch);
  invalidate_infinite_ranges(batch);
}

void describe(DisparityQuantization& step, FieldVisitor& visitor) {
  visitor.number({"k_m", "K", kUnitMetre, kRequired}, kAboveZero, step.k_m);
  visitor.number({"offset_steps", "disparity of step 0, in steps"}, kFinite, step.offset_steps);
}

void describe(KinectV1& step, FieldVisitor& visitor) {
  constexpr WholeRule kWindow = {1, 2 * kMaxWindowReach + 1};
  visitor.number({"k_m", "K", kUnitMetre}, kAboveZero, step.k_m);
  visitor.number({"offset_steps", "disparity of step 0, in steps"}, kFinite, step.offset_steps);
  visitor.number({"sigma_steps", "standard deviation of the disparity, in steps"}, kFromZero,
                 step.sigma_steps);
  visitor.whole_number({"window", "side of the square whose pixels share errors; odd", kUnitPixel},
                       kWindow, step.window);
  if (visitor.is_reading() && step.window % 2 == 0) {
    visitor.reject("window", "{}", "an odd number from 1 to 33");
  }
}

void describe(Khoshelham& step, FieldVisitor& visitor) {
  visitor.number({"sigma_per_m", "standard deviation at a depth of 1 m"}, kFromZero,
                 step.sigma_per_m);
}

void describe(NguyenAxial& step, FieldVisitor& visitor) {
  visitor.number({"a_m", "a", kUnitMetre}, kFromZero, step.a_m);
  visitor.number({"b_per_m", "b"}, kFromZero, step.b_per_m);
  visitor.number({"c_m", "c", kUnitMetre}, kFinite, step.c_m);
  visitor.number({"grazing_coefficient", "factor of the error at grazing incidence"}, kFromZero,
                 step.grazing_coefficient);
}

void describe(NguyenLateral& step, FieldVisitor& visitor) {
  visitor.number({"a_px", "a", kUnitPixel}, kFromZero, step.a_px);
  visitor.number({"b_px", "b", kUnitPixel}, kFromZero, step.b_px);
}

void describe(IclKinect& step, FieldVisitor& visitor) {
  visitor.number({"k_m", "K", kUnitMetre}, kAboveZero, step.k_m);
  visitor.number({"lateral_px", "standard deviation of the lateral shift", kUnitPixel}, kFromZero,
                 step.lateral_px);
  visitor.number({"sigma_steps", "standard deviation of the disparity, in steps"}, kFromZero,
                 step.sigma_steps);
}

void describe(Stereo& step, FieldVisitor& visitor) {
  visitor.number({"focal_px", "focal length f", kUnitPixel, kRequired}, kAboveZero, step.focal_px);
  visitor.number({"baseline_m", "baseline b", kUnitMetre, kRequired}, kAboveZero, step.baseline_m);
  visitor.number({"sigma_px", "standard deviation of the disparity", kUnitPixel, kRequired},
                 kFromZero, step.sigma_px);
  visitor.number({"step_px", "step of the disparity; 0: not rounded", kUnitPixel}, kFromZero,
                 step.step_px);
}

}  // namespace glidar
