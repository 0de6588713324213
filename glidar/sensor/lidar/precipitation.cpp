// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/precipitation.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/lidar/weather_echoes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr double kPerMillimetre = 1e3;  // in 1/m

/// Fresnel reflectance at normal incidence.
constexpr double reflectance(double index) {
  return (index - 1.0) / (index + 1.0) * (index - 1.0) / (index + 1.0);
}

constexpr double kWater = reflectance(1.328);
constexpr double kIce = reflectance(1.3031);

}  // namespace

DropSizes rain_sizes(double mm_per_h) {
  return {.number_per_m4 = 8000.0 * kPerMillimetre,
          .slope_per_m = 4.1 * kPerMillimetre * portable_pow(mm_per_h, -0.21),
          .reflectance = kWater};
}

DropSizes snow_sizes(double mm_per_h, Weather::SnowModel model) {
  if (model == Weather::SnowModel::gunn_marshall) {
    return {.number_per_m4 = 7600.0 * kPerMillimetre * portable_pow(mm_per_h, -0.87),
            .slope_per_m = 2.55 * kPerMillimetre * portable_pow(mm_per_h, -0.48),
            .reflectance = kIce};
  }
  return {.number_per_m4 = 2500.0 * kPerMillimetre * portable_pow(mm_per_h, -0.94),
          .slope_per_m = 2.29 * kPerMillimetre * portable_pow(mm_per_h, -0.45),
          .reflectance = kIce};
}

double drops_per_m3(const DropSizes& sizes, double min_diameter_m) {
  const double depth = sizes.slope_per_m * min_diameter_m;
  constexpr double kNoDrops = 600.0;  // e^-600
  return depth < kNoDrops ? sizes.number_per_m4 / sizes.slope_per_m * portable_exp(-depth) : 0.0;
}

double geometric_extinction_per_m(const DropSizes& sizes) {
  const double slope = sizes.slope_per_m;
  return std::numbers::pi * sizes.number_per_m4 / (slope * slope * slope);
}

