// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/noise_yaml.hpp>

#include <glidar/io/config/json_numbers.hpp>
#include <glidar/io/config/noise_fields.hpp>
#include <glidar/math/light_speed.hpp>

#include <algorithm>
#include <utility>

namespace glidar {
namespace {

constexpr std::uint32_t kWidestWindow = 33;
const std::vector<std::string> kIntensityKinds = {"unit", "vendor", "plain"};
constexpr NumberRule kFrequency = {1.0, 1e12, false, "hertz from 1 to 1e12"};

/// What a step's map holds beside its numbers; most hold nothing.
template <class Step>
std::vector<std::string> other_keys(const Step& /*step*/) {
  return {};
}
template <class Step>
void read_others(const YamlField& /*field*/, Step& /*step*/) {}

std::vector<std::string> other_keys(const RangeUniform& /*step*/) {
  return {"distribution"};
}
void read_others(const YamlField& field, RangeUniform& step) {
  if (const auto kind = find(field, "distribution")) {
    step.distribution =
        static_cast<RangeUniform::Distribution>(one_of(*kind, {"uniform", "normal"}));
  }
}

std::vector<std::string> other_keys(const RangeDrift& /*step*/) {
  return {"per_ring"};
}
void read_others(const YamlField& field, RangeDrift& step) {
  if (const auto per_ring = find(field, "per_ring")) step.per_ring = boolean(*per_ring);
}

std::vector<std::string> other_keys(const Dropout& /*step*/) {
  return {"by_range_m", "by_incidence_deg"};
}
void read_others(const YamlField& field, Dropout& step) {
  if (const auto by_range = find(field, "by_range_m")) {
    step.by_range_m = table(*by_range, kFromZero, kZeroToOne);
  }
  if (const auto by_incidence = find(field, "by_incidence_deg")) {
    step.by_incidence_rad = table(*by_incidence, kFromZero, kZeroToOne, kDegree_rad);
  }
}

void read_others(const YamlField& field, FalseAlarms& step) {
  if (step.far_m > step.near_m) return;
  const YamlField far = need(field, "far_m");
  reject(far, describe(far) + ", not beyond near_m", "a finite number above near_m");
}

std::vector<std::string> other_keys(const KinectV1& /*step*/) {
  return {"window"};
}
void read_others(const YamlField& field, KinectV1& step) {
  const auto window = find(field, "window");
  if (!window) return;
  step.window = whole_number(*window, 1, kWidestWindow);
  if (step.window % 2 == 0) reject(*window, describe(*window), "an odd number from 1 to 33");
}

std::vector<std::string> other_keys(const ContinuousWave& /*step*/) {
  return {"frequencies_hz"};
}
void read_others(const YamlField& field, ContinuousWave& step) {
  const YamlField list = need(field, "frequencies_hz");
  for (const YamlField& item : items(list)) {
    step.frequencies_hz.push_back(number(item, kFrequency));
  }
  const std::size_t count = step.frequencies_hz.size();
  if (count == 0 || count > kMaxFrequencies) reject(list, describe(list), "1 to 8 frequencies");
  const double finest = *std::max_element(step.frequencies_hz.begin(), step.frequencies_hz.end());
  constexpr double kMaxWaves = 1000.0;  // tried one by one for every pixel
  if (finest * unambiguous_m(step.frequencies_hz) > kMaxWaves * kHalfLight_m_per_s) {
    reject(list, "their greatest common divisor is below a thousandth of the greatest",
           "frequencies in simple ratios", "round them to whole MHz");
  }
}

std::vector<std::string> other_keys(const IntensityScale& /*step*/) {
  return {"kind"};
}
void read_others(const YamlField& field, IntensityScale& step) {
  if (const auto kind = find(field, "kind")) {
    step.kind = static_cast<IntensityScale::Kind>(one_of(*kind, kIntensityKinds));
  }
}

template <class Step>
NoiseStep read_step_of(const YamlField& field) {
  Step step;
  std::vector<std::string> known = {"type"};
  for (const auto& n : number_fields(step)) known.emplace_back(n.key);
  for (std::string& key : other_keys(step)) known.push_back(std::move(key));
  require_map(field, known);
  for (const auto& n : number_fields(step)) {
    const auto value = n.is_needed ? need(field, n.key) : find(field, n.key);
    if (value) step.*n.number = number(*value, n.rule) * n.unit;
  }
  read_others(field, step);
  return step;
}

template <std::size_t... kIndex>
NoiseStep read_step(const YamlField& field, std::size_t type,
                    std::index_sequence<kIndex...> /*all*/) {
  using Read = NoiseStep (*)(const YamlField&);
  constexpr std::array<Read, sizeof...(kIndex)> kReaders = {
      &read_step_of<std::variant_alternative_t<kIndex, NoiseStep>>...};
  return kReaders[type](field);
}

using Json = nlohmann::ordered_json;

template <class Step>
void tell_others(const Step& /*step*/, InUnit /*convert*/, Json& /*told*/) {}

void tell_others(const RangeUniform& step, InUnit /*convert*/, Json& told) {
  told["distribution"] =
      step.distribution == RangeUniform::Distribution::uniform ? "uniform" : "normal";
}

void tell_others(const RangeDrift& step, InUnit /*convert*/, Json& told) {
  told["per_ring"] = step.per_ring;
}

Json table_json(const LookupTable& table, double unit, InUnit convert) {
  Json pairs = Json::array();
  for (const auto& [place, value] : table) {
    pairs.push_back(Json::array({convert(place, unit), value}));
  }
  return pairs;
}

void tell_others(const Dropout& step, InUnit convert, Json& told) {
  told["by_range_m"] = table_json(step.by_range_m, 1.0, convert);
  told["by_incidence_deg"] = table_json(step.by_incidence_rad, kDegree_rad, convert);
}

void tell_others(const KinectV1& step, InUnit /*convert*/, Json& told) {
  told["window"] = step.window;
}

void tell_others(const ContinuousWave& step, InUnit /*convert*/, Json& told) {
  told["frequencies_hz"] = step.frequencies_hz;
}

void tell_others(const IntensityScale& step, InUnit /*convert*/, Json& told) {
  told["kind"] = kIntensityKinds.at(static_cast<std::size_t>(step.kind));
}

}  // namespace

std::vector<NoiseStep> read_noise(const YamlField& field) {
  static const std::vector<std::string> kTypes(kNoiseTypes.begin(), kNoiseTypes.end());
  std::vector<NoiseStep> noise;
  for (const YamlField& item : items(field)) {
    if (!item.node.IsMap()) reject(item, describe(item), "a map with the key 'type'");
    const std::size_t type = one_of(need(item, "type"), kTypes);
    noise.push_back(
        read_step(item, type, std::make_index_sequence<std::variant_size_v<NoiseStep>>()));
  }
  if (noise.size() > kMaxNoiseSteps) {
    reject(field, describe(field), "at most " + std::to_string(kMaxNoiseSteps) + " steps");
  }
  return noise;
}

nlohmann::ordered_json noise_json(const std::vector<NoiseStep>& noise, InUnit convert) {
  Json list = Json::array();
  for (const NoiseStep& step : noise) {
    Json told = {{"type", kNoiseTypes.at(step.index())}};
    std::visit(
        [&](const auto& s) {
          for (const auto& n : number_fields(s)) told[n.key] = convert(s.*n.number, n.unit);
          tell_others(s, convert, told);
        },
        step);
    list.push_back(told);
  }
  return list;
}

}  // namespace glidar
