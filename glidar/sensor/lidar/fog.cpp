// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/fog.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>

#include <algorithm>
#include <cmath>
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

namespace {

using Sums = FogProfile::Sums;

/// The range beyond which the signal of a layer decreases.
double bend_m(const LidarEquation& light) {
  return std::max(1.0, light.overlap.empty() ? 0.0 : light.overlap.back()[0]);
}

/// The range beyond which fog is so faint that it almost never has the largest echo.
double farthest_m(const LidarEquation& light, double step_m) {
  constexpr double kMinShare = 1.0 / 200.0;
  constexpr double kGrowth = 1.1;
  constexpr double kFarthest = 64.0;  // times the bend, for signals that hardly decrease with range
  double brightest = 0.0;
  for (double range_m = min_visible_range_m(light); range_m < bend_m(light) + step_m;
       range_m += step_m) {
    brightest = std::max(brightest, weather_signal(light, 1.0, range_m));
  }
  double range_m = bend_m(light);
  while (range_m < kFarthest * bend_m(light) &&
         weather_signal(light, 1.0, range_m) > kMinShare * brightest) {
    range_m *= kGrowth;
  }
  return range_m;
}

/// The sequence of uniform numbers of a key.
class Uniforms {
 public:
  explicit Uniforms(const RngKey& key) : key_(key) { key_.purpose = Purpose::fog; }

  double next() {
    const std::uint32_t word = count_ % 4U;
    key_.block = count_ / 4U;
    if (word == 0) words_ = random_words(key_);
    ++count_;
    return uniform(words_[word]);
  }

 private:
  RngKey key_;
  std::uint32_t count_ = 0;
  RandomWords words_{};
};

/// Erlang distribution: the mean of exponential numbers.
double gamma_factor(unsigned looks, Uniforms& uniforms) {
  double sum = 0.0;
  for (unsigned i = 0; i < looks; ++i) sum -= portable_log(uniforms.next());
  return sum / looks;
}

Sums added(const Sums& to, double factor, const Sums& from, const Sums& up_to) {
  return {to.plain + factor * (up_to.plain - from.plain),
          to.cosine + factor * (up_to.cosine - from.cosine),
          to.sine + factor * (up_to.sine - from.sine)};
}

/// Iterates over the cells of a beam.
class FogCells {
 public:
  FogCells(const VaryingFog& fog, const RngKey& key)
      : fog_(fog),
        uniforms_(key),
        from_m_(fog.profile.start_m + (uniforms_.next() - 1.0) * fog.cell_m) {}

  [[nodiscard]] double next_from_m() const { return from_m_; }

  FogCell next() {
    const FogCell cell{std::max(from_m_, fog_.profile.start_m),
                       gamma_factor(fog_.looks, uniforms_)};
    from_m_ += fog_.cell_m;
    return cell;
  }

 private:
  const VaryingFog& fog_;
  Uniforms uniforms_;
  double from_m_;
};

/// Integrates the fog of a beam node by node.
class Integral {
 public:
  Integral(const VaryingFog& fog, double end_m, const RngKey& key)
      : fog_(fog), cells_(fog, key), end_m_(end_m), cell_(cells_.next()), next_(following()) {}

  /// The integral up to a node, which must not decrease between calls.
  Sums to(std::size_t node) {
    const double range_m = fog_.profile.start_m + static_cast<double>(node) * step_m();
    while (next_.from_m <= range_m) {
      const Sums border = sums_to(fog_.profile, next_.from_m);
      before_ = added(before_, cell_.factor, border_, border);
      border_ = border;
      cell_ = next_;
      next_ = following();
    }
    const Sums& here = fog_.nodes[std::min(node, fog_.nodes.size() - 1)];
    return added(before_, cell_.factor, border_, here);
  }

  [[nodiscard]] double step_m() const {
    return 1.0 / (fog_.profile.turns_per_m * VaryingFog::kNodesPerPulse);
  }

