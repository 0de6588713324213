// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>
#include <glidar/math/lookup_table.hpp>

#include <span>

namespace glidar {

/// What a pulse brings back, by the range equation of an extended target (Wagner, ISPRS J. 60
/// (2006) 100-112): P = P_t rho(theta) D^2 eta exp(-2 alpha R) / (4 R^2). Data sheets give no watts
/// but ranges, so the signal is told in units of the one that is seen with probability 1/2, and one
/// pair of a sheet fixes the scale:
///   S = rho(theta) / rho_ref  O(R) / O(R_ref)  exp(-2 alpha (R - R_ref))  (R_ref / R)^q.
struct LidarEquation {
  double reference_reflectance = 0.8;  ///< rho_ref, of a matt surface seen square on
  double reference_range_m = 100.0;    ///< R_ref, where it is seen with probability 1/2
  double range_exponent = 2.0;    ///< q; sheets of two reflectances tell it, see range_exponent
  LookupTable overlap = {};       ///< (range in m, O); empty: 1
  double extinction_per_m = 0.0;  ///< alpha
  /// Standard deviation of the signal's noise: a signal S is reported when S + sigma x >= 1 with a
  /// normal x. 0: every signal of 1 and more is.
  double noise_sigma = 0.0;
  double saturation = 0.0;  ///< signals from here on are not timed: saturated; 0: none
  /// Of fog, rain and snow: takes exp(-2 alpha R), since sheets tell ranges in clear air.
  double weather_extinction_per_m = 0.0;
};

/// Throws Error naming the number that is out of range.
void validate(const LidarEquation& light);

/// What a surface sends straight back, relative to a white matt surface seen square on; the forms
/// are told at core/brdf.hpp. `cosine` is that of the incidence, 0..1.
double backscatter(const Brdf& surface, double reflectance, double cosine);

/// A material's reflectance at a wavelength: from its spectrum, linear between the entries and held
/// outside; without one, the luminance of its diffuse colour.
double reflectance_at(const Material& material, double wavelength_m);

/// O(R) / O(R_ref): how much of the beam the receiver sees.
double relative_overlap(const LidarEquation& light, double range_m);

/// S for what a surface sends back over a range.
double received_signal(const LidarEquation& light, double backscatter, double range_m);

/// Why a signal is not told from noise: weather, or below_threshold where it would not have been in
/// clear air either.
Status classify_weak_return(const LidarEquation& light, double signal, double range_m);

/// An echo weaker than this part of the noise's standard deviation is not found. Where noise passes
/// the threshold, such an echo is not the reason: with a threshold of 3 sigma it makes that 1.4
/// times as likely as at any other range, and a much weaker one no likelier at all.
inline constexpr double kMinSignalToNoise = 0.1;

/// A signal with the receiver's noise; `normal` is a number of the normal distribution. Without
/// noise, and below the threshold, where the signal is too weak beside it (kMinSignalToNoise).
double with_noise(const LidarEquation& light, double signal, double normal);

/// Probability that a signal is reported: Phi((S - 1) / sigma), 0 below kMinSignalToNoise.
double detection_probability(const LidarEquation& light, double signal);

/// The noise of a receiver that reports a surface with probability 1/2 at range50_m and 0.9 at
/// range90_m: with S = (R50 / R)^q it is (S - 1) / 1.2816.
double noise_sigma_of(double range50_m, double range90_m, double range_exponent);

/// q from the ranges of two reflectances: ln(rho_a / rho_b) / ln(R_a / R_b).
double range_exponent(double reflectance_a, double range_a_m, double reflectance_b,
                      double range_b_m);

/// What the surface that a beam hit sends straight back: its material's backscatter at the
/// incidence of its shading normal. Needs cos_shading and reflectance.
double backscatter_at(const Scene& scene, double wavelength_m, const Hits& hits, std::size_t beam);

/// S of hits [range.begin, range.end) into `signals`, 0 where nothing was hit. Needs what
/// backscatter_at() does.
void received_signals(const LidarEquation& light, const Scene& scene, double wavelength_m,
                      const Hits& hits, BeamRange range, std::span<double> signals);

/// Fills a run of frame.intensity with signals as the receiver has them, noise included, and takes
/// away what is too weak or too strong (status below_threshold, weather where clear air had let it
/// through, or saturated; range_m NaN, intensity 0). Needs cos_shading and reflectance in
/// frame.ground_truth; draws with Purpose::detection.
void shade_lidar(const LidarEquation& light, const Scene& scene, double wavelength_m,
                 BeamRange range, Frame& frame);

}  // namespace glidar
