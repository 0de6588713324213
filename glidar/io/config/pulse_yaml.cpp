// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/pulse_yaml.hpp>

#include <glidar/math/constants.hpp>

#include <string>

namespace glidar {
namespace {

constexpr NumberRule kReflectance = {0.0, 1000.0, true, "a number above 0, up to 1000"};
constexpr NumberRule kRange = {0.0, 1e9, true, "metres above 0, up to 1e9"};
constexpr NumberRule kRangeFromZero = {0.0, 1e9, false, "metres from 0 to 1e9"};
constexpr NumberRule kExponent = {0.0, 16.0, false, "a number from 0 to 16"};
constexpr NumberRule kWavelength_nm = {100.0, 20000.0, false, "nanometres from 100 to 20000"};
constexpr NumberRule kWidth_deg = {0.0, 180.0, true, "degrees above 0 and below 180"};
constexpr NumberRule kRoughness_deg = {0.0, 90.0, false, "degrees from 0 to 90"};

/// The noise, told as such or by the range at which the sheet promises 90 %.
void read_noise_sigma(const YamlField& field, LidarEquation& light) {
  const auto range90 = find(field, "range90_m");
  const auto sigma = find(field, "noise_sigma");
  if (range90 && sigma) {
    reject(*range90, "given beside 'noise_sigma'", "one of range90_m, noise_sigma",
           "remove one of them");
  }
  if (sigma) light.noise_sigma = number(*sigma, kFromZero);
  if (!range90) return;
  const double range90_m = number(*range90, kRange);
  if (range90_m >= light.reference_range_m) {
    reject(*range90, describe(*range90) + ", not below the reference range",
           "metres below reference_range_m, which is seen with probability 1/2");
  }
  light.noise_sigma = noise_sigma_of(light.reference_range_m, range90_m, light.range_exponent);
}

PhongLike read_phong(const YamlField& field) {
  require_map(field, {"type", "specular_share", "exponent"});
  PhongLike s;
  s.specular_share = number_or(field, "specular_share", kZeroToOne, s.specular_share);
  s.exponent = number_or(field, "exponent", kFromZero, s.exponent);
  return s;
}

OrenNayar read_oren_nayar(const YamlField& field) {
  require_map(field, {"type", "roughness_deg"});
  OrenNayar s;
  s.roughness_rad =
      kDegree * number_or(field, "roughness_deg", kRoughness_deg, s.roughness_rad / kDegree);
  return s;
}

RetroReflector read_retro(const YamlField& field) {
  require_map(field, {"type", "gain", "width_deg"});
  RetroReflector s;
  s.gain = number_or(field, "gain", kAboveZero, s.gain);
  s.width_rad = kDegree * number_or(field, "width_deg", kWidth_deg, s.width_rad / kDegree);
  return s;
}

Glossy read_glossy(const YamlField& field) {
  require_map(field, {"type", "matt_share", "lobe_gain", "width_deg"});
  Glossy s;
  s.matt_share = number_or(field, "matt_share", kZeroToOne, s.matt_share);
  s.lobe_gain = number_or(field, "lobe_gain", kFromZero, s.lobe_gain);
  s.width_rad = kDegree * number_or(field, "width_deg", kWidth_deg, s.width_rad / kDegree);
  return s;
}

}  // namespace

LidarEquation read_lidar_equation(const YamlField& field) {
  require_map(field, {"reference_reflectance", "reference_range_m", "range_exponent", "overlap",
                      "extinction_per_m", "range90_m", "noise_sigma", "saturation"});
  LidarEquation light;
  light.reference_reflectance = number(need(field, "reference_reflectance"), kReflectance);
  light.reference_range_m = number(need(field, "reference_range_m"), kRange);
  light.range_exponent = number_or(field, "range_exponent", kExponent, light.range_exponent);
  light.extinction_per_m = number_or(field, "extinction_per_m", kFromZero, 0.0);
  light.saturation = number_or(field, "saturation", kFromZero, 0.0);
  if (const auto overlap = find(field, "overlap")) {
    light.overlap = table(*overlap, kRangeFromZero, kFromZero);
  }
  read_noise_sigma(field, light);
  validate(light);
  return light;
}

Brdf read_backscatter(const YamlField& field) {
  static const std::vector<std::string> kTypes = {"lambert", "phong", "oren_nayar", "retro",
                                                  "glossy"};
  if (!field.node.IsMap()) reject(field, describe(field), "a map with the key 'type'");
  switch (one_of(need(field, "type"), kTypes)) {
    case 1:
      return read_phong(field);
    case 2:
      return read_oren_nayar(field);
    case 3:
      return read_retro(field);
    case 4:
      return read_glossy(field);
    default:
      require_map(field, {"type"});
      return Lambert{};
  }
}

LookupTable read_spectrum(const YamlField& field) {
  constexpr double kMetresPerNanometre = 1e-9;
  return table(field, kWavelength_nm, kZeroToOne, kMetresPerNanometre);
}

}  // namespace glidar
