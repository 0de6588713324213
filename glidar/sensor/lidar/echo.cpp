// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/echo.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/sensor/lidar/return_names.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

constexpr double kFwhmPerSigma = 2.3548200450309493;  // sqrt(8 ln 2)
constexpr double kReach =
    6.0;  // standard deviations; farther out a pulse is below 2e-8 of its peak
constexpr double kStep = 0.125;  // distance of the waveform's samples in standard deviations

/// Contributions [begin, end) of a beam, sorted by range unless all are near each other.
struct Group {
  std::size_t begin;
  std::size_t end;
};

constexpr double kSmall = 1.0 / 64.0;

/// exp(-y) from 0 to kSmall, by its series to y^4, whose next term is below 1e-11.
inline double slight_fading(double y) {
  return 1.0 - y * (1.0 - y * (1.0 / 2.0 - y * (1.0 / 6.0 - y * (1.0 / 24.0))));
}

/// exp(-y); 0 beyond kReach.
inline double strong_fading(double y) {
  return y < 0.5 * kReach * kReach ? portable_exp(-y) : 0.0;
}

/// exp(-y) for y >= 0. Most contributions of a footprint are near each other, where the series is
/// faster.
double fading(double y) {
  return y < kSmall ? slight_fading(y) : strong_fading(y);
}

/// The sum of the group's pulses, in samples at regular ranges.
class Waveform {
 public:
  Waveform(const WaveformBuffer& work, const Group& group, double sigma_m)
      : work_(work), group_(group), per_sigma_(1.0 / sigma_m), step_m_(kStep * sigma_m) {}

  /// The range of sample k; sample 0 is at the nearest contribution.
  [[nodiscard]] double sample_range_m(std::ptrdiff_t k) const {
    return work_.path[group_.begin].range_m + static_cast<double>(k) * step_m_;
  }

  /// The value of sample k, for increasing k from -1.
  double at(std::ptrdiff_t k) {
    if (k >= first_ + kPathsAtOnce) sample_from(k);
    return samples_[static_cast<std::size_t>(k - first_)];
  }

 private:
  static constexpr std::ptrdiff_t kPathsAtOnce = 16;

  void sample_from(std::ptrdiff_t k) {
    first_ = k;
    samples_.fill(0.0);
    std::array<double, kPathsAtOnce> sample_ranges_m;
    for (std::size_t j = 0; j < sample_ranges_m.size(); ++j) {
      sample_ranges_m[j] = sample_range_m(first_ + static_cast<std::ptrdiff_t>(j));
    }
    for (std::size_t i = group_.begin; i < group_.end; ++i) {
      const EchoContribution& path = work_.path[i];
      add_pulse(path.range_m, path.signal, per_sigma_, sample_ranges_m.data(), samples_.data());
    }
  }

  GLIDAR_SIMD static void add_pulse(double range_m, double signal, double per_sigma,
                                    const double* sample_ranges_m, double* samples) {
    for (std::ptrdiff_t j = 0; j < kPathsAtOnce; ++j) {
      const double x = (range_m - sample_ranges_m[j]) * per_sigma;
      const double y = 0.5 * x * x;
      const double slight = slight_fading(y);
      const double strong = strong_fading(y);
      samples[j] += signal * (y < kSmall ? slight : strong);
    }
  }

  const WaveformBuffer& work_;
  Group group_;
  double per_sigma_;
  double step_m_;
  std::ptrdiff_t first_ = -1 - kPathsAtOnce;
  std::array<double, kPathsAtOnce> samples_;
};

/// True if `a` is the stronger contribution, or equally strong and nearer.
bool is_stronger(const EchoContribution& a, const EchoContribution& b) {
  return a.signal > b.signal || (a.signal == b.signal && a.range_m < b.range_m);
}

/// Surfaces with less than this share of an echo's signal do not make it mixed: they move its range
/// by less than this share of the gap, which within one echo is at most a few pulse lengths, so by
/// about a millimetre.
constexpr double kMinMixedShare = 1e-3;

