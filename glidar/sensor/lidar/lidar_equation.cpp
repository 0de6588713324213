// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/portable.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/lidar/surface_reflectance.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidar {
namespace {

/// exp(-2 alpha R).
double two_way(double extinction_per_m, double range_m) {
  const double depth = -2.0 * extinction_per_m * range_m;
  return portable_exp(std::clamp(depth, -600.0, 600.0));  // 0 or infinite beyond
}

double incidence_rad(double cosine) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return 2.0 * std::numbers::pi * atan2_turns(sine, cosine);
}

double relative(const Lambert& /*surface*/, double cosine) {
  return cosine;
}

double relative(const PhongLike& s, double cosine) {
  const double lobe =
      portable_pow(std::abs(2.0 * cosine * cosine - 1.0), s.exponent);  // cos 2 theta
  return (1.0 - s.specular_fraction) * cosine + s.specular_fraction * lobe;
}

double relative(const OrenNayar& s, double cosine) {
  const double s2 = s.roughness_rad * s.roughness_rad;
  const double a = 1.0 - 0.5 * s2 / (s2 + 0.33);
  const double b = 0.45 * s2 / (s2 + 0.09);
  return a * cosine + b * (1.0 - cosine * cosine);
}

double relative(const RetroReflector& s, double cosine) {
  const double x = incidence_rad(cosine) / s.width_rad;
  return s.gain * portable_exp(-x * x);
}

double relative(const Glossy& s, double cosine) {
  const double x = incidence_rad(cosine) / s.width_rad;
  return s.diffuse_fraction * cosine + s.lobe_gain * portable_exp(-0.5 * x * x);
}

/// Backscatter of a hit.
double backscatter_of(SurfaceReflectance& surfaces, const Hits& hits, std::size_t beam) {
  const HitSurface surface = surfaces.at(hits, beam);
  const double cosine = std::clamp<double>(hits.cos_shading[beam], 0.0, 1.0);
  return backscatter(*surface.brdf, surface.reflectance, cosine);
}

/// Backscatter of the hits [range.begin, range.end), 0 for a miss.
void collect_sent(const Scene& scene, double wavelength_m, const Hits& hits, BeamRange range,
                  std::span<double> sent) {
  SurfaceReflectance surfaces(scene, wavelength_m);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const bool is_miss = hits.instance[i] == kInvalidId;
    sent[i - range.begin] = is_miss ? 0.0 : backscatter_of(surfaces, hits, i);
  }
}

/// received_signal() for the exponent 2 in clear air without overlap.
GLIDAR_SIMD void apply_inverse_square_law(const LidarEquation& light, const double* range_m,
                                          std::size_t count, double* signals) {
  for (std::size_t i = 0; i < count; ++i) {
    const double ratio = light.reference_range_m / range_m[i];
    const double signal = signals[i] / light.reference_reflectance * (ratio * ratio);
    signals[i] = signals[i] > 0.0 ? signal : 0.0;  // a miss has no range
  }
}

/// received_signal() for any exponent in clear air without overlap.
GLIDAR_SIMD void apply_power_law(const LidarEquation& light, const double* range_m,
                                 std::size_t count, double* signals) {
  for (std::size_t i = 0; i < count; ++i) {
    const double range = signals[i] > 0.0 ? range_m[i] : 1.0;  // a miss has no range
    const double falloff = portable_pow(light.reference_range_m / range, light.range_exponent);
    const double signal = signals[i] / light.reference_reflectance * falloff;
    signals[i] = signals[i] > 0.0 ? signal : 0.0;
  }
}

/// True if the signal depends on the range only by its power law.
bool is_power_law_only(const LidarEquation& light) {
  return light.overlap.empty() && light.extinction_per_m == 0.0 &&
         light.weather_extinction_per_m == 0.0;
}

/// received_signal() through weather of another extinction.
double signal_through(double weather_per_m, const LidarEquation& light, double backscatter,
                      double range_m) {
  const double ratio = light.reference_range_m / range_m;
  const double falloff =
      light.range_exponent == 2.0 ? ratio * ratio : portable_pow(ratio, light.range_exponent);
  double signal = backscatter / light.reference_reflectance * falloff;
  if (light.extinction_per_m > 0.0)
    signal *= two_way(light.extinction_per_m, range_m - light.reference_range_m);
  if (weather_per_m > 0.0) signal *= two_way(weather_per_m, range_m);
  return light.overlap.empty() ? signal : signal * relative_overlap(light, range_m);
}

/// See kMinSignalToNoise; signals above the threshold are always detected.
bool is_lost_in_noise(const LidarEquation& light, double signal) {
  return signal < std::min(kMinSignalToNoise * light.noise_sigma, 1.0);
}

