// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/time_of_flight.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/sequence_time.hpp>
#include <glidar/core/text.hpp>
#include <glidar/depth_camera/tof_decoding.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/math/unambiguous_range.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <string>

namespace glidar {
namespace {

/// A number with the rule that it must follow.
struct CheckedNumber {
  const char* key;
  const NumberRule& rule;
  double value;
};

/// Throws Error naming `place` and the key of the first number that its rule does not accept.
void require_numbers(const std::string& place, std::initializer_list<CheckedNumber> numbers) {
  for (const auto& [key, rule, value] : numbers) {
    if (!accepts(rule, value)) {
      throw Error({place + key, "is " + number_text(value), rule.allowed, ""});
    }
  }
}

constexpr WholeRule kTapRule = {3, kMaxTofTaps};
constexpr NumberRule kFrequencyRule = {1.0, 1e12, false, "hertz from 1 to 1e12"};
constexpr NumberRule kExponentRule = {-10.0, 10.0, false, "a number from -10 to 10"};
constexpr NumberRule kUpToInfinity = {0.0, kInfinity, false, "a number from 0"};

constexpr std::array<Named<TofUnwrapping>, 2> kUnwrappingNames = {
    {{"best_fit", TofUnwrapping::best_fit}, {"kinect_v2", TofUnwrapping::kinect_v2}}};

/// Periods of the highest frequency that best_fit tries at most.
constexpr double kMaxPeriods = 1000.0;

constexpr const char* kTofPlace = "time-of-flight option ";

std::string list_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value);
  return "[" + text + "]";
}

void validate_frequencies(const TofOptions& options) {
  const std::vector<double>& f = options.frequencies_hz;
  if (f.empty() || f.size() > kMaxTofFrequencies) {
    throw Error({kTofPlace + std::string("frequencies_hz"),
                 "has " + std::to_string(f.size()) + " frequencies",
                 "1 to " + std::to_string(kMaxTofFrequencies), ""});
  }
  for (const double f_hz : f)
    require_numbers(kTofPlace, {{"frequencies_hz", kFrequencyRule, f_hz}});
  const double periods =
      unambiguous_range_m(f) * *std::max_element(f.begin(), f.end()) / kHalfLight_m_per_s;
  if (periods > kMaxPeriods + 0.5) {
    throw Error({kTofPlace + std::string("frequencies_hz"),
                 "their greatest common divisor is below a thousandth of the greatest",
                 "frequencies in simple ratios", "round them to whole MHz"});
  }
  if (options.amplitude_gain.empty() || options.amplitude_gain.size() == f.size()) return;
  throw Error({kTofPlace + std::string("amplitude_gain"),
               "has " + std::to_string(options.amplitude_gain.size()) + " numbers for " +
                   std::to_string(f.size()) + " frequencies",
               "one for each, or none", ""});
}

