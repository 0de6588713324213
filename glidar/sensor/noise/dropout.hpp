// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/lookup_table.hpp>

namespace glidar {

struct NoiseBatch;
struct NoiseView;

/// Random loss of returns, with the probability 1 - (1 - p) (1 - p(R)) (1 - p(incidence)).
struct Dropout {
  double probability = 0.0;
  LookupTable by_range_m{};
  LookupTable by_incidence_rad{};
};

/// With this probability a beam reports a range that is uniform between near and the range of
/// another beam of its column (another channel, which fires close in time).
struct Crosstalk {
  double probability = 0.0;
  double near_m = 0.0;
};

/// Foreign pulses and false alarms arrive at a constant rate while the range gate, from near to
/// far, is open. One that arrives before the beam's own echo, or where there is no echo, is
/// reported instead. The first arrival is exponentially distributed. Of several returns it affects
/// the first. Its Frame::return_source is false_alarm.
struct FalseAlarms {
  double rate_hz = 0.0;
  double near_m = 0.0;
  double far_m = 0.0;
  double intensity = 0.0;
};

/// The probability of losing a return.
double drop_probability(const Dropout& step, double range_m, double cos_incidence);

void apply(const Dropout& step, const NoiseView& view, NoiseBatch& batch);
void prepare(const Crosstalk& step, const NoiseView& view, NoiseBatch& batch);
void apply(const Crosstalk& step, const NoiseView& view, NoiseBatch& batch);
void apply(const FalseAlarms& step, const NoiseView& view, NoiseBatch& batch);

}  // namespace glidar