/// `received` is the signal over the threshold of the channel.
void measure_hit(const LidarEquation& light, double received, double threshold, std::size_t beam,
                 Frame& frame) {
  frame.intensity[beam] = static_cast<float>(received * threshold);
  if (received < 1.0) {
    invalidate_return(frame, beam,
                      classify_weak_return(light, received, frame.ground_truth.range_m[beam]));
  }
  if (light.saturation > 0.0 && received >= light.saturation)
    invalidate_return(frame, beam, Status::saturated);
}

constexpr std::size_t kMaxChannelRanges = 4096;
constexpr NumberRule kEquationRange = {0.0, 1e9, true, "metres above 0, up to 1e9"};

/// The noise by the range at which a data sheet promises a detection of 90 %.
void visit_range90(FieldVisitor& visitor, LidarEquation& light) {
  if (visitor.is_writing()) return;
  visitor.at_most_one({{"noise_sigma", "range90_m"}, "one of range90_m, noise_sigma"});
  double range90_m = 0.0;
  visitor.number({"range90_m",
                  "instead of `noise_sigma`: range at which the data sheet specifies 90 % "
                  "detection, below `reference_range_m`",
                  kUnitMetre, false, ""},
                 kEquationRange, range90_m);
  if (!visitor.has("range90_m")) return;
  if (range90_m >= light.reference_range_m) {
    visitor.reject("range90_m", "{}, not below the reference range",
                   "metres below reference_range_m, which is seen with probability 1/2");
  }
  if (visitor.is_reading())
    light.noise_sigma = noise_sigma_of(light.reference_range_m, range90_m, light.range_exponent);
}

}  // namespace

void validate(const LidarEquation& light) {
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  const auto from_zero = [](double x) { return x >= 0.0 && std::isfinite(x); };
  require_number(positive(light.reference_reflectance), "lidar_equation, reference_reflectance",
                 light.reference_reflectance, "above 0");
  require_number(positive(light.reference_range_m), "lidar_equation, reference_range_m",
                 light.reference_range_m, "metres above 0");
  require_number(from_zero(light.range_exponent), "lidar_equation, range_exponent",
                 light.range_exponent, "0 or above");
  require_number(from_zero(light.extinction_per_m), "lidar_equation, extinction_per_m",
                 light.extinction_per_m, "0 or above");
  require_number(from_zero(light.weather_extinction_per_m),
                 "lidar_equation, weather_extinction_per_m", light.weather_extinction_per_m,
                 "0 or above");
  require_number(from_zero(light.noise_sigma), "lidar_equation, noise_sigma", light.noise_sigma,
                 "0 or above");
  require_number(from_zero(light.saturation), "lidar_equation, saturation", light.saturation,
                 "0 or above");
  for (std::size_t i = 0; i < light.overlap.size(); ++i) {
    const auto [range_m, share] = light.overlap[i];
    require_number(from_zero(range_m) && (i == 0 || range_m > light.overlap[i - 1][0]),
                   "lidar_equation, overlap", range_m, "ranges that rise from 0 or above");
    require_number(from_zero(share), "lidar_equation, overlap", share, "shares of 0 or above");
  }
  for (const double range_m : light.channel_range_m) {
    require_number(positive(range_m), "lidar_equation, channel_range_m", range_m, "metres above 0");
    require_number(interpolate(light.overlap, range_m, 1.0) > 0.0, "lidar_equation, overlap", 0.0,
                   "a share above 0 at the range of each channel");
  }
  require_number(interpolate(light.overlap, light.reference_range_m, 1.0) > 0.0,
                 "lidar_equation, overlap", 0.0, "a share above 0 at the reference range");
}

double backscatter(const Brdf& surface, double reflectance, double cosine) {
  return reflectance * std::visit([&](const auto& s) { return relative(s, cosine); }, surface);
}

double reflectance_at(const Material& material, double wavelength_m) {
  return interpolate(material.spectrum, wavelength_m, luminance(material.diffuse));
}

double relative_overlap(const LidarEquation& light, double range_m) {
  return interpolate(light.overlap, range_m, 1.0) /
         interpolate(light.overlap, light.reference_range_m, 1.0);
}

double received_signal(const LidarEquation& light, double backscatter, double range_m) {
  return signal_through(light.weather_extinction_per_m, light, backscatter, range_m);
}

double backscatter_at(const Scene& scene, double wavelength_m, const Hits& hits, std::size_t beam) {
  SurfaceReflectance surfaces(scene, wavelength_m);
  return backscatter_of(surfaces, hits, beam);
}

void received_signals(const LidarEquation& light, const Scene& scene, double wavelength_m,
                      const Hits& hits, BeamRange range, std::span<double> signals) {
  collect_sent(scene, wavelength_m, hits, range, signals);
  const double* range_m = &hits.range_m[range.begin];
  const std::size_t count = range.end - range.begin;
  if (is_power_law_only(light)) {
    const auto apply_law = light.range_exponent == 2.0 ? apply_inverse_square_law : apply_power_law;
    apply_law(light, range_m, count, signals.data());
    return;
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (signals[k] > 0.0) signals[k] = received_signal(light, signals[k], range_m[k]);
  }
}

