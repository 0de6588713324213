// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/math/lookup_table.hpp>
#include <glidar/sensor/noise/step_traits.hpp>

namespace glidar {

class FieldVisitor;
struct NoiseBatch;
struct NoiseView;

/// Random loss of returns, with the probability 1 - (1 - p) (1 - p(R)) (1 - p(incidence)).
struct Dropout {
  static constexpr TypeInfo kType = {"dropout",
                                     "lost with probability 1 - (1-p)(1-p(R))(1-p(θ)): `dropped`",
                                     "independent losses"};
  static constexpr StepTraits kTraits = {.reads_incidence = true};
  double probability = 0.0;
  LookupTable by_range_m{};
  LookupTable by_incidence_rad{};
};

/// With this probability a beam reports a range that is uniform between near and the range of
/// another beam of its column (another channel, which fires close in time).
struct Crosstalk {
  static constexpr TypeInfo kType = {
      "crosstalk", "range uniform between near and the range of another beam of the column",
      "echo of a pulse that another channel fired"};
  static constexpr StepTraits kTraits = {.adds_returns = true};
  double probability = 0.0;
  double near_m = 0.0;
};

/// Foreign pulses and false alarms arrive at a constant rate while the range gate, from near to
/// far, is open. One that arrives before the beam's own echo, or where there is no echo, is
/// reported instead. The first arrival is exponentially distributed. Of several returns it affects
/// the first. Its Frame::return_source is false_alarm.
struct FalseAlarms {
  static constexpr TypeInfo kType = {
      "false_alarms",
      "first arrival of a Poisson process in the gate, if before the echo; a data sheet's "
      "probability P per beam is the rate -ln(1 - P) c / (2 (far - near))",
      "waiting times of a Poisson process are exponential"};
  static constexpr StepTraits kTraits = {.adds_returns = true};
  double rate_hz = 0.0;
  double near_m = 0.0;
  double far_m = 0.0;
  double intensity = 0.0;
};

/// Keys in sensor files.
void describe(Dropout& step, FieldVisitor& visitor);
void describe(Crosstalk& step, FieldVisitor& visitor);
void describe(FalseAlarms& step, FieldVisitor& visitor);

void apply(const Dropout& step, const NoiseView& view, NoiseBatch& batch);
void prepare(const Crosstalk& step, const NoiseView& view, NoiseBatch& batch);
void apply(const Crosstalk& step, const NoiseView& view, NoiseBatch& batch);
void apply(const FalseAlarms& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
