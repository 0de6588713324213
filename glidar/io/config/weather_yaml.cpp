// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/weather_yaml.hpp>

#include <string>
#include <vector>

namespace glidar {
namespace {

// In the order of the enumerators.
const std::vector<std::string> kVisibilityKinds = {"contrast", "mor"};
const std::vector<std::string> kFogModels = {"kim", "kruse"};
const std::vector<std::string> kRainModels = {"geometric", "goodin"};
const std::vector<std::string> kSnowModels = {"gunn_marshall", "sekhon_srivastava"};

constexpr NumberRule kVisibility = {0.0, kMaxVisibility_m, false,
                                    "metres from 1 to 1e6, or 0 for clear air"};
constexpr NumberRule kPrecipitationRate = {0.0, kMaxFall_mm_per_h, false, "mm/h from 0 to 1000"};
constexpr NumberRule kMinSignal = {1e-6, 1e6, false, "a number from 1e-6 to 1e6"};

template <class Choice>
void read_choice(const YamlField& weather, const char* key, const std::vector<std::string>& words,
                 Choice& choice) {
  if (const auto field = find(weather, key)) choice = static_cast<Choice>(one_of(*field, words));
}

template <class Choice>
const std::string& word(const std::vector<std::string>& words, Choice choice) {
  return words.at(static_cast<std::size_t>(choice));
}

void read_visibility(const YamlField& weather, double& visibility_m) {
  const auto field = find(weather, "visibility_m");
  if (!field) return;
  visibility_m = number(*field, kVisibility);
  if (visibility_m > 0.0 && visibility_m < 1.0)
    reject(*field, describe(*field), kVisibility.allowed);
}

}  // namespace

Weather read_weather(const YamlField& field) {
  require_map(
      field, {"visibility_m", "visibility_kind", "fog_model", "fog_backscatter_per_sr", "fog_looks",
              "rain_mm_per_h", "rain_model", "snow_mm_per_h", "snow_model", "min_signal"});
  Weather weather;
  read_visibility(field, weather.visibility_m);
  read_choice(field, "visibility_kind", kVisibilityKinds, weather.visibility_kind);
  read_choice(field, "fog_model", kFogModels, weather.fog_model);
  weather.fog_backscatter_per_sr =
      number_or(field, "fog_backscatter_per_sr", kZeroToOne, weather.fog_backscatter_per_sr);
  if (const auto looks = find(field, "fog_looks"))
    weather.fog_looks = whole_number(*looks, 0, kMaxFogLooks);
  weather.rain_mm_per_h =
      number_or(field, "rain_mm_per_h", kPrecipitationRate, weather.rain_mm_per_h);
  read_choice(field, "rain_model", kRainModels, weather.rain_model);
  weather.snow_mm_per_h =
      number_or(field, "snow_mm_per_h", kPrecipitationRate, weather.snow_mm_per_h);
  read_choice(field, "snow_model", kSnowModels, weather.snow_model);
  weather.min_signal = number_or(field, "min_signal", kMinSignal, weather.min_signal);
  validate(weather);
  return weather;
}

nlohmann::ordered_json weather_json(const Weather& weather) {
  return {{"visibility_m", weather.visibility_m},
          {"visibility_kind", word(kVisibilityKinds, weather.visibility_kind)},
          {"fog_model", word(kFogModels, weather.fog_model)},
          {"fog_backscatter_per_sr", weather.fog_backscatter_per_sr},
          {"fog_looks", weather.fog_looks},
          {"rain_mm_per_h", weather.rain_mm_per_h},
          {"rain_model", word(kRainModels, weather.rain_model)},
          {"snow_mm_per_h", weather.snow_mm_per_h},
          {"snow_model", word(kSnowModels, weather.snow_model)},
          {"min_signal", weather.min_signal}};
}

}  // namespace glidar
