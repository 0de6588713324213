// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/lookup_table.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

class FieldVisitor;

/// The received signal by the lidar equation of an extended target (Wagner, ISPRS J. 60 (2006)
/// 100-112): P = P_t rho(theta) D^2 eta exp(-2 alpha R) / (4 R^2). Data sheets state ranges, not
/// powers, so the unit is the signal that is detected with probability 1/2, and one pair of
/// reflectance and range of the data sheet sets the scale:
///   S = rho(theta) / rho_ref  O(R) / O(R_ref)  exp(-2 alpha (R - R_ref))  (R_ref / R)^q.
struct LidarEquation {
  double reference_reflectance = 0.8;  ///< rho_ref, of a diffuse surface at normal incidence
  double reference_range_m = 100.0;    ///< R_ref, where it is detected with probability 1/2
  double range_exponent = 2.0;    ///< q; see range_exponent() for data sheets with two reflectances
  LookupTable overlap = {};       ///< (range in m, O); empty: 1
  double extinction_per_m = 0.0;  ///< alpha
  /// Standard deviation of the signal's noise: a signal S is reported if S + sigma x >= 1 with a
  /// standard normal x. 0: every signal of at least 1 is reported.
  double noise_sigma = 0.0;
  double saturation = 0.0;  ///< larger signals are not timed (status saturated); 0: no limit
  /// Extinction of fog, rain and snow, a factor exp(-2 alpha R): data sheets state ranges in clear
  /// air.
  double weather_extinction_per_m = 0.0;
  /// The reference range of each channel (ring) where it differs from channel to channel; empty:
  /// reference_range_m for all. A channel whose range is shorter needs a stronger signal, see
  /// channel_threshold(). The unit of signals stays that of reference_range_m.
  std::vector<double> channel_range_m = {};
};

/// Throws Error with the number that is out of range.
void validate(const LidarEquation& light);

/// Keys of `lidar_equation` in sensor files.
void describe(LidarEquation& light, FieldVisitor& visitor);

/// Backscatter of a surface relative to a white diffuse surface at normal incidence;
/// core/material.hpp states the formulas. `cosine` is that of the incidence angle, 0..1.
double backscatter(const Brdf& surface, double reflectance, double cosine);

/// A material's reflectance at a wavelength: its spectrum, linear between the entries and constant
/// outside; without a spectrum, the luminance of its diffuse colour.
double reflectance_at(const Material& material, double wavelength_m);

/// O(R) / O(R_ref), the relative overlap of the beam and the receiver's field of view.
double relative_overlap(const LidarEquation& light, double range_m);

/// S of a surface with this backscatter at a range.
double received_signal(const LidarEquation& light, double backscatter, double range_m);

/// The signal that a channel detects with probability 1/2, without weather: S of the reference
/// reflectance at the reference range of the channel; 1 without ranges of channels.
double channel_threshold(const LidarEquation& light, std::uint16_t ring);

/// The same for a beam; `rings` of all beams, empty: all have ring 0.
double channel_threshold(const LidarEquation& light, std::span<const std::uint16_t> rings,
                         std::size_t beam);

/// The status of a signal that is not detected: weather if it would be detected in clear air, else
/// below_threshold.
Status classify_weak_return(const LidarEquation& light, double signal, double range_m);

/// Echoes weaker than this multiple of the noise's standard deviation are not detected. If noise
/// passes the threshold there, the echo is not the reason: for a threshold of 3 sigma, an echo of
/// this strength makes it 1.4 times as likely as at any other range, and a weaker one less.
inline constexpr double kMinSignalToNoise = 0.1;

/// A signal with the receiver's noise; `normal` is a standard normal number. Signals below
/// kMinSignalToNoise times the noise are returned unchanged, below the threshold.
double with_noise(const LidarEquation& light, double signal, double normal);

/// Probability that a signal is reported: Phi((S - 1) / sigma), 0 below kMinSignalToNoise.
double detection_probability(const LidarEquation& light, double signal);

/// Standard deviation of the noise of a receiver that detects a surface with probability 1/2 at
/// range50_m and 0.9 at range90_m: with S = (R50 / R)^q at R = R90 it is (S - 1) / 1.2816.
double noise_sigma_of(double range50_m, double range90_m, double range_exponent);

/// q from the ranges of two reflectances: ln(rho_a / rho_b) / ln(R_a / R_b).
double range_exponent(double reflectance_a, double range_a_m, double reflectance_b,
                      double range_b_m);

/// Backscatter of the surface that a beam hit: of its material, at the incidence angle of the
/// shading normal. Requires cos_shading and reflectance.
double backscatter_at(const Scene& scene, double wavelength_m, const Hits& hits, std::size_t beam);

/// Writes S of the hits [range.begin, range.end) to `signals`, 0 for a miss. Requires the columns
/// of backscatter_at().
void received_signals(const LidarEquation& light, const Scene& scene, double wavelength_m,
                      const Hits& hits, BeamRange range, std::span<double> signals);

/// Fills a range of frame.intensity with received signals, noise included, and removes returns that
/// are too weak or too strong (status below_threshold, weather or saturated; range_m NaN, intensity
/// 0). `rings` of all beams; empty: all have ring 0. Requires cos_shading and reflectance in
/// frame.ground_truth; uses Purpose::detection.
void shade_lidar(const LidarEquation& light, const Scene& scene, double wavelength_m,
                 std::span<const std::uint16_t> rings, BeamRange range, Frame& frame);

}  // namespace glidar