void validate_unwrapping(const TofOptions& options) {
  if (options.unwrapping != TofUnwrapping::kinect_v2) return;
  const std::vector<double>& f = options.frequencies_hz;
  if (f.size() == 3 && f[0] == 5.0 * f[1] && 2.0 * f[2] == 15.0 * f[1]) return;
  throw Error({kTofPlace + std::string("unwrapping"),
               "kinect_v2 with frequencies_hz " + list_text(f),
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
    throw Error({kTofPlace + std::string("taps"), "is " + std::to_string(options.taps),
                 "a whole number from 3 to " + std::to_string(kMaxTofTaps), ""});
  }
  validate_frequencies(options);
  validate_unwrapping(options);
  for (const double gain : options.amplitude_gain) {
    require_numbers(kTofPlace, {{"amplitude_gain", kAboveZero, gain}});
  }
  const TofMisfitTest& misfit = options.misfit_test;
  const TofFilter filter = options.filter.value_or(TofFilter{});
  const TofEdgeTest edge = options.edge_test.value_or(TofEdgeTest{});
  require_numbers(kTofPlace,
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

namespace {

constexpr NumberRule kContrastRule = {0.0, 1.0 + 1e-12, true, "a number above 0, up to 1"};
constexpr WholeRule kSubRayRule = {1, 16};
constexpr WholeRule kBounceRule = {0, 32};
constexpr WholeRule kBounceRayRule = {1, 4096};
constexpr WholeRule kFilterRule = {0, 8};

constexpr std::array<Named<TofWaveform>, 2> kWaveformNames = {
    {{"sine", TofWaveform::sine}, {"triangle", TofWaveform::triangle}}};

constexpr const char* kCameraPlace = "time_of_flight, ";

void require_whole_value(const char* key, const WholeRule& rule, std::uint32_t value) {
  if (value >= rule.min && value <= rule.max) return;
  throw Error(
      {kCameraPlace + std::string(key), "is " + std::to_string(value),
       "a whole number from " + std::to_string(rule.min) + " to " + std::to_string(rule.max), ""});
}

void require_contrasts(const TofCamera& camera, const FieldVisitor* visitor) {
  const std::size_t needed = camera.decoder.frequencies_hz.size();
  if (camera.contrast.empty() || camera.contrast.size() == needed) return;
  const std::string found = "has " + std::to_string(camera.contrast.size()) + " numbers for " +
                            std::to_string(needed) + " frequencies";
  if (visitor != nullptr) visitor->reject("contrast", found, "one for each frequency, or none");
  throw Error(
      {kCameraPlace + std::string("contrast"), found, "one for each frequency, or none", ""});
}

void require_sequence(const TofCamera& camera, const FieldVisitor* visitor) {
  const std::size_t steps = camera.decoder.frequencies_hz.size() * camera.decoder.taps;
  const double sequence_s = static_cast<double>(steps) * camera.step_interval_s;
  if (sequence_s <= kMaxSequence_s) return;
  const std::string found = "is " + number_text(camera.step_interval_s) + ", so that " +
                            std::to_string(steps) + " phase steps take " + number_text(sequence_s) +
                            " s";
  const std::string allowed = "at most " + number_text(kMaxSequence_s) + " s for all phase steps";
  const std::string remedy = "use a shorter interval or fewer phase steps";
  if (visitor != nullptr) visitor->reject("step_interval_s", found, allowed, remedy);
  throw Error({kCameraPlace + std::string("step_interval_s"), found, allowed, remedy});
}

}  // namespace

void describe(TofCamera& camera, FieldVisitor& visitor) {
  visitor.number({"signal_electrons", "A of a white diffuse surface at normal incidence at 1 m",
                  kNoUnit, kRequired},
                 kAboveZero, camera.signal_electrons);
  visitor.number({"ambient_electrons", "B of a white surface in the ambient light"}, kFromZero,
                 camera.ambient_electrons);
  visitor.number({"dark_electrons", "B without light"}, kFromZero, camera.dark_electrons);
  visitor.numbers({"contrast", "of the demodulation, one for each frequency", kNoUnit, false, "1"},
                  {.number = kContrastRule,
                   .max_size = kMaxTofFrequencies,
                   .allowed = "a number above 0, up to 1, for each frequency"},
                  camera.contrast);
  visit_choice(visitor,
               {"waveform", "correlation: `sine`, or `triangle` of a square with a square wave"},
               kWaveformNames, camera.waveform);
  visitor.number({"read_noise_electrons", "standard deviation, of each of the two wells"},
                 kFromZero, camera.read_noise_electrons);
  visitor.number({"full_well_electrons", "from which a well is saturated", kNoUnit, false, "none"},
                 kAboveZero, camera.full_well_electrons);
  visitor.number({"electrons_per_level", "unit of the raw values"}, kAboveZero,
                 camera.electrons_per_level);
  visitor.boolean({"has_whole_levels", "raw values are rounded"}, camera.has_whole_levels);
  visitor.number(
      {"step_interval_s",
       "from the start of a phase step to the next; all phase steps take at most 4 s", kUnitSecond},
      kFromZero, camera.step_interval_s);
  visitor.whole_number({"sub_rays", "n: each pixel is n x n rays"}, kSubRayRule, camera.sub_rays);
  visitor.whole_number({"bounces", "diffuse bounces of the light; 0: direct light alone"},
                       kBounceRule, camera.bounces);
  visitor.whole_number({"bounce_rays", "rays per pixel that sample the bounces"}, kBounceRayRule,
                       camera.bounce_rays);
  visitor.whole_number({"bounce_filter_px",
                        "bounced light is averaged over pixels of the same surface in a square of "
                        "this radius; 0: not at all",
                        kUnitPixel},
                       kFilterRule, camera.bounce_filter_px);
  visit_object(visitor, {"decoder", "from raw images to ranges", kNoUnit, kRequired},
               camera.decoder);
  if (!visitor.is_reading()) return;
  require_contrasts(camera, &visitor);
  require_sequence(camera, &visitor);
}

void validate(const TofCamera& camera) {
  require_numbers(kCameraPlace, {{"signal_electrons", kAboveZero, camera.signal_electrons},
                                 {"ambient_electrons", kFromZero, camera.ambient_electrons},
                                 {"dark_electrons", kFromZero, camera.dark_electrons},
                                 {"read_noise_electrons", kFromZero, camera.read_noise_electrons},
                                 {"electrons_per_level", kAboveZero, camera.electrons_per_level},
                                 {"step_interval_s", kFromZero, camera.step_interval_s}});
  if (camera.full_well_electrons != kInfinity) {
    require_numbers(kCameraPlace,
                    {{"full_well_electrons", kAboveZero, camera.full_well_electrons}});
  }
  for (const double contrast : camera.contrast) {
    require_numbers(kCameraPlace, {{"contrast", kContrastRule, contrast}});
  }
  require_whole_value("sub_rays", kSubRayRule, camera.sub_rays);
  require_whole_value("bounces", kBounceRule, camera.bounces);
  require_whole_value("bounce_rays", kBounceRayRule, camera.bounce_rays);
  require_whole_value("bounce_filter_px", kFilterRule, camera.bounce_filter_px);
  validate(camera.decoder);
  require_contrasts(camera, nullptr);
  require_sequence(camera, nullptr);
}

namespace {

/// Blocks from here on are those of uniform numbers.
constexpr std::uint32_t kBlocksOfNormals = kMaxTofFrequencies * kMaxTofTaps;

float to_level(const TofCamera& camera, double plus, double minus) {
  if (std::max(plus, minus) >= camera.full_well_electrons) return kInfinityf;
  const double level = (plus - minus) / camera.electrons_per_level;
  return static_cast<float>(camera.has_whole_levels ? std::floor(level + 0.5) : level);
}

}  // namespace

double tof_correlation(TofWaveform waveform, double turns) {
  if (waveform == TofWaveform::sine) return sincos_turns(turns).cosine;
  return 1.0 - 4.0 * std::abs(turns - std::floor(turns + 0.5));
}

TofSteps make_tof_steps(const TofCamera& camera) {
  TofSteps steps;
  steps.waveform = camera.waveform;
  steps.frequencies = camera.decoder.frequencies_hz.size();
  steps.taps = camera.decoder.taps;
  for (std::size_t f = 0; f < steps.frequencies; ++f) {
    steps.per_m[f] = camera.decoder.frequencies_hz[f] / kHalfLight_m_per_s;
  }
  for (std::size_t k = 0; k < steps.taps; ++k) {
    const SineCosine wave = sincos_turns(static_cast<double>(k) / static_cast<double>(steps.taps));
    steps.cosine[k] = wave.cosine;
    steps.sine[k] = wave.sine;
  }
  return steps;
}

void add_light(const TofSteps& steps, double range_m, double electrons,
               std::span<TofLight> of_steps) {
  for (std::size_t f = 0; f < steps.frequencies; ++f) {
    const double turns = range_m * steps.per_m[f];
    const SineCosine wave = sincos_turns(turns);
    for (std::size_t k = 0; k < steps.taps; ++k) {
      TofLight& light = of_steps[f * steps.taps + k];
      const double correlation =
          steps.waveform == TofWaveform::sine
              ? wave.cosine * steps.cosine[k] + wave.sine * steps.sine[k]
              : tof_correlation(steps.waveform,
                                turns - static_cast<double>(k) / static_cast<double>(steps.taps));
      light.signal += electrons;
      light.correlated += electrons * correlation;
    }
  }
}

void add_light(const TofSteps& steps, double range_m, double electrons, std::size_t step,
               TofLight& light) {
  const std::size_t f = step / steps.taps;
  const std::size_t k = step % steps.taps;
  const double turns =
      range_m * steps.per_m[f] - static_cast<double>(k) / static_cast<double>(steps.taps);
  light.signal += electrons;
  light.correlated += electrons * tof_correlation(steps.waveform, turns);
}

std::array<double, 2> mean_electrons(const TofCamera& camera, std::size_t frequency,
                                     const TofLight& light) {
  const double contrast = camera.contrast.empty() ? 1.0 : camera.contrast[frequency];
  const double all = light.background + light.signal;
  const double difference = contrast * light.correlated;
  return {std::max(0.0, 0.5 * (all + difference)), std::max(0.0, 0.5 * (all - difference))};
}

float expose(const TofCamera& camera, std::size_t frequency, const TofLight& light,
             const RngKey& key) {
  const std::array<double, 2> mean = mean_electrons(camera, frequency, light);
  const std::array<double, 4> normal = normals(random_words(key));
  RandomWords words = {};
  if (std::min(mean[0], mean[1]) < kPoissonInversionLimit) {
    RngKey other = key;
    other.block += kBlocksOfNormals;
    words = random_words(other);
  }
  const double plus = sample_poisson(mean[0], uniform(words[0]), normal[0]);
  const double minus = sample_poisson(mean[1], uniform(words[1]), normal[1]);
  const double read = camera.read_noise_electrons;
  return to_level(camera, plus + read * normal[2], minus + read * normal[3]);
}

float expose_without_noise(const TofCamera& camera, std::size_t frequency, const TofLight& light) {
  const std::array<double, 2> mean = mean_electrons(camera, frequency, light);
  return to_level(camera, mean[0], mean[1]);
}

const char* to_string(TofStatus status) {
  static constexpr std::array<const char*, kTofStatusCount> kNames = {
      "valid",     "not_illuminated", "saturated", "low_signal",
      "ambiguous", "too_near",        "too_far",   "edge"};
  return kNames[static_cast<std::size_t>(status)];
}

TofMeasurement decode_tof(const TofImages& images, const TofOptions& options,
                          const TofCalibration& calibration, const TofRun& run) {
  return tof::decode(images, options, calibration, run.pool).measurement;
}

namespace {

using tof::Decoding;
using tof::EdgeEvidence;
using tof::TofEvidence;

std::string limit_text(double limit, unsigned decimals) {
  return limit == kInfinity ? "none" : decimal_text(limit, decimals);
}

std::string edge_text(const EdgeEvidence& edge, const TofOptions& options) {
  if (!options.edge_test && !options.filter) return "no test";
  if (edge.is_border) return "no test at the border of the image";
  std::string text;
  if (options.edge_test) {
    const TofEdgeTest& test = *options.edge_test;
    text = "amplitude deviation " + decimal_text(edge.amplitude_deviation, 3) + " (edge from " +
           decimal_text(test.amplitude_deviation, 3) + "), steps to the nearest " +
           decimal_text(edge.near_step_m, 3) + " m (above " + decimal_text(test.near_step_m, 3) +
           ") and farthest depth " + decimal_text(edge.far_step_m, 3) + " m (above " +
           decimal_text(test.far_step_m, 3) + ")";
  }
  if (!options.filter) return text;
  return text + (text.empty() ? "" : ", ") + "phase change " + decimal_text(edge.phase_change, 3) +
         " (edge from " + decimal_text(options.filter->max_phase_change, 3) + ")";
}

std::vector<TofTest> list_tests(const TofEvidence& pixel, const EdgeEvidence& edge,
                                const TofOptions& options) {
  const std::string depth = "depth " + decimal_text(pixel.depth_m, 3) + " m, ";
  return {{TofStatus::not_illuminated, pixel.is_illuminated,
           pixel.is_illuminated ? "the illuminator lights the pixel"
                                : "the illuminator does not light the pixel"},
          {TofStatus::saturated, !pixel.is_saturated,
           "saturation level: " + limit_text(options.saturation_level, 0)},
          {TofStatus::low_signal, has_signal(pixel, options),
           "least amplitude " + decimal_text(pixel.min_amplitude) + ", needed: " +
               decimal_text(options.min_amplitude) + "; sum " + decimal_text(pixel.amplitude_sum) +
               ", needed: " + decimal_text(options.min_amplitude_sum)},
          {TofStatus::ambiguous, has_fit(pixel),
           "misfit of the phases " + decimal_text(pixel.unwrapped.misfit_rad, 3) +
               " rad, allowed: " + decimal_text(pixel.misfit_limit_rad, 3)},
          {TofStatus::too_near, !(pixel.depth_m < options.near_m),
           depth + "limit: " + decimal_text(options.near_m, 3)},
          {TofStatus::too_far, !(pixel.depth_m > options.far_m),
           depth + "limit: " + limit_text(options.far_m, 3)},
          {TofStatus::edge, !is_depth_edge(edge, options) && !is_phase_edge(edge, options),
           edge_text(edge, options)}};
}

std::vector<TofCandidate> list_candidates(const tof::Unwrapping& unwrapping,
                                          const tof::PerFrequency& turns) {
  std::vector<TofCandidate> candidates;
  for (std::size_t period = 0; period < unwrapping.periods; ++period) {
    const tof::Unwrapped found = unwrap_candidate(unwrapping, turns, period);
    TofCandidate candidate{found.range_m, found.misfit_rad};
    for (std::size_t f = 0; f < unwrapping.frequencies; ++f) {
      candidate.periods.push_back(std::floor(found.turns[f] - turns[f] + 0.5));
    }
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const TofCandidate& a, const TofCandidate& b) { return a.misfit_rad < b.misfit_rad; });
  return candidates;
}

void copy_frequencies(const TofImages& images, const TofOptions& options, const TofEvidence& pixel,
                      std::size_t index, TofTrace& trace) {
  trace.frequencies_hz = options.frequencies_hz;
  for (std::size_t f = 0; f < images.frequencies; ++f) {
    trace.amplitude.push_back(pixel.amplitude[f]);
    trace.phase_rad.push_back(kTwoPi * pixel.turns[f]);
    std::vector<double> levels;
    for (std::size_t k = 0; k < images.taps; ++k) {
      levels.push_back(static_cast<double>(images.level[tap_offset(images, f, k) + index]));
    }
    trace.levels.push_back(std::move(levels));
  }
}

std::string frequency_line(const TofTrace& trace, std::size_t f) {
  std::string text = "  " + decimal_text(trace.frequencies_hz[f] * 1e-6, 3) + " MHz: raw";
  for (const double level : trace.levels[f]) text += " " + decimal_text(level, 1);
  return text + "; amplitude " + decimal_text(trace.amplitude[f]) + ", phase " +
         decimal_text(trace.phase_rad[f], 3) + " rad\n";
}

std::string candidate_line(const TofCandidate& candidate) {
  std::string text = "  range " + decimal_text(candidate.range_m, 3) + " m: misfit " +
                     decimal_text(candidate.misfit_rad, 3) + " rad, whole periods";
  for (const double period : candidate.periods) text += " " + decimal_text(period, 0);
  return text + "\n";
}

void require_pixel(const TofImages& images, std::array<std::uint32_t, 2> column_row) {
  const auto [column, row] = column_row;
  if (column < images.width && row < images.height) return;
  throw Error({"pixel to explain",
               std::to_string(column) + "," + std::to_string(row) + " is outside the image",
               "columns 0 to " + std::to_string(images.width - 1) + ", rows 0 to " +
                   std::to_string(images.height - 1),
               ""});
}

}  // namespace

TofTrace explain_tof(const TofImages& images, const TofOptions& options,
                     std::array<std::uint32_t, 2> column_row, const TofCalibration& calibration,
                     const TofRun& run) {
  const Decoding decoding = tof::decode(images, options, calibration, run.pool);
  require_pixel(images, column_row);
  const auto [column, row] = column_row;
  const std::size_t index = std::size_t{row} * images.width + column;
  const TofEvidence pixel =
      gather_evidence(decoding.phasors, decoding.unwrapping, options, calibration, index);
  const EdgeEvidence edge = gather_edge_evidence(decoding.depths, decoding.phasors, options, index);
  TofTrace trace{.column = column,
                 .row = row,
                 .status = decoding.measurement.status[index],
                 .range_m = pixel.unwrapped.range_m,
                 .depth_m = pixel.depth_m,
                 .misfit_rad = pixel.unwrapped.misfit_rad};
  copy_frequencies(images, options, pixel, index, trace);
  trace.candidates = list_candidates(decoding.unwrapping, pixel.turns);
  trace.tests = list_tests(pixel, edge, options);
  return trace;
}

std::string format_tof_trace(const TofTrace& trace) {
  constexpr std::size_t kShown = 3;
  std::string text = "pixel " + std::to_string(trace.column) + "," + std::to_string(trace.row) +
                     ": " + to_string(trace.status) + "\nrange " + decimal_text(trace.range_m, 4) +
                     " m, depth " + decimal_text(trace.depth_m, 4) + " m\n";
  for (std::size_t f = 0; f < trace.frequencies_hz.size(); ++f) text += frequency_line(trace, f);
  for (const TofTest& test : trace.tests) {
    text += std::string(test.has_passed ? "  passed  " : "  failed  ") + to_string(test.failure) +
            ": " + test.finding + "\n";
  }
  for (std::size_t i = 0; i < std::min(kShown, trace.candidates.size()); ++i) {
    text += candidate_line(trace.candidates[i]);
  }
  return text;
}

namespace {

constexpr std::uint32_t kSampleWidth = 160;
constexpr std::uint32_t kSampleHeight = 120;
constexpr double kFocal_px = 150.0;
constexpr double kDisc_m = 1.2;
constexpr double kWall_m = 3.0;
constexpr double kLitRadius_px = 92.0;
constexpr int kSubRays = 4;

/// What a ray meets: its depth and reflectance.
struct Surface {
  double depth_m;
  double reflectance;
};

bool is_within(double column, double row, double from, double to) {
  return column >= from && column < to && row >= 88.0 && row < 106.0;
}

/// At a position in pixels from the corner of the image.
Surface surface_at(double column, double row) {
  const double x = column - 0.5 * kSampleWidth;
  const double y = row - 0.5 * kSampleHeight;
  if (x * x + y * y < 900.0) return {kDisc_m, 0.7};
  const double depth_m = kWall_m / (1.0 - 0.8 * x / kFocal_px);
  if (is_within(column, row, 36.0, 60.0)) return {depth_m, 0.001};
  if (is_within(column, row, 84.0, 108.0)) return {depth_m, 100.0};
  return {depth_m, 0.5};
}

/// Range over depth at a position.
double range_per_depth(double column, double row) {
  const double x = (column - 0.5 * kSampleWidth) / kFocal_px;
  const double y = (row - 0.5 * kSampleHeight) / kFocal_px;
  return std::sqrt(1.0 + x * x + y * y);
}

TofCamera sample_camera() {
  TofCamera camera;
  camera.signal_electrons = 2e5;
  camera.ambient_electrons = 2e3;
  camera.contrast = {0.5, 0.7, 0.4};
  camera.read_noise_electrons = 50.0;
  camera.full_well_electrons = 4e5;
  camera.electrons_per_level = 100.0;
  camera.has_whole_levels = true;
  camera.decoder = kinect_v2_options();
  return camera;
}

using Steps = std::array<TofLight, 9>;

Steps light_at(const TofCamera& camera, const TofSteps& steps, std::uint32_t column,
               std::uint32_t row) {
  Steps light{};
  constexpr double kShare = 1.0 / (kSubRays * kSubRays);
  for (int i = 0; i < kSubRays * kSubRays; ++i) {
    const int across = i % kSubRays;
    const int down = i / kSubRays;
    const double u = column + (across + 0.5) / kSubRays;
    const double v = row + (down + 0.5) / kSubRays;
    const Surface surface = surface_at(u, v);
    const double range_m = surface.depth_m * range_per_depth(u, v);
    add_light(steps, range_m,
              kShare * camera.signal_electrons * surface.reflectance / (range_m * range_m), light);
    for (TofLight& step : light) {
      step.background += kShare * camera.ambient_electrons * surface.reflectance;
    }
  }
  return light;
}

void expose_pixel(const TofCamera& camera, const Steps& light, std::size_t pixel,
                  TofImages& images) {
  for (std::size_t step = 0; step < light.size(); ++step) {
    const RngKey key = {.seed = 2026,
                        .beam = static_cast<std::uint32_t>(pixel),
                        .block = static_cast<std::uint32_t>(step)};
    images.level[step * pixel_count(images) + pixel] =
        expose(camera, step / images.taps, light[step], key);
  }
}

}  // namespace

TofSample sample_tof_images() {
  const TofCamera camera = sample_camera();
  const TofSteps steps = make_tof_steps(camera);
  TofSample sample;
  sample.options = camera.decoder;
  sample.images = {kSampleWidth, kSampleHeight, 3, 3};
  sample.images.level.resize(std::size_t{9} * kSampleWidth * kSampleHeight);
  for (std::uint32_t row = 0; row < kSampleHeight; ++row) {
    for (std::uint32_t column = 0; column < kSampleWidth; ++column) {
      const std::size_t pixel = std::size_t{row} * kSampleWidth + column;
      expose_pixel(camera, light_at(camera, steps, column, row), pixel, sample.images);
      const double u = column + 0.5;
      const double v = row + 0.5;
      sample.depth_per_range.push_back(static_cast<float>(1.0 / range_per_depth(u, v)));
      const double from_centre = portable_hypot(u - 0.5 * kSampleWidth, v - 0.5 * kSampleHeight);
      sample.is_illuminated.push_back(from_centre < kLitRadius_px ? 1 : 0);
    }
  }
  return sample;
}

}  // namespace glidar