 private:
  /// The cell after cell_; there is no fog beyond end_m.
  FogCell following() {
    if (cells_.next_from_m() < end_m_) return cells_.next();
    const bool has_ended = cell_.from_m >= end_m_;
    return {has_ended ? std::numeric_limits<double>::infinity() : end_m_, 0.0};
  }

  const VaryingFog& fog_;
  FogCells cells_;
  double end_m_;
  FogCell cell_;
  FogCell next_;
  Sums before_{};  ///< integrals before the cell
  Sums border_{};  ///< integrals of the profile at the start of the cell
};

}  // namespace

VaryingFog varying_fog(const LidarEquation& light, double backscatter_per_m_sr, double pulse_fwhm_s,
                       unsigned looks) {
  VaryingFog fog{.looks = looks};
  if (!(backscatter_per_m_sr > 0.0)) return fog;
  const double pulse_m = pulse_length_m(pulse_fwhm_s);
  const double step_m = pulse_m / VaryingFog::kNodesPerPulse;
  fog.cell_m = 0.5 * pulse_m;
  fog.end_m = farthest_m(light, step_m);
  fog.profile = fog_profile(light, backscatter_per_m_sr, pulse_fwhm_s, fog.end_m);
  const double length_m = fog.end_m - fog.profile.start_m;
  // each four have a block of random words, of 2^24
  const double numbers = (length_m / fog.cell_m + 2.0) * looks;
  require_number(numbers <= 6e7, "weather, random numbers of the fog in a beam", numbers,
                 "6e7; decrease fog_looks, or use 0");
  const auto count = static_cast<std::size_t>(std::ceil(length_m / step_m)) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    fog.nodes.push_back(
        sums_to(fog.profile, fog.profile.start_m + static_cast<double>(i) * step_m));
  }
  for (std::size_t i = 0; i < VaryingFog::kNodesPerPulse; ++i) {
    fog.angles[i] = sincos_turns(fog.profile.start_m * fog.profile.turns_per_m +
                                 static_cast<double>(i) / VaryingFog::kNodesPerPulse);
  }
  return fog;
}

void sample_fog_cells(const VaryingFog& fog, double end_m, RngKey key,
                      std::vector<FogCell>& cells) {
  cells.clear();
  FogCells source(fog, key);
  while (source.next_from_m() < std::min(end_m, fog.end_m)) cells.push_back(source.next());
}

SoftEcho echo_before(const VaryingFog& fog, double hard_range_m, const RngKey& key) {
  const double start_m = fog.profile.start_m;
  const double end_m = std::min(hard_range_m, fog.end_m);
  if (fog.nodes.empty() || !(end_m > start_m)) return {};
  Integral integral(fog, end_m, key);
  constexpr std::size_t kPulse = VaryingFog::kNodesPerPulse;
  std::array<Sums, kPulse> past{};  // integrals one pulse length earlier
  const auto last = static_cast<std::size_t>((end_m - start_m) / integral.step_m()) + kPulse + 2;
  std::array<double, 3> signal{};  // at the last nodes
  SoftEcho best;
  for (std::size_t node = 0; node <= last; ++node) {
    const Sums now = integral.to(node);
    const Sums part = added(now, -1.0, {}, past[node % kPulse]);
    past[node % kPulse] = now;
    signal = {signal[1], signal[2], pulse_of(part, fog.angles[node % kPulse])};
    const double bend = signal[0] - 2.0 * signal[1] + signal[2];
    if (signal[1] <= best.signal || signal[1] < signal[2] || !(bend < 0.0)) continue;
    const double slope = 0.5 * (signal[2] - signal[0]);
    const double peak = static_cast<double>(node) - 1.0 - slope / bend;
    best = {start_m + peak * integral.step_m(), signal[1] - 0.5 * slope * slope / bend};
  }
  // From the start of the pulse to its middle; all fog is between start and end.
  best.range_m = std::clamp(best.range_m - fog.cell_m, start_m, end_m);
  return best;
}

}  // namespace glidar
