// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/tof_options.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/light_speed.hpp>
#include <glidar/math/unambiguous_range.hpp>
#include <glidar/tof/number_checks.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace glidar {
namespace {

constexpr WholeRule kTapRule = {3, kMaxTofTaps};
constexpr NumberRule kFrequencyRule = {1.0, 1e12, false, "hertz from 1 to 1e12"};
constexpr NumberRule kExponentRule = {-10.0, 10.0, false, "a number from -10 to 10"};
constexpr NumberRule kUpToInfinity = {0.0, kInfinity, false, "a number from 0"};

constexpr std::array<Named<TofUnwrapping>, 2> kUnwrappingNames = {
    {{"best_fit", TofUnwrapping::best_fit}, {"kinect_v2", TofUnwrapping::kinect_v2}}};

/// Periods of the highest frequency that best_fit tries at most.
constexpr double kMaxPeriods = 1000.0;

constexpr const char* kPlace = "time-of-flight option ";

std::string list_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value);
  return "[" + text + "]";
}

void validate_frequencies(const TofOptions& options) {
  const std::vector<double>& f = options.frequencies_hz;
  if (f.empty() || f.size() > kMaxTofFrequencies) {
    throw Error({kPlace + std::string("frequencies_hz"),
                 "has " + std::to_string(f.size()) + " frequencies",
                 "1 to " + std::to_string(kMaxTofFrequencies), ""});
  }
  for (const double f_hz : f)
    tof::require_numbers(kPlace, {{"frequencies_hz", kFrequencyRule, f_hz}});
  const double periods =
      unambiguous_range_m(f) * *std::max_element(f.begin(), f.end()) / kHalfLight_m_per_s;
  if (periods > kMaxPeriods + 0.5) {
    throw Error({kPlace + std::string("frequencies_hz"),
                 "their greatest common divisor is below a thousandth of the greatest",
                 "frequencies in simple ratios", "round them to whole MHz"});
  }
  if (options.amplitude_gain.empty() || options.amplitude_gain.size() == f.size()) return;
  throw Error({kPlace + std::string("amplitude_gain"),
               "has " + std::to_string(options.amplitude_gain.size()) + " numbers for " +
                   std::to_string(f.size()) + " frequencies",
               "one for each, or none", ""});
}

void validate_unwrapping(const TofOptions& options) {
  if (options.unwrapping != TofUnwrapping::kinect_v2) return;
  const std::vector<double>& f = options.frequencies_hz;
  if (f.size() == 3 && f[0] == 5.0 * f[1] && 2.0 * f[2] == 15.0 * f[1]) return;
  throw Error({kPlace + std::string("unwrapping"), "kinect_v2 with frequencies_hz " + list_text(f),
               "three frequencies in the ratio 10 : 2 : 15, such as 80, 16 and 120 MHz",
               "use best_fit for others"});
}

}  // namespace

void describe(TofMisfitTest& test, FieldVisitor& visitor) {
  visitor.number({"min_rad", "lower bound of the limit, radians"}, kFromZero, test.min_rad);
  visitor.number({"max_rad", "upper bound of the limit, radians"}, kFromZero, test.max_rad);
  visitor.number({"scale", "limit at amplitude 1, radians"}, kFromZero, test.scale);
  visitor.number({"exponent", "of the amplitude"}, kExponentRule, test.exponent);
}

void describe(TofFilter& filter, FieldVisitor& visitor) {
  visitor.number({"min_amplitude", "neighbours below it have no weight"}, kFromZero,
                 filter.min_amplitude);
  visitor.number({"phase_weight", "weights are exp(-this (1 - cos Δφ)/2)"}, kFromZero,
                 filter.phase_weight);
  visitor.number(
      {"max_phase_change", "from this sum of (1 - cos Δφ)/2 on, the pixel is at an edge"},
      kFromZero, filter.max_phase_change);
}

void describe(TofEdgeTest& test, FieldVisitor& visitor) {
  visitor.number({"amplitude_deviation", "standard deviation over mean of the amplitude"},
                 kFromZero, test.amplitude_deviation);
  visitor.number({"min_mean_amplitude", "the mean counts as at least this"}, kFromZero,
                 test.min_mean_amplitude);
  visitor.number({"near_step_m", "step to the nearest depth", kUnitMetre}, kFromZero,
                 test.near_step_m);
  visitor.number({"far_step_m", "step to the farthest depth", kUnitMetre}, kFromZero,
                 test.far_step_m);
  visitor.number({"max_step_m", "the greater of both steps", kUnitMetre}, kFromZero,
                 test.max_step_m);
  visitor.number({"mean_step_m", "their mean", kUnitMetre}, kFromZero, test.mean_step_m);
}

