// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/pointing_noise.hpp>

#include <glidar/core/elementary.hpp>
#include <glidar/core/gaussian.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// The sensor's vertical: z, or for a camera, which looks along z, -y.
Eigen::Vector3d vertical(const Beams& beams) {
  constexpr double kAlong = 0.9;
  return std::abs(beams.boresight.z()) > kAlong ? Eigen::Vector3d(-Eigen::Vector3d::UnitY())
                                                : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
}

/// Unit vector across a beam, level; for a vertical beam any.
Eigen::Vector3d sideways(const Eigen::Vector3d& up, const Eigen::Vector3d& beam) {
  constexpr double kShortest = 1e-9;
  const Eigen::Vector3d across = up.cross(beam);
  const double length = across.norm();
  return length > kShortest ? Eigen::Vector3d(across / length) : Eigen::Vector3d::UnitX();
}

}  // namespace

double encoder_error_rad(const EncoderError& law, double azimuth_rad) {
  double error = law.eccentricity_rad * of_turns((azimuth_rad + law.phase_rad) / kTurn_rad).sine;
  if (law.step_rad > 0.0) {
    error += std::floor(azimuth_rad / law.step_rad + 0.5) * law.step_rad - azimuth_rad;
  }
  return error;
}

void turn(const PointingJitter& step, const Draw& draw, std::size_t first, std::size_t count,
          Beams& beams) {
  const Eigen::Vector3d up = vertical(beams);
  PairBatch normal;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kDrawBatch == 0) {
      Draw run = draw;
      run.beam = static_cast<std::uint32_t>(first + i);
      draw_normals(run, normal);
    }
    Eigen::Vector3d& beam = beams.directions[first + i];
    const Eigen::Vector3d across = sideways(up, beam);
    const double aside = step.sigma_azimuth_rad * normal.first[i % kDrawBatch];
    const double upwards = step.sigma_elevation_rad * normal.second[i % kDrawBatch];
    // the angles are so small that they are their own tangents
    beam = (beam + aside * across + upwards * beam.cross(across)).normalized();
  }
}

void turn(const EncoderError& step, const Draw& draw, std::size_t first, std::size_t count,
          Beams& beams) {
  Draw whole = draw;
  whole.beam = 0;
  const double of_turn = step.turn_sigma_rad * normals(random_words(whole))[0];
  for (std::size_t i = first; i < first + count; ++i) {
    Eigen::Vector3d& beam = beams.directions[i];
    const double azimuth = kTurn_rad * turns_of(beam.y(), beam.x());
    const double error = encoder_error_rad(step, azimuth) + of_turn;
    const SineCosine back = of_turns(-error / kTurn_rad);  // where it is when it reports this
    const auto rotate = [&](Eigen::Vector3d& v) {
      v = {back.cosine * v.x() - back.sine * v.y(), back.sine * v.x() + back.cosine * v.y(), v.z()};
    };
    rotate(beam);
    beam.normalize();
    if (!beams.origins_m.empty()) rotate(beams.origins_m[i]);
  }
}

}  // namespace glidar
