// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/noise/pointing_noise.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/noise/noise_batch.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kTurns_per_rad = 0.5 * std::numbers::inv_pi;

/// Tilts beams by small angles (angle = tangent): sideways along the horizontal unit vector
/// perpendicular to the beam (any for a vertical beam), upwards perpendicular to both. xyz: beam
/// after beam.
GLIDAR_SIMD void jitter(const Eigen::Vector3d& up, const PointingJitter& step,
                        const PairBatch& normal, std::size_t count, double* xyz) {
  constexpr double kShortest = 1e-9;
  const double ux = up.x();
  const double uy = up.y();
  const double uz = up.z();
  for (std::size_t i = 0; i < count; ++i) {
    const double x = xyz[3 * i];
    const double y = xyz[3 * i + 1];
    const double z = xyz[3 * i + 2];
    const double cx = uy * z - uz * y;
    const double cy = uz * x - ux * z;
    const double cz = ux * y - uy * x;
    const double length = std::sqrt(cx * cx + cy * cy + cz * cz);
    const bool is_level = length > kShortest;
    const double inverse = 1.0 / (is_level ? length : 1.0);
    const double ax = is_level ? cx * inverse : 1.0;
    const double ay = is_level ? cy * inverse : 0.0;
    const double az = is_level ? cz * inverse : 0.0;
    const double sideways = step.sigma_azimuth_rad * normal.first[i];
    const double upwards = step.sigma_elevation_rad * normal.second[i];
    const double vx = x + sideways * ax + upwards * (y * az - z * ay);
    const double vy = y + sideways * ay + upwards * (z * ax - x * az);
    const double vz = z + sideways * az + upwards * (x * ay - y * ax);
    const double unit = 1.0 / std::sqrt(vx * vx + vy * vy + vz * vz);
    xyz[3 * i] = vx * unit;
    xyz[3 * i + 1] = vy * unit;
    xyz[3 * i + 2] = vz * unit;
  }
}

inline double rounding_error(double step_rad, double steps_per_rad, double azimuth_rad) {
  return std::floor(azimuth_rad * steps_per_rad + 0.5) * step_rad - azimuth_rad;
}

inline double eccentricity_error(const EncoderError& model, double azimuth_rad) {
  return model.eccentricity_rad *
         sincos_turns((azimuth_rad + model.phase_rad) * kTurns_per_rad).sine;
}

GLIDAR_SIMD void find_azimuths(std::size_t count, const double* xyz, Batch<double>& azimuth_rad) {
  for (std::size_t i = 0; i < count; ++i) {
    azimuth_rad[i] = kTurn_rad * atan2_turns(xyz[3 * i + 1], xyz[3 * i]);
  }
}

GLIDAR_SIMD void add_encoder_rounding(double step_rad, const Batch<double>& azimuth_rad,
                                      Batch<double>& error_rad) {
  const double steps_per_rad = 1.0 / step_rad;
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    error_rad[i] += rounding_error(step_rad, steps_per_rad, azimuth_rad[i]);
  }
}

GLIDAR_SIMD void add_eccentricity(const EncoderError& model, const Batch<double>& azimuth_rad,
                                  Batch<double>& error_rad) {
  for (std::size_t i = 0; i < kSampleBatch; ++i)
    error_rad[i] += eccentricity_error(model, azimuth_rad[i]);
}

/// Cosines and sines of the rotation from the reported to the true azimuth.
GLIDAR_SIMD void find_inverse_rotation(const Batch<double>& error_rad, PairBatch& back) {
  for (std::size_t i = 0; i < kSampleBatch; ++i) {
    const SineCosine turn = sincos_turns(-error_rad[i] * kTurns_per_rad);
    back.first[i] = turn.cosine;
    back.second[i] = turn.sine;
  }
}

GLIDAR_SIMD void rotate_about_z(const PairBatch& angle, std::size_t count, double* xyz) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = xyz[3 * i];
    const double y = xyz[3 * i + 1];
    const double z = xyz[3 * i + 2];
    xyz[3 * i] = angle.first[i] * x - angle.second[i] * y;
    xyz[3 * i + 1] = angle.second[i] * x + angle.first[i] * y;
    xyz[3 * i + 2] = z;
  }
}

void record_turn_error(double normal, const Sampler& sampler) {
  record(sampler, [&](std::size_t /*i*/) {
    return RandomSample{.value = normal, .use = "error of the whole frame"};
  });
}

constexpr NumberRule kSmallAngle = {0.0, 5.0, false, "degrees from 0 to 5"};

}  // namespace

void perturb(const PointingJitter& step, const Sampler& sampler, std::size_t first,
             std::size_t count, Beams& beams) {
  const Eigen::Vector3d up = axes_of(beams).up;
  PairBatch normal;
  for (std::size_t begin = first; begin < first + count; begin += kSampleBatch) {
    sample_normals(later_batch(sampler, begin), "horizontal pointing error",
                   "vertical pointing error", normal);
    jitter(up, step, normal, std::min(kSampleBatch, first + count - begin),
           beams.directions[begin].data());
  }
}

void perturb(const EncoderError& step, const Sampler& sampler, std::size_t first, std::size_t count,
             Beams& beams) {
  const double normal = normals(random_words(sampler.key))[0];
  const double of_turn = step.turn_sigma_rad * normal;
  Batch<double> azimuth_rad{};
  Batch<double> error_rad;
  PairBatch back;
  for (std::size_t begin = first; begin < first + count; begin += kSampleBatch) {
    const std::size_t size = std::min(kSampleBatch, first + count - begin);
    if (step.turn_sigma_rad > 0.0) record_turn_error(normal, later_batch(sampler, begin));
    find_azimuths(size, beams.directions[begin].data(), azimuth_rad);
    error_rad.fill(of_turn);
    if (step.step_rad > 0.0) add_encoder_rounding(step.step_rad, azimuth_rad, error_rad);
    if (step.eccentricity_rad != 0.0) add_eccentricity(step, azimuth_rad, error_rad);
    find_inverse_rotation(error_rad, back);
    rotate_about_z(back, size, beams.directions[begin].data());
    if (!beams.origins_m.empty()) rotate_about_z(back, size, beams.origins_m[begin].data());
  }
}

void describe(PointingJitter& step, FieldVisitor& visitor) {
  visitor.number({"sigma_azimuth_deg", "standard deviation sideways", kUnitDegree}, kSmallAngle,
                 step.sigma_azimuth_rad);
  visitor.number({"sigma_elevation_deg", "standard deviation upwards", kUnitDegree}, kSmallAngle,
                 step.sigma_elevation_rad);
}

void describe(EncoderError& step, FieldVisitor& visitor) {
  visitor.number({"step_deg", "step of the encoder; 0: not rounded", kUnitDegree}, kSmallAngle,
                 step.step_rad);
  visitor.number({"eccentricity_deg", "e", kUnitDegree}, kSmallAngle, step.eccentricity_rad);
  visitor.number({"phase_deg", "phase of the eccentricity", kUnitDegree}, kFinite, step.phase_rad);
  visitor.number(
      {"turn_sigma_deg", "standard deviation of the error of a whole frame", kUnitDegree},
      kSmallAngle, step.turn_sigma_rad);
}

}  // namespace glidar
