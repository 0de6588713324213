// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/point_colours.hpp>

#include <glidar/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace glidar {
namespace {

constexpr Colour kNothing = {150, 150, 156};  // returns of no object, and objects without a class

/// Without the darkest colours, which are invisible on the background.
Colour bright_ramp(double t) {
  constexpr double kDarkest = 0.18;
  return viridis(kDarkest + (1.0 - kDarkest) * t);
}

Colour near_bright_ramp(double t) {
  return bright_ramp(1.0 - t);
}

/// Blue, white at the middle, red; all are bright enough for the background.
Colour diverging_ramp(double t) {
  constexpr std::array<Colour, 3> kColours = {{{64, 140, 255}, {232, 232, 236}, {255, 84, 56}}};
  const double place = 2.0 * std::clamp(t, 0.0, 1.0);
  const std::size_t below = place < 1.0 ? 0 : 1;
  const double part = place - static_cast<double>(below);
  const auto mix = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * part));
  };
  const Colour& a = kColours.at(below);
  const Colour& b = kColours.at(below + 1);
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

/// The value of a column for each shown point.
std::vector<double> field_values(const CloudFile& job, const ShownPoints& shown,
                                 std::string_view column) {
  std::vector<double> numbers;
  numbers.reserve(shown.entries.size());
  std::visit(
      [&](const auto& values) {
        for (const std::size_t entry : shown.entries)
          numbers.push_back(static_cast<double>(values[entry]));
      },
      find_column(job.cloud, column)->values);
  return numbers;
}

PointColours colour_by_bar(const std::vector<double>& values, ColourBar bar) {
  PointColours result;
  for (const double value : values) {
    result.colours.push_back(std::isfinite(value) ? bar.ramp(bar.scale.fraction(value)) : kNothing);
  }
  result.bar = std::move(bar);
  return result;
}

/// The scale has 0 in its middle.
PointColours colour_by_velocity(const CloudFile& job, const ShownPoints& shown) {
  if (!job.context.sensor.doppler) {
    throw Error({"colour_by", "radial_velocity: the sensor does not measure it",
                 "height, range, intensity, ring, class or instance",
                 "add 'doppler: {}' to a sensor file (docs/doppler.md)"});
  }
  const std::vector<double> values = field_values(job, shown, "radial_velocity");
  ColourScale scale = make_colour_scale(values);
  const double end = std::max(std::abs(scale.low), std::abs(scale.high));
  scale.clips_low = std::any_of(values.begin(), values.end(), [end](double v) { return v < -end; });
  scale.clips_high = std::any_of(values.begin(), values.end(), [end](double v) { return v > end; });
  scale.low = -end;
  scale.high = end;
  return colour_by_bar(values, {"radial velocity", "m/s", scale, diverging_ramp});
}

PointColours colour_by_ring(const CloudFile& job, const ShownPoints& shown) {
  if (looks_along_z(job.context.beams)) {
    throw Error({"colour_by", "ring: a camera has no rings",
                 "height, range, intensity, class or instance", "rings are channels of LiDARs"});
  }
  const std::vector<double> rings = field_values(job, shown, "ring");
  ColourScale scale{};  // rings have no outliers
  if (!rings.empty()) {
    const auto [low, high] = std::minmax_element(rings.begin(), rings.end());
    scale = {.low = *low, .high = *high, .has_values = true};
  }
  return colour_by_bar(rings, {"ring", "", scale, bright_ramp});
}

std::string class_name(const Scene& scene, std::uint32_t id) {
  return id < scene.class_names.size() ? scene.class_names[id] : fmt::format("class {}", id);
}

std::string instance_name(const Scene& scene, std::uint32_t id) {
  const auto found = std::find_if(scene.instances.begin(), scene.instances.end(),
                                  [id](const Instance& it) { return it.id == id; });
  return found == scene.instances.end() || found->name.empty() ? fmt::format("instance {}", id)
                                                               : found->name;
}

/// Numbers with their names, the most frequent first.
std::vector<LegendEntry> legend_of(const std::map<std::uint32_t, std::size_t>& counts,
                                   const std::map<std::uint32_t, LegendEntry>& entries) {
  std::vector<std::pair<std::uint32_t, std::size_t>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<LegendEntry> legend;
  for (const auto& [number, count] : order) legend.push_back(entries.at(number));
  return legend;
}

/// The legend entry of a number in the column.
LegendEntry entry_of(const Scene& scene, std::uint32_t number, bool is_class) {
  if (number == kInvalidId) return {kNothing, "no object"};
  if (!is_class) return {category_colour(number), instance_name(scene, number)};
  // number 0 means no class
  return {number == 0 ? kNothing : category_colour(number - 1), class_name(scene, number)};
}

PointColours colour_by_number(const CloudFile& job, const ShownPoints& shown, bool is_class) {
  std::map<std::uint32_t, std::size_t> counts;
  std::map<std::uint32_t, LegendEntry> entries;
  PointColours result;
  for (const double value : field_values(job, shown, is_class ? "class" : "instance")) {
    const auto number = static_cast<std::uint32_t>(value);
    if (counts[number]++ == 0) entries[number] = entry_of(job.context.scene, number, is_class);
    result.colours.push_back(entries[number].colour);
  }
  result.legend = legend_of(counts, entries);
  return result;
}

}  // namespace

PointColours colour_points(const CloudFile& job, const ShownPoints& shown) {
  switch (job.options.picture.colour_by) {
    case ColourBy::range: {
      const std::vector<double> values = field_values(job, shown, "range");
      return colour_by_bar(values, {"range", "m", make_colour_scale(values), near_bright_ramp});
    }
    case ColourBy::intensity: {
      const std::vector<double> values = field_values(job, shown, "intensity");
      return colour_by_bar(
          values,
          {"intensity", "", make_colour_scale(values, ColourScale::Start::zero), light_grey});
    }
    case ColourBy::ring:
      return colour_by_ring(job, shown);
    case ColourBy::object_class:
      return colour_by_number(job, shown, true);
    case ColourBy::instance:
      return colour_by_number(job, shown, false);
    case ColourBy::radial_velocity:
      return colour_by_velocity(job, shown);
    case ColourBy::height:
      break;
  }
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& point : shown.points_m) heights_m.push_back(point.z());
  return colour_by_bar(heights_m, {"height", "m", make_colour_scale(heights_m), bright_ramp});
}

}  // namespace glidar