bool is_mixed(const WaveformBuffer& work, const Group& group) {
  const EchoContribution* strongest = nullptr;  // of a surface
  double sum = 0.0;
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const EchoContribution& path = work.path[i];
    if (path.source == kInvalidId) continue;
    sum += path.signal;
    if (strongest == nullptr || is_stronger(path, *strongest)) strongest = &path;
  }
  double others = 0.0;
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const EchoContribution& path = work.path[i];
    if (path.source != kInvalidId && path.surface != strongest->surface) others += path.signal;
  }
  return others > kMinMixedShare * sum;
}

/// The echo of a group: centroid, height of the waveform there, width and strongest contribution.
PulseEcho echo_of(const WaveformBuffer& work, const Group& group, double sigma_m) {
  const EchoContribution& first = work.path[group.begin];
  std::size_t strongest = group.begin;
  double sum = 0.0;
  double moment_m = 0.0;
  unsigned surface_bits = 0;  // that differ
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const EchoContribution& path = work.path[i];
    sum += path.signal;
    moment_m += path.signal * (path.range_m - first.range_m);
    surface_bits |= static_cast<unsigned>(path.surface ^ first.surface);
    if (is_stronger(path, work.path[strongest])) strongest = i;
  }
  const double range_m = first.range_m + (sum > 0.0 ? moment_m / sum : 0.0);
  const double fade = 0.5 / (sigma_m * sigma_m);
  double variance_m2 = 0.0;
  double signal = 0.0;
  for (std::size_t i = group.begin; i < group.end; ++i) {
    const double off_m = work.path[i].range_m - range_m;
    variance_m2 += work.path[i].signal * (off_m * off_m);
    signal += work.path[i].signal * fading(fade * (off_m * off_m));
  }
  return {.range_m = range_m,
          .signal = signal,
          .sigma_m = std::sqrt(sigma_m * sigma_m + (sum > 0.0 ? variance_m2 / sum : 0.0)),
          .strongest = static_cast<std::uint32_t>(strongest),
          .begin = static_cast<std::uint16_t>(group.begin),
          .end = static_cast<std::uint16_t>(group.end),
          .is_mixed = surface_bits != 0 && is_mixed(work, group)};
}

/// The height of a peak at the middle one of three samples, by the parabola through them.
double peak_height(double before, double at, double after) {
  const double bend = before - 2.0 * at + after;
  const double slope = 0.5 * (after - before);
  return bend < 0.0 ? at - 0.5 * slope * slope / bend : at;
}

/// Splits a wide group at the minima of its waveform.
void split(const Group& group, double sigma_m, WaveformBuffer& work) {
  const double extent_m = work.path[group.end - 1].range_m - work.path[group.begin].range_m;
  const auto samples = static_cast<std::ptrdiff_t>(std::ceil(extent_m / (kStep * sigma_m))) + 1;
  Waveform waveform(work, group, sigma_m);
  double before = waveform.at(-1);
  double at = waveform.at(0);
  double height = 0.0;
  bool rose = true;
  std::size_t from = group.begin;
  const auto close = [&](std::size_t to) {
    if (to == from) return;
    PulseEcho echo = echo_of(work, {from, to}, sigma_m);
    echo.signal = height;
    work.echo[work.echoes++] = echo;
    from = to;
    height = 0.0;
  };
  for (std::ptrdiff_t k = 0; k < samples; ++k) {
    const double after = waveform.at(k + 1);
    if (at >= before && at > after) {
      height = std::max(height, peak_height(before, at, after));
      rose = false;
    } else if (!rose && at <= before && at < after) {
      const double valley_m = waveform.sample_range_m(k);
      std::size_t to = from;
      while (to < group.end && work.path[to].range_m < valley_m) ++to;
      close(to);
      rose = true;
    }
    before = at;
    at = after;
  }
  close(group.end);
}

/// Pulses within one standard deviation of each other have one peak, at their mean up to the third
/// order.
void merge_all(const Group& group, double sigma_m, WaveformBuffer& work) {
  work.echo[work.echoes++] = echo_of(work, group, sigma_m);
}

