// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/receiver_yaml.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

constexpr NumberRule kDivergence_mrad = {0.0, 1500.0, false, "milliradians from 0 to 1500"};
constexpr NumberRule kExit_mm = {0.0, 1e5, false, "millimetres from 0 to 1e5"};
constexpr NumberRule kPulse_ns = {0.0, 1e6, true, "nanoseconds above 0, up to 1e6"};
constexpr NumberRule kSeparation_m = {0.0, 1e6, false, "metres from 0 to 1e6"};

struct NamedReturn {
  const char* name;
  Return which;
};

constexpr std::array<NamedReturn, 6> kReturns = {
    {{"first", {Return::Order::nearest, 0}},
     {"second", {Return::Order::nearest, 1}},
     {"third", {Return::Order::nearest, 2}},
     {"last", {Return::Order::farthest, 0}},
     {"strongest", {Return::Order::strongest, 0}},
     {"second_strongest", {Return::Order::strongest, 1}}}};

/// One number for both, or [across, up].
std::array<double, 2> read_two(const YamlField& field, const NumberRule& rule, double unit) {
  if (!field.node.IsSequence()) {
    const double both = number(field, rule) * unit;
    return {both, both};
  }
  const std::vector<YamlField> two = items(field);
  if (two.size() != 2) reject(field, describe(field), "one number, or two: [across, up]");
  return {number(two[0], rule) * unit, number(two[1], rule) * unit};
}

/// The nearest `count` returns, or a list of names.
std::vector<Return> read_returns(const YamlField& field) {
  if (!field.node.IsSequence()) return nearest_returns(whole_number(field, 1, kMaxReturns));
  std::vector<Return> returns;
  const std::vector<std::string> names = return_names();
  for (const YamlField& item : items(field)) {
    returns.push_back(kReturns[one_of(item, names)].which);
  }
  if (returns.empty() || returns.size() > kMaxReturns)
    reject(field, std::to_string(returns.size()) + " entries", "1 to 16 returns");
  return returns;
}

}  // namespace

Footprint read_footprint(const YamlField& field) {
  constexpr double kMilliradian = 1e-3;
  require_map(field, {"divergence_mrad", "exit_mm", "width_definition", "rings"});
  const auto widths = find(field, "width_definition");
  const bool is_fwhm = widths && one_of(*widths, {"1/e2", "fwhm"}) == 1;
  const double unit = is_fwhm ? kMilliradian * kWidthPerFwhm : kMilliradian;
  Footprint footprint;
  const auto divergence = read_two(need(field, "divergence_mrad"), kDivergence_mrad, unit);
  footprint.divergence_x_rad = divergence[0];
  footprint.divergence_y_rad = divergence[1];
  if (const auto exit = find(field, "exit_mm")) {
    const auto widths_m = read_two(*exit, kExit_mm, unit);
    footprint.exit_x_m = widths_m[0];
    footprint.exit_y_m = widths_m[1];
  }
  if (const auto rings = find(field, "rings")) footprint.rings = whole_number(*rings, 1, kMaxRings);
  validate(footprint);
  return footprint;
}

Receiver read_receiver(const YamlField& field) {
  constexpr double kNanosecond_s = 1e-9;
  require_map(field, {"pulse_ns", "timing", "min_return_separation_m", "returns"});
  Receiver receiver;
  receiver.pulse_fwhm_s = kNanosecond_s * number_or(field, "pulse_ns", kPulse_ns,
                                                    receiver.pulse_fwhm_s / kNanosecond_s);
  if (const auto timing = find(field, "timing")) {
    receiver.timing = static_cast<Receiver::Timing>(one_of(*timing, {"centroid", "leading_edge"}));
  }
  receiver.separation_m =
      number_or(field, "min_return_separation_m", kSeparation_m, receiver.separation_m);
  if (const auto returns = find(field, "returns")) receiver.returns = read_returns(*returns);
  validate(receiver);
  return receiver;
}

std::vector<std::string> return_names() {
  std::vector<std::string> names;
  for (const NamedReturn& known : kReturns) names.emplace_back(known.name);
  return names;
}

Return return_named(std::string_view name) {
  return std::find_if(kReturns.begin(), kReturns.end(),
                      [&](const NamedReturn& known) { return known.name == name; })
      ->which;
}

std::vector<Return> nearest_returns(std::uint32_t count) {
  std::vector<Return> returns;
  for (unsigned k = 0; k < count; ++k) returns.push_back({Return::Order::nearest, k});
  return returns;
}

std::string return_name(const Return& one) {
  for (const NamedReturn& known : kReturns) {
    if (known.which.order == one.order && known.which.rank == one.rank) return known.name;
  }
  return "return " + std::to_string(one.rank + 1);  // of the nearest
}

}  // namespace glidar