double channel_threshold(const LidarEquation& light, std::uint16_t ring) {
  if (light.channel_range_m.empty()) return 1.0;
  const double range_m = light.channel_range_m.at(ring);
  return signal_through(0.0, light, light.reference_reflectance, range_m);
}

double channel_threshold(const LidarEquation& light, std::span<const std::uint16_t> rings,
                         std::size_t beam) {
  return channel_threshold(light, rings.empty() ? std::uint16_t{0} : rings[beam]);
}

Status classify_weak_return(const LidarEquation& light, double signal, double range_m) {
  if (!(light.weather_extinction_per_m > 0.0)) return Status::below_threshold;
  const double clear = signal / two_way(light.weather_extinction_per_m, range_m);
  return clear < 1.0 ? Status::below_threshold : Status::weather;
}

double with_noise(const LidarEquation& light, double signal, double normal) {
  return is_lost_in_noise(light, signal) ? signal : signal + light.noise_sigma * normal;
}

double detection_probability(const LidarEquation& light, double signal) {
  if (is_lost_in_noise(light, signal)) return 0.0;
  if (light.noise_sigma == 0.0) return signal >= 1.0 ? 1.0 : 0.0;
  return 0.5 * portable_erfc((1.0 - signal) / (light.noise_sigma * std::numbers::sqrt2));
}

double noise_sigma_of(double range50_m, double range90_m, double exponent) {
  constexpr double kNormalQuantile90 = 1.2815515655446004;  // Phi of it is 0.9
  return (portable_pow(range50_m / range90_m, exponent) - 1.0) / kNormalQuantile90;
}

double range_exponent(double reflectance_a, double range_a_m, double reflectance_b,
                      double range_b_m) {
  return portable_log(reflectance_a / reflectance_b) / portable_log(range_a_m / range_b_m);
}

void shade_lidar(const LidarEquation& light, const Scene& scene, double wavelength_m,
                 std::span<const std::uint16_t> rings, BeamRange range, Frame& frame) {
  Batch<double> noise{};
  Batch<double> signals;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::size_t k = (i - range.begin) % kSampleBatch;
    if (k == 0) {
      const BeamRange batch{i, std::min(i + kSampleBatch, range.end)};
      received_signals(light, scene, wavelength_m, frame.ground_truth, batch, signals);
      if (light.noise_sigma > 0.0) sample_normals(rng_key(frame, Purpose::detection, i), noise);
    }
    if (frame.status[i] == Status::hit) {
      const double threshold = channel_threshold(light, rings, i);
      const double received = with_noise(light, signals[k] / threshold, noise[k]);
      measure_hit(light, received, threshold, i, frame);
    } else {
      frame.intensity[i] = 0.0F;
    }
  }
}

void describe(LidarEquation& light, FieldVisitor& visitor) {
  constexpr NumberRule kReflectance = {0.0, 1000.0, true, "a number above 0, up to 1000"};
  constexpr NumberRule kOverlapRange = {0.0, 1e9, false, "metres from 0 to 1e9"};
  constexpr NumberRule kExponent = {0.0, 16.0, false, "a number from 0 to 16"};
  visitor.number({"reference_reflectance", "rho_ref", kNoUnit, kRequired}, kReflectance,
                 light.reference_reflectance);
  visitor.number(
      {"reference_range_m",
       "R_ref: range at which a surface of that reflectance is detected with probability 1/2",
       kUnitMetre, kRequired},
      kEquationRange, light.reference_range_m);
  visitor.numbers({"channel_range_m",
                   "reference range of each channel, by its number in clouds, where they differ",
                   kUnitMetre, false, "`reference_range_m` for all"},
                  {.number = kEquationRange, .min_size = 0, .max_size = kMaxChannelRanges},
                  light.channel_range_m);
  visitor.number({"range_exponent", "q"}, kExponent, light.range_exponent);
  visitor.table({"overlap", "O: pairs `[range, O]`, linear between them, constant outside",
                 kUnitMetre, false, "1 everywhere"},
                kOverlapRange, kFromZero, light.overlap);
  visitor.number({"extinction_per_m", "alpha"}, kFromZero, light.extinction_per_m);
  visit_range90(visitor, light);
  visitor.number({"noise_sigma", "standard deviation of the signal"}, kFromZero, light.noise_sigma);
  visitor.number(
      {"saturation", "signals at or above this value are reported as \"saturated\"; 0: none"},
      kFromZero, light.saturation);
  if (visitor.is_reading()) validate(light);
}

}  // namespace glidar
