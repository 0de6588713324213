// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/constants.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Maximum number of modulation frequencies, and of phase steps of each.
inline constexpr std::size_t kMaxTofFrequencies = 8;
inline constexpr std::uint32_t kMaxTofTaps = 16;

/// How whole periods are added to the phases.
enum class TofUnwrapping : std::uint8_t {
  /// All whole numbers of periods of the highest frequency are tried; the phases with the least
  /// misfit win, and the range is the mean of minimum variance, with weights f^2.
  best_fit,
  /// As libfreenect2 does for the Kinect v2 (80, 16 and 120 MHz in this order): one frequency
  /// selects the period of the next; the range is the mean phase over the mean frequency.
  kinect_v2
};

/// The greatest misfit of the unwrapped phases: their distance, in radians, from those of the
/// nearest range. The limit is scale A^exponent, at least min_rad and at most max_rad, with A the
/// greatest amplitude of the frequencies, or the least for an exponent above 0.
struct TofMisfitTest {
  double min_rad = 0.61;
  double max_rad = 0.61;
  double scale = 1.0;
  double exponent = 0.0;
};

/// Smoothing of the complex amplitudes over 3x3 pixels, with the weights of a Gaussian of 3 px
/// times exp(-phase_weight (1 - cos d) / 2), d the difference of the phases (libfreenect2's joint
/// bilateral filter). Neighbours with an amplitude below min_amplitude have no weight. Where the
/// sum of (1 - cos d) / 2 over the neighbours reaches max_phase_change the pixel is at an edge.
struct TofFilter {
  double min_amplitude = 0.0;
  double phase_weight = 7.213475;
  double max_phase_change = 2.5;
};

/// A pixel is at an edge if all of these exceed their limits in its 3x3 pixels: the standard
/// deviation of the amplitude over its mean, the step to the nearest and to the farthest depth, the
/// greater of both, and their mean.
struct TofEdgeTest {
  double amplitude_deviation = 0.0;
  double min_mean_amplitude = 0.0;  ///< the mean counts as at least this
  double near_step_m = 0.05;
  double far_step_m = 0.03;
  double max_step_m = 0.1;
  double mean_step_m = 0.0;
};

/// Options of decode_tof(). Amplitudes have the unit of the raw values times amplitude_gain.
struct TofOptions {
  std::vector<double> frequencies_hz = {};
  std::uint32_t taps = 4;                   ///< N: phase steps of each frequency, 2 pi k / N
  std::vector<double> amplitude_gain = {};  ///< one for each frequency; empty: 1
  /// Raw values of this magnitude or above are saturated; infinity: infinite ones alone.
  double saturation_level = kInfinity;
  TofUnwrapping unwrapping = TofUnwrapping::best_fit;
  double min_amplitude = 0.0;      ///< of every frequency
  double min_amplitude_sum = 0.0;  ///< over all frequencies
  TofMisfitTest misfit_test = {};
  std::optional<TofFilter> filter = {};       ///< empty: none
  std::optional<TofEdgeTest> edge_test = {};  ///< empty: no test
  double near_m = 0.0;                        ///< depth limits
  double far_m = kInfinity;
};

/// Shows every option with its bounds and default to a visitor.
void describe(TofMisfitTest& test, FieldVisitor& visitor);
void describe(TofFilter& filter, FieldVisitor& visitor);
void describe(TofEdgeTest& test, FieldVisitor& visitor);
void describe(TofOptions& options, FieldVisitor& visitor);

/// Throws Error naming the first option that is not allowed.
void validate(const TofOptions& options);

/// The options of libfreenect2 for the Kinect v2: gains, thresholds, filter, tests and limits of
/// DepthPacketProcessor::Parameters (OpenKinect/libfreenect2, src/depth_packet_processor.cpp).
TofOptions kinect_v2_options();

}  // namespace glidar
