// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>

#include <cstddef>
#include <limits>

namespace glidar {

class FieldVisitor;

/// How a sensor measures the radial velocity of every return by the Doppler shift of coherent light
/// (FMCW). Positive: the range grows.
struct Doppler {
  /// Standard deviation of strong returns.
  double sigma_m_s = 0.0;
  /// Part of the standard deviation that falls with the square root of the signal I:
  /// sigma^2 = sigma_m_s^2 + signal_sigma_m_s^2 / I. The variance of an estimated frequency is
  /// inversely proportional to the signal-to-noise ratio (Rife and Boorstyn, "Single-tone parameter
  /// estimation from discrete-time observations", IEEE Trans. Inf. Theory 20 (1974) 591, equation
  /// 24), and that of coherent detection is proportional to the received power.
  double signal_sigma_m_s = 0.0;
  double step_m_s = 0.0;  ///< reported velocities are multiples of it; 0: not rounded
  /// Velocities are folded into [-max_m_s, max_m_s): a sampled signal does not distinguish
  /// frequencies that differ by the sampling rate (AMS Glossary of Meteorology, "Maximum
  /// unambiguous velocity": wavelength / 4 T for a lidar with the sampling interval T).
  double max_m_s = std::numeric_limits<double>::infinity();
};

/// Keys of `doppler` in sensor files.
void describe(Doppler& doppler, FieldVisitor& visitor);

/// The standard deviation at a signal, on a surface that scales random errors by `scale`
/// (Hits::noise_scale).
double radial_velocity_sigma_m_s(const Doppler& doppler, double signal, double scale);

/// A velocity as reported: rounded to whole steps, then folded into the unambiguous interval.
double reported_radial_velocity_m_s(const Doppler& doppler, double velocity_m_s);

/// The standard normal number of the error of an entry.
double radial_velocity_normal(const Frame& frame, std::size_t entry);

/// Applies errors, rounding and folding to frame.radial_velocity_m_s, which has the velocities as
/// received. Reads intensities before any noise step changes them.
void measure_radial_velocities(const Doppler& doppler, ThreadPool& thread_pool, Frame& frame);

/// After the noise steps: removes the velocities of returns that these removed. False alarms, which
/// are peaks of noise, get one that is uniform in the unambiguous interval.
void complete_radial_velocities(const Doppler& doppler, Frame& frame);

}  // namespace glidar
