// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/fog.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/weather_signal.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr std::size_t kLayers = 4096;
constexpr std::size_t kHardRanges = 256;

using Sums = FogProfile::Sums;

Sums weighted(const Sums& one, double a, const Sums& other, double b) {
  return {a * one.plain + b * other.plain, a * one.cosine + b * other.cosine,
          a * one.sine + b * other.sine};
}

/// Golden section search (Kiefer, Proc. AMS 4 (1953) 502).
template <class Function>
double peak_between(double low, double high, const Function& of) {
  constexpr int kSteps = 30;  // 1e-6 of the interval
  constexpr double kInverse = 1.0 / std::numbers::phi;
  for (int i = 0; i < kSteps; ++i) {
    const double part = kInverse * (high - low);
    if (of(high - part) < of(low + part)) {
      low = high - part;
    } else {
      high = low + part;
    }
  }
  return 0.5 * (low + high);
}

/// The maximum signal; its range refers to the start of the pulse.
SoftEcho peak_before(const FogProfile& profile, double hard_range_m) {
  constexpr double kPlacesPerPulse = 16.0;
  const double pulse_m = 1.0 / profile.turns_per_m;
  const double step_m = pulse_m / kPlacesPerPulse;
  const double end_m =
      profile.start_m + profile.step_m * static_cast<double>(profile.up_to.size() - 1);
  const double top_m = std::min(end_m, hard_range_m + pulse_m);
  const auto of = [&](double range_m) { return fog_signal(profile, range_m, hard_range_m); };
  double best_m = profile.start_m;
  double best = of(best_m);
  for (double range_m = profile.start_m; range_m < top_m; range_m += step_m) {
    const double signal = of(range_m);
    if (signal > best) best_m = range_m;
    best = std::max(best, signal);
  }
  best_m = peak_between(std::max(profile.start_m, best_m - step_m), best_m + step_m, of);
  return {best_m, of(best_m)};
}

}  // namespace

double pulse_length_m(double pulse_fwhm_s) {
  return kLight_m_per_s * pulse_fwhm_s;
}

Sums sums_to(const FogProfile& profile, double range_m) {
  const double last = static_cast<double>(profile.up_to.size() - 1);
  const double place = std::clamp((range_m - profile.start_m) / profile.step_m, 0.0, last);
  const auto k = std::min(static_cast<std::size_t>(place), profile.up_to.size() - 2);
  const double share = place - static_cast<double>(k);
  return weighted(profile.up_to[k], 1.0 - share, profile.up_to[k + 1], share);
}

double pulse_of(const Sums& part, const SineCosine& angle) {
  // sin^2 x = (1 - cos 2x) / 2, and the cosine of a difference
  return 0.5 * (part.plain - angle.cosine * part.cosine - angle.sine * part.sine);
}

FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr,
                       double pulse_fwhm_s) {
  // Beyond, the signal of a layer decreases, so the maximum is before the end of the pulse.
  const double bend_m = std::max(1.0, light.overlap.empty() ? 0.0 : light.overlap.back()[0]);
  return fog_profile(light, backscatter_per_m_sr, pulse_fwhm_s,
                     bend_m + pulse_length_m(pulse_fwhm_s));
}

FogProfile fog_profile(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       double end_m) {
  const double pulse_m = pulse_length_m(pulse_fwhm_s);
  const double start_m = min_visible_range_m(light);
  FogProfile profile{.start_m = start_m,
                     .step_m = (end_m - start_m) / static_cast<double>(kLayers),
                     .turns_per_m = 1.0 / pulse_m,
                     .up_to = {{}}};
  const double backscatter = std::numbers::pi * backscatter_per_m_sr;
  const auto at = [&](double place) {
    const double range_m = start_m + place * profile.step_m;
    const double w = weather_signal(light, backscatter, range_m);
    const SineCosine angle = sincos_turns(range_m * profile.turns_per_m);
    return Sums{w, w * angle.cosine, w * angle.sine};
  };
  Sums before = at(0.0);
  for (std::size_t i = 0; i < kLayers; ++i) {  // Simpson's rule
    const auto place = static_cast<double>(i);
    const Sums after = at(place + 1.0);
    const Sums both = weighted(before, 1.0, after, 1.0);
    const Sums layer = weighted(both, profile.step_m / 6.0, at(place + 0.5), profile.step_m / 1.5);
    profile.up_to.push_back(weighted(profile.up_to.back(), 1.0, layer, 1.0));
    before = after;
  }
  return profile;
}

double fog_signal(const FogProfile& profile, double range_m, double hard_range_m) {
  const double from_m = range_m - 1.0 / profile.turns_per_m;
  const double to_m = std::min(range_m, hard_range_m);
  if (!(to_m > std::max(from_m, profile.start_m))) return 0.0;
  const Sums part = weighted(sums_to(profile, to_m), 1.0, sums_to(profile, from_m), -1.0);
  return pulse_of(part, sincos_turns(range_m * profile.turns_per_m));
}

FogReturn fog_return(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s) {
  if (!(backscatter_per_m_sr > 0.0)) return {};
  const FogProfile profile = fog_profile(light, backscatter_per_m_sr, pulse_fwhm_s);
  const double half_pulse_m = 0.5 / profile.turns_per_m;
  // A target beyond the maximum of unbounded fog does not change it.
  const SoftEcho endless = peak_before(profile, std::numeric_limits<double>::infinity());
  FogReturn fog{.start_m = profile.start_m,
                .step_m = (endless.range_m - profile.start_m) / static_cast<double>(kHardRanges),
                .by_hard_range = {{profile.start_m, 0.0}}};
  for (std::size_t i = 1; i <= kHardRanges; ++i) {
    const double hard_range_m = fog.start_m + static_cast<double>(i) * fog.step_m;
    const SoftEcho peak = i < kHardRanges ? peak_before(profile, hard_range_m) : endless;
    fog.by_hard_range.push_back({peak.range_m - half_pulse_m, peak.signal});
  }
  return fog;
}

SoftEcho echo_before(const FogReturn& fog, double hard_range_m) {
  if (fog.by_hard_range.empty() || hard_range_m <= fog.start_m) return {};
  const double place = (hard_range_m - fog.start_m) / fog.step_m;
  if (!(place < static_cast<double>(fog.by_hard_range.size() - 1))) return fog.by_hard_range.back();
  const auto k = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(k);
  const SoftEcho& near = fog.by_hard_range[k];
  const SoftEcho& far = fog.by_hard_range[k + 1];
  return {near.range_m + share * (far.range_m - near.range_m),
          near.signal + share * (far.signal - near.signal)};
}

}  // namespace glidar