/// Splits the contributions where the next one is beyond reach, and finds the echoes of each group.
void find_in_group(const Group& group, double sigma_m, WaveformBuffer& work) {
  if (work.path[group.end - 1].range_m - work.path[group.begin].range_m > sigma_m) {
    split(group, sigma_m, work);
  } else {
    merge_all(group, sigma_m, work);
  }
}

/// The distance between the nearest and the farthest contribution, metres.
double extent_m(const WaveformBuffer& work) {
  double nearest_m = work.path[0].range_m;
  double farthest_m = nearest_m;
  for (std::size_t i = 1; i < work.paths; ++i) {
    nearest_m = std::min(nearest_m, work.path[i].range_m);
    farthest_m = std::max(farthest_m, work.path[i].range_m);
  }
  return farthest_m - nearest_m;
}

/// The index of the echo that a return selects; -1: none.
int find_return(const Return& wanted, std::span<const PulseEcho> echoes,
                const std::array<std::uint16_t, WaveformBuffer::kMax>& by_strength) {
  if (wanted.rank >= echoes.size()) return -1;
  const auto last = static_cast<int>(echoes.size()) - 1;
  const auto rank = static_cast<int>(wanted.rank);
  switch (wanted.order) {
    case Return::Order::nearest:
      return rank;
    case Return::Order::farthest:
      return last - rank;
    case Return::Order::strongest:
      return by_strength[wanted.rank];
  }
  return -1;
}

/// Returns by name, or how many of the nearest.
void visit_returns(FieldVisitor& visitor, std::vector<Return>& returns) {
  std::vector<std::string> names;
  for (const Return& one : returns) names.push_back(return_name(one));
  const auto max_size = static_cast<std::uint32_t>(kMaxReturns);
  const auto size = static_cast<std::uint32_t>(returns.size());
  std::uint32_t count = visitor.is_document() && are_nearest(returns) ? size : 0;
  visitor.words_or_count(
      {"returns", "reported returns, or N for the N nearest echoes; `--returns` overrides it"},
      known_return_names(), max_size, names, count);
  if (!visitor.is_reading()) return;
  if (count > 0) {
    returns = nearest_returns(count);
    return;
  }
  returns.clear();
  for (const std::string& name : names) returns.push_back(return_named(name));
}

}  // namespace

void validate(const Receiver& receiver) {
  require_number(receiver.pulse_fwhm_s > 0.0 && receiver.pulse_fwhm_s <= 1e-3,
                 "receiver, pulse_fwhm_s", receiver.pulse_fwhm_s, "seconds above 0, up to 1e-3");
  require_number(
      receiver.min_return_separation_m >= 0.0 && std::isfinite(receiver.min_return_separation_m),
      "receiver, min_return_separation_m", receiver.min_return_separation_m, "metres from 0");
  require_number(!receiver.returns.empty() && receiver.returns.size() <= kMaxReturns,
                 "receiver, returns", static_cast<double>(receiver.returns.size()),
                 "1 to 16 of them");
}

double pulse_sigma_m(const Receiver& receiver) {
  return kHalfLight_m_per_s * receiver.pulse_fwhm_s / kFwhmPerSigma;
}

void WaveformBuffer::replace_weakest(const EchoContribution& one) {
  const auto weakest = std::min_element(
      path.begin(), path.end(),
      [](const EchoContribution& a, const EchoContribution& b) { return a.signal < b.signal; });
  if (weakest->signal < one.signal) *weakest = one;
}

void detect_peaks(double sigma_m, double near_m, WaveformBuffer& work) {
  work.echoes = 0;
  if (work.paths == 0) return;
  if (extent_m(work) <= std::min(sigma_m, near_m)) {  // most beams; no sorting needed
    merge_all({0, work.paths}, sigma_m, work);
    return;
  }
  std::sort(work.path.begin(), work.path.begin() + static_cast<std::ptrdiff_t>(work.paths),
            [](const EchoContribution& a, const EchoContribution& b) {
              return a.range_m != b.range_m ? a.range_m < b.range_m : a.source < b.source;
            });
  for (std::size_t begin = 0, end = 0; begin < work.paths; begin = end) {
    end = begin + 1;
    while (end < work.paths &&
           work.path[end].range_m - work.path[end - 1].range_m < kReach * sigma_m) {
      ++end;
    }
    find_in_group({begin, end}, sigma_m, work);
  }
}

