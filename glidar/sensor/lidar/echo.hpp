// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// One echo that a receiver reports: the rank-th nearest, farthest or strongest, from 0.
struct Return {
  enum class Order : std::uint8_t { nearest, farthest, strongest };
  Order order = Order::strongest;
  unsigned rank = 0;
};

inline constexpr std::size_t kMaxReturns = 16;

/// What a receiver makes of the light that comes back from a pulse.
struct Receiver {
  enum class Timing : std::uint8_t {
    centroid,     ///< an echo is where the mean of its light is
    leading_edge  ///< an echo is where it crosses the threshold: strong ones come too near
  };
  double pulse_fwhm_s = 5e-9;  ///< duration of the pulse, a Gaussian
  Timing timing = Timing::centroid;
  double separation_m = 0.0;  ///< an echo nearer than this to a stronger one is not told
  std::vector<Return> returns = {Return{}};  ///< what is reported of a beam, in this order
};

/// Throws Error naming the number that is out of range.
void validate(const Receiver& receiver);

/// Standard deviation of the pulse along the range: c / 2 times that of its duration.
double pulse_sigma_m(const Receiver& receiver);

/// The surface of what is seen in a mirror: none that sub-rays hit.
inline constexpr std::uint16_t kGhostSurface = 0xFFFFU;

/// What one way through the scene brings back, in units of the detection threshold.
struct EchoContribution {
  double range_m;
  double signal;         ///< were it alone
  std::uint32_t source;  ///< which sub-ray; kInvalidId: none, as for weather
  ReturnSource return_source;
  std::uint16_t surface = 0;  ///< see BeamSurfaces; paths of different numbers are mixed
};

/// A peak of what comes back.
struct PulseEcho {
  double range_m;           ///< mean of its paths, weighted by their signals
  double signal;            ///< height of the peak
  double sigma_m;           ///< its width: the pulse's and the spread of its paths
  std::uint32_t strongest;  ///< of its paths
  bool is_mixed;            ///< its light comes from surfaces with a gap between them
};

/// The paths and echoes of one beam, on the stack.
struct WaveformBuffer {
  static constexpr std::size_t kMax = 512;
  std::array<EchoContribution, kMax> path;
  std::array<PulseEcho, kMax> echo;
  std::size_t paths = 0;
  std::size_t echoes = 0;

  /// The weakest of too many paths are left out.
  void add(const EchoContribution& one) {
    if (paths == kMax) return replace_weakest(one);
    // Member by member: copied as a whole it would wait for its own parts to be stored.
    EchoContribution& to = path[paths++];
    to.range_m = one.range_m;
    to.signal = one.signal;
    to.source = one.source;
    to.return_source = one.return_source;
    to.surface = one.surface;
  }

  void replace_weakest(const EchoContribution& one);
};

/// Finds the peaks of the sum of the paths' pulses, in order of range. Sorts the paths by range
/// unless all are within near_m, such as the beam's width, of each other: that saves time. Two
/// equal pulses have two peaks when they are more than two standard deviations apart, c FWHM /
/// 2.355 in range; below that they are one echo at their weighted mean. An echo is mixed when at
/// least 1/1000 of its light, but for that of the air, is of other surfaces than the strongest.
void detect_peaks(double sigma_m, double near_m, WaveformBuffer& work);

/// Takes away echoes nearer than separation_m to a stronger one.
void enforce_min_separation(double separation_m, WaveformBuffer& work);

/// Where the receiver says that an echo is: the range walk of a fixed threshold is
/// -sigma sqrt(2 ln(A / T)).
double reported_range_m(const Receiver& receiver, const PulseEcho& echo);

/// Which echo each of receiver.returns is; -1: there is none. One that is told already gives way to
/// the strongest that is not.
void select_returns(const Receiver& receiver, std::span<const PulseEcho> echoes,
                    std::array<int, kMaxReturns>& chosen);

}  // namespace glidar