void describe(TofOptions& options, FieldVisitor& visitor) {
  visitor.numbers(
      {"frequencies_hz", "of the modulation; 1 to 8 in simple ratios", kUnitHertz, kRequired},
      {.number = kFrequencyRule, .max_size = kMaxTofFrequencies, .allowed = "1 to 8 frequencies"},
      options.frequencies_hz);
  visitor.whole_number({"taps", "phase steps of each frequency"}, kTapRule, options.taps);
  visitor.numbers(
      {"amplitude_gain", "factors of the amplitudes, one for each frequency", kNoUnit, false, "1"},
      {.number = kAboveZero,
       .max_size = kMaxTofFrequencies,
       .allowed = "a number above 0 for each frequency"},
      options.amplitude_gain);
  visit_choice(visitor, {"unwrapping", "how whole periods are added to the phases"},
               kUnwrappingNames, options.unwrapping);
  visitor.number({"min_amplitude", "of every frequency"}, kFromZero, options.min_amplitude);
  visitor.number({"min_amplitude_sum", "over all frequencies"}, kFromZero,
                 options.min_amplitude_sum);
  visit_object(visitor, {"misfit_test", "greatest misfit of the phases"}, options.misfit_test);
  visit_object(visitor, {"filter", "smoothing of the complex amplitudes; without it, none"},
               options.filter);
  visit_object(visitor, {"edge_test", "removal of pixels at edges; without it, none"},
               options.edge_test);
}

void validate(const TofOptions& options) {
  if (options.taps < kTapRule.min || options.taps > kTapRule.max) {
    throw Error({kPlace + std::string("taps"), "is " + std::to_string(options.taps),
                 "a whole number from 3 to " + std::to_string(kMaxTofTaps), ""});
  }
  validate_frequencies(options);
  validate_unwrapping(options);
  for (const double gain : options.amplitude_gain) {
    tof::require_numbers(kPlace, {{"amplitude_gain", kAboveZero, gain}});
  }
  const TofMisfitTest& misfit = options.misfit_test;
  const TofFilter filter = options.filter.value_or(TofFilter{});
  const TofEdgeTest edge = options.edge_test.value_or(TofEdgeTest{});
  tof::require_numbers(kPlace,
                       {{"saturation_level", kUpToInfinity, options.saturation_level},
                        {"min_amplitude", kFromZero, options.min_amplitude},
                        {"min_amplitude_sum", kFromZero, options.min_amplitude_sum},
                        {"misfit_test.min_rad", kFromZero, misfit.min_rad},
                        {"misfit_test.max_rad", kFromZero, misfit.max_rad},
                        {"misfit_test.scale", kFromZero, misfit.scale},
                        {"misfit_test.exponent", kExponentRule, misfit.exponent},
                        {"filter.min_amplitude", kFromZero, filter.min_amplitude},
                        {"filter.phase_weight", kFromZero, filter.phase_weight},
                        {"filter.max_phase_change", kFromZero, filter.max_phase_change},
                        {"edge_test.amplitude_deviation", kFromZero, edge.amplitude_deviation},
                        {"edge_test.min_mean_amplitude", kFromZero, edge.min_mean_amplitude},
                        {"edge_test.near_step_m", kFromZero, edge.near_step_m},
                        {"edge_test.far_step_m", kFromZero, edge.far_step_m},
                        {"edge_test.max_step_m", kFromZero, edge.max_step_m},
                        {"edge_test.mean_step_m", kFromZero, edge.mean_step_m},
                        {"near_m", kFromZero, options.near_m},
                        {"far_m", kUpToInfinity, options.far_m}});
}

TofOptions kinect_v2_options() {
  TofOptions options;
  options.frequencies_hz = {80e6, 16e6, 120e6};
  options.taps = 3;
  options.amplitude_gain = {1.322581, 1.0, 1.612903};
  options.saturation_level = 32767.0;
  options.unwrapping = TofUnwrapping::kinect_v2;
  options.min_amplitude = 3.0;
  options.min_amplitude_sum = 10.0;
  // exp(3.321928 (0.30103 s ln A + o)) with s = -0.5330578 and o = 0.7694894
  options.misfit_test = {
      .min_rad = 0.3490659, .max_rad = 0.6108653, .scale = 12.8866, .exponent = -0.5330578};
  // exp(-1.442695 x 5 x ...)
  options.filter = {.min_amplitude = 3.0, .phase_weight = 7.213475, .max_phase_change = 2.5};
  options.edge_test = {.amplitude_deviation = 0.05, .min_mean_amplitude = 50.0};
  options.near_m = 0.5;
  options.far_m = 4.5;
  return options;
}

}  // namespace glidar
