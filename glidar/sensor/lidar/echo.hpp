// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Selects one echo to report: the rank-th nearest, farthest or strongest, from 0.
struct Return {
  enum class Order : std::uint8_t { nearest, farthest, strongest };
  Order order = Order::strongest;
  unsigned rank = 0;
};

inline constexpr std::size_t kMaxReturns = 16;

/// How the receiver detects and reports the echoes of a pulse.
struct Receiver {
  enum class Timing : std::uint8_t {
    centroid,     ///< the range of an echo is its mean, weighted by signal
    leading_edge  ///< the range is where the echo crosses the threshold: too short for strong
                  ///< echoes
  };
  double pulse_fwhm_s = 5e-9;  ///< duration of the pulse, a Gaussian
  Timing timing = Timing::centroid;
  double min_return_separation_m =
      0.0;  ///< echoes nearer than this to a stronger one are not reported
  std::vector<Return> returns = {Return{}};  ///< reported echoes of a beam, in this order
};

/// Throws Error with the number that is out of range.
void validate(const Receiver& receiver);

/// Keys of `receiver` in sensor files.
void describe(Receiver& receiver, FieldVisitor& visitor);

/// Standard deviation of the pulse in range, metres: c / 2 times that of its duration.
double pulse_sigma_m(const Receiver& receiver);

/// Surface number of contributions through a mirror; no sub-ray has it.
inline constexpr std::uint16_t kGhostSurface = 0xFFFFU;

/// The contribution of one light path to the waveform, in units of the detection threshold.
struct EchoContribution {
  double range_m;
  double signal;         ///< of this path alone
  std::uint32_t source;  ///< index of the sub-ray; kInvalidId: none, as for weather
  ReturnSource return_source;
  std::uint16_t surface = 0;  ///< see BeamSurfaces; echoes of several surfaces are mixed
};

/// A peak of the waveform.
struct PulseEcho {
  double range_m;           ///< mean of its contributions, weighted by their signals
  double signal;            ///< height of the peak
  double sigma_m;           ///< of the pulse and of the spread of the contributions
  std::uint32_t strongest;  ///< index of its strongest contribution
  std::uint16_t begin = 0;  ///< its contributions are [begin, end)
  std::uint16_t end = 0;
  bool is_mixed;  ///< of several surfaces with a gap between them
};

/// The contributions and echoes of one beam, on the stack.
struct WaveformBuffer {
  static constexpr std::size_t kMax = 512;
  std::array<EchoContribution, kMax> path;
  std::array<PulseEcho, kMax> echo;
  std::size_t paths = 0;
  std::size_t echoes = 0;

  /// Adds a contribution; replaces the weakest one if the buffer is full.
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

/// Finds the peaks of the sum of the contributions' pulses, in order of range. Sorts the
/// contributions by range, unless all are within near_m (e.g. the beam's width) of each other, to
/// save time. Two equal pulses have two peaks if they are more than two standard deviations apart,
/// c FWHM / 2.355 in range; otherwise they are one echo at their weighted mean. An echo is mixed if
/// at least 1/1000 of its signal, excluding weather, is from other surfaces than the strongest.
void detect_peaks(double sigma_m, double near_m, WaveformBuffer& work);

/// Removes echoes nearer than min_return_separation_m to a stronger one.
void enforce_min_separation(double min_return_separation_m, WaveformBuffer& work);

/// The range that the receiver reports for an echo. The range walk of a fixed threshold is
/// -sigma sqrt(2 ln(A / T)).
double reported_range_m(const Receiver& receiver, const PulseEcho& echo);

/// The index of the echo for each of receiver.returns; -1: none. If an echo is already reported,
/// the strongest remaining one takes its place.
void select_returns(const Receiver& receiver, std::span<const PulseEcho> echoes,
                    std::array<int, kMaxReturns>& chosen);

}  // namespace glidar