namespace {

constexpr double kFarthest_m = 1e4;
constexpr double kMaxDrops = 1e6;  // of a beam; each has a block of random words, of 2^23

/// The starts of the shells: 5 % apart, and at every node of the overlap table.
std::vector<double> shell_edges_m(const LidarEquation& light) {
  constexpr double kGrowth = 1.05;
  const double nearest_m = min_visible_range_m(light);
  std::vector<double> edges = {1.0};  // Hahner's crossover ends there
  for (const auto& [range_m, share] : light.overlap) edges.push_back(range_m);
  for (double edge = nearest_m; edge < kFarthest_m; edge *= kGrowth) edges.push_back(edge);
  edges.push_back(kFarthest_m);
  std::erase_if(edges, [&](double x) { return x < nearest_m || x > kFarthest_m; });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// An upper bound of the signal of a white surface in a shell: without overlap it decreases with
/// the range, and the overlap and Hahner's crossover are linear within a shell, the latter
/// increasing.
double brightest(const LidarEquation& light, const LidarEquation& without_overlap, double from_m,
                 double to_m) {
  const double overlap = std::max(relative_overlap(light, from_m), relative_overlap(light, to_m));
  return overlap * crossover(light, to_m) * received_signal(without_overlap, 1.0, from_m);
}

/// The diameter of the smallest drop that can reach the minimum signal; infinite if none can.
double min_diameter_m(const DropField& field, double brightest, double range_m) {
  const double share = field.min_signal / (field.sizes.reflectance * brightest);
  if (!(share <= 1.0)) return std::numeric_limits<double>::infinity();
  return std::max(kMinDrop_m, beam_diameter_m(field.beam, range_m) * std::sqrt(share));
}

const DropShell& shell_of(const DropField& field, double mean) {
  const auto after = std::upper_bound(
      field.shells.begin() + 1, field.shells.end(), mean,
      [](double value, const DropShell& shell) { return value < shell.mean_before; });
  return *(after - 1);
}

/// The expected number of drops up to a range.
double mean_to(const DropField& field, double range_m) {
  if (!(range_m > field.shells.front().from_m)) return 0.0;
  const auto after =
      std::upper_bound(field.shells.begin(), field.shells.end(), range_m,
                       [](double value, const DropShell& shell) { return value < shell.from_m; });
  const DropShell& shell = *(after - 1);
  if (after == field.shells.end()) return shell.mean_before;
  const double volume_m3 = beam_volume_m3(field.beam, range_m) - shell.volume_before_m3;
  return shell.mean_before + shell.drops_per_m3 * volume_m3;
}

/// The inverse of beam_volume_m3(), by Newton's method from a range less than 6 % away: the fourth
/// step is exact, because each squares the error.
double range_of_volume_m(const BeamShape& beam, double volume_m3, double range_m) {
  for (int i = 0; i < 4; ++i) {
    const double diameter_m = beam_diameter_m(beam, range_m);
    const double area_m2 = 0.25 * std::numbers::pi * diameter_m * diameter_m;
    range_m += (volume_m3 - beam_volume_m3(beam, range_m)) / area_m2;
  }
  return range_m;
}

}  // namespace

double beam_diameter_m(const BeamShape& beam, double range_m) {
  return beam.exit_diameter_m + beam.divergence_rad * range_m;
}

double beam_volume_m3(const BeamShape& beam, double range_m) {
  const double start = beam.exit_diameter_m;
  const double growth = beam.divergence_rad * range_m;
  return 0.25 * std::numbers::pi * range_m *
         (start * start + start * growth + growth * growth / 3.0);
}

double drop_signal(const LidarEquation& light, const DropField& field, double range_m,
                   double diameter_m) {
  const double ratio = diameter_m / beam_diameter_m(field.beam, range_m);
  return weather_signal(light, field.sizes.reflectance * std::min(1.0, ratio * ratio), range_m);
}

DropField drop_field(const LidarEquation& light, const DropSizes& sizes, const BeamShape& beam,
                     double min_signal) {
  DropField field{.sizes = sizes, .beam = beam, .min_signal = min_signal};
  if (!(beam_diameter_m(beam, 1.0) > 0.0) || !(sizes.number_per_m4 > 0.0)) return field;
  LidarEquation without_overlap = light;
  without_overlap.overlap.clear();
  const std::vector<double> edges_m = shell_edges_m(light);
  double mean = 0.0;
  for (std::size_t i = 0; i + 1 < edges_m.size(); ++i) {
    const double from_m = edges_m[i];
    DropShell shell{
        .from_m = from_m, .volume_before_m3 = beam_volume_m3(beam, from_m), .mean_before = mean};
    const double most = brightest(light, without_overlap, from_m, edges_m[i + 1]);
    shell.min_diameter_m = min_diameter_m(field, most, from_m);
    shell.drops_per_m3 = drops_per_m3(sizes, shell.min_diameter_m);
    const double volume_m3 = beam_volume_m3(beam, edges_m[i + 1]) - shell.volume_before_m3;
    mean += shell.drops_per_m3 * volume_m3;
    field.shells.push_back(shell);
  }
  field.shells.push_back({.from_m = edges_m.back(), .mean_before = mean});
  const auto is_void = [](const DropShell& shell) { return !(shell.drops_per_m3 > 0.0); };
  while (field.shells.size() > 1 && is_void(field.shells.end()[-2])) field.shells.pop_back();
  return field;
}

void sample_drops(const LidarEquation& light, const DropField& field, double hard_range_m,
                  RngKey key, FunctionRef<void(const DropEcho&)> take) {
  if (field.shells.empty()) return;
  const double end = mean_to(field, hard_range_m);
  if (!(end > 0.0)) return;
  require_number(end <= kMaxDrops, "weather, mean number of detectable drops in a beam", end,
                 "1e6; increase min_signal or use a narrower beam");
  // In units of expected drops, the distances between drops are exponential.
  double mean = 0.0;
  for (;; ++key.block) {
    const RandomWords words = random_words(key);
    mean -= portable_log(uniform(words[0]));
    if (!(mean < end)) return;
    const DropShell& shell = shell_of(field, mean);
    const double volume_m3 =
        shell.volume_before_m3 + (mean - shell.mean_before) / shell.drops_per_m3;
    const double range_m = range_of_volume_m(field.beam, volume_m3, shell.from_m);
    const double beyond_m = -portable_log(uniform(words[1])) / field.sizes.slope_per_m;
    const double diameter_m = shell.min_diameter_m + beyond_m;
    const double signal = drop_signal(light, field, range_m, diameter_m);
    if (signal >= field.min_signal) take({range_m, signal, diameter_m});
  }
}

}  // namespace glidar