void enforce_min_separation(double min_return_separation_m, WaveformBuffer& work) {
  if (!(min_return_separation_m > 0.0) || work.echoes < 2) return;
  std::array<bool, WaveformBuffer::kMax> hidden;
  std::fill_n(hidden.begin(), work.echoes, false);
  for (std::size_t i = 0; i < work.echoes; ++i) {
    for (std::size_t j = 0; j < work.echoes; ++j) {
      const bool is_near =
          std::abs(work.echo[i].range_m - work.echo[j].range_m) < min_return_separation_m;
      if (is_near && work.echo[j].signal > work.echo[i].signal) hidden[i] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < work.echoes; ++i) {
    if (!hidden[i]) work.echo[kept++] = work.echo[i];
  }
  work.echoes = kept;
}

double reported_range_m(const Receiver& receiver, const PulseEcho& echo) {
  if (receiver.timing == Receiver::Timing::centroid || echo.signal <= 1.0) return echo.range_m;
  return echo.range_m - echo.sigma_m * std::sqrt(2.0 * portable_log(echo.signal));
}

void select_returns(const Receiver& receiver, std::span<const PulseEcho> echoes,
                    std::array<int, kMaxReturns>& chosen) {
  const std::size_t count = receiver.returns.size();
  if (echoes.empty()) {
    std::fill_n(chosen.begin(), count, -1);
    return;
  }
  std::array<std::uint16_t, WaveformBuffer::kMax> by_strength;
  for (std::size_t i = 0; i < echoes.size(); ++i) by_strength[i] = static_cast<std::uint16_t>(i);
  std::sort(by_strength.begin(), by_strength.begin() + static_cast<std::ptrdiff_t>(echoes.size()),
            [&](auto a, auto b) {
              return echoes[a].signal != echoes[b].signal ? echoes[a].signal > echoes[b].signal
                                                          : a < b;
            });
  const auto is_reported = [&](int index, std::size_t before) {
    return std::find(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(before), index) !=
           chosen.begin() + static_cast<std::ptrdiff_t>(before);
  };
  const auto strongest_unreported = [&](std::size_t before) {
    const auto end = by_strength.begin() + static_cast<std::ptrdiff_t>(echoes.size());
    const auto found = std::find_if(by_strength.begin(), end,
                                    [&](int echo) { return !is_reported(echo, before); });
    return found == end ? -1 : static_cast<int>(*found);
  };
  for (std::size_t r = 0; r < count; ++r) {
    int index = find_return(receiver.returns[r], echoes, by_strength);
    if (index >= 0 && is_reported(index, r)) index = strongest_unreported(r);
    chosen[r] = index;
  }
}

void describe(Receiver& receiver, FieldVisitor& visitor) {
  using Timing = Receiver::Timing;
  constexpr std::array<Named<Timing>, 2> kNames = {
      {{"centroid", Timing::centroid}, {"leading_edge", Timing::leading_edge}}};
  visitor.number({"pulse_ns", "full width of the pulse at half maximum", kUnitNanosecond},
                 {0.0, 1e6, true, "nanoseconds above 0, up to 1e6"}, receiver.pulse_fwhm_s);
  visit_choice(visitor, {"timing", "how an echo is timed"}, kNames, receiver.timing);
  visitor.number({"min_return_separation_m",
                  "an echo closer than this to a stronger one is not reported", kUnitMetre},
                 {0.0, 1e6, false, "metres from 0 to 1e6"}, receiver.min_return_separation_m);
  visit_returns(visitor, receiver.returns);
  if (visitor.is_reading()) validate(receiver);
}

}  // namespace glidar
