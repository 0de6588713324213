// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>

#include "io/yaml_files.hpp"

#include <set>

namespace glidar {
namespace {

const std::string kOptics = "optics: {width: 4, height: 2, fov_deg: 20}\n";

std::vector<NoiseStep> read(const std::string& steps) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", kOptics + "noise:\n" + steps)).noise;
}

/// The steps as a sidecar has them.
nlohmann::ordered_json report(const std::vector<NoiseStep>& noise) {
  auto list = nlohmann::ordered_json::array();
  for (const NoiseStep& step : noise) {
    list.push_back(write_struct(FieldVisitor::Mode::report, step));
  }
  return list;
}

/// Steps with every key they have, at numbers that differ from the defaults.
const std::string kEvery = R"(
  - {type: range_gaussian, sigma_m: 0.02, sigma_per_m: 0.001}
  - {type: range_snr, floor_m: 0.01, k_m: 0.3, snr_at_full_scale: 250}
  - {type: range_crlb, pulse_fwhm_ns: 5, sample_ns: 0.5, noise: 0.02}
  - {type: range_shot_noise, pulse_fwhm_ns: 4, photons_at_full_scale: 1000}
  - {type: range_uniform, additive_m: 0.1, multiplicative: 0.01, distribution: normal}
  - {type: range_quantization, step_m: 0.002}
  - {type: range_bias, offset_m: -0.01, sigma_m: 0.005}
  - {type: range_drift, sigma_m: 0.004, tau_s: 60, per_ring: true}
  - {type: dropout, probability: 0.01, by_range_m: [[10, 0], [50, 0.5]], by_incidence_deg: [[60, 0], [90, 1]]}
  - {type: crosstalk, probability: 0.001, near_m: 0.5}
  - {type: false_alarms, rate_hz: 1000, near_m: 0.25, far_m: 100, intensity: 0.125}
  - {type: disparity_quantization, k_m: 351.3, offset_steps: 0.25}
  - {type: kinect_v1, k_m: 345.5, offset_steps: 0.5, sigma_steps: 0.4, window: 7}
  - {type: khoshelham, sigma_per_m: 0.0015}
  - {type: nguyen_axial, a_m: 0.001, b_per_m: 0.002, c_m: 0.5, grazing_coefficient: 0.0002}
  - {type: nguyen_lateral, a_px: 0.75, b_px: 0.03}
  - {type: icl_kinect, k_m: 350, lateral_px: 0.25, sigma_steps: 0.125}
  - {type: stereo, focal_px: 674, baseline_m: 0.05, sigma_px: 0.08, step_px: 0.125}
  - {type: continuous_wave, frequencies_hz: [80e6, 16e6], electrons_at_full_scale: 20000, background_electrons: 5000, contrast: 0.6, multipath_fraction: 0.1, min_coherence: 0.5, max_phase_residual: 0.05}
  - {type: intensity_gaussian, sigma: 0.01, relative: 0.02}
  - {type: intensity_scale, kind: vendor, gain: 2, reference_m: 10, range_exponent: 2.5, diffuse_counts: 120, max_reflectance: 50}
  - {type: pointing_jitter, sigma_azimuth_deg: 0.1, sigma_elevation_deg: 0.05}
  - {type: encoder_error, step_deg: 0.01, eccentricity_deg: 0.02, phase_deg: 45, turn_sigma_deg: 0.03}
)";

TEST(NoiseYaml, ReadsStepsInTheOrderOfTheFile) {
  const TestFolder folder;
  const YamlField file = read_yaml(folder.write("s.yaml", "noise:\n" + kEvery));
  const std::vector<YamlField> steps = items(need(file, "noise"));
  const std::vector<NoiseStep> noise = read(kEvery);
  ASSERT_EQ(noise.size(), steps.size());
  for (std::size_t i = 0; i < noise.size(); ++i) {
    EXPECT_EQ(type_info(noise[i]).name, text(need(steps[i], "type")));
  }
}

TEST(NoiseYaml, ConvertsUnits) {
  const std::vector<NoiseStep> noise = read(kEvery);
  EXPECT_DOUBLE_EQ(std::get<RangeCrlb>(noise[2]).pulse_fwhm_s, 5e-9);
  EXPECT_DOUBLE_EQ(std::get<RangeCrlb>(noise[2]).sample_s, 0.5e-9);
  EXPECT_DOUBLE_EQ(std::get<PointingJitter>(noise[21]).sigma_azimuth_rad, 0.1 * kDegree);
  EXPECT_DOUBLE_EQ(std::get<EncoderError>(noise[22]).phase_rad, 45.0 * kDegree);
  const auto& dropout = std::get<Dropout>(noise[8]);
  EXPECT_EQ(dropout.by_range_m, (LookupTable{{10.0, 0.0}, {50.0, 0.5}}));
  EXPECT_DOUBLE_EQ(dropout.by_incidence_rad[0][0], 60.0 * kDegree);
}

TEST(NoiseYaml, TellsInTheSidecarWhatTheFileSays) {
  const nlohmann::ordered_json reported = report(read(kEvery));
  const auto near = [](const nlohmann::ordered_json& value, double expected) {
    EXPECT_NEAR(value.get<double>(), expected, 1e-12 * std::abs(expected));
  };
  EXPECT_EQ(reported[0].at("type"), "range_gaussian");
  near(reported[0].at("sigma_m"), 0.02);
  near(reported[2].at("pulse_fwhm_ns"), 5.0);
  EXPECT_EQ(reported[4].at("distribution"), "normal");
  EXPECT_EQ(reported[7].at("per_ring"), true);
  near(reported[8].at("by_incidence_deg")[1][0], 90.0);
  EXPECT_EQ(reported[12].at("window"), 7);
  near(reported[18].at("frequencies_hz")[1], 16e6);
  EXPECT_EQ(reported[20].at("kind"), "vendor");
  near(reported[22].at("phase_deg"), 45.0);
}

TEST(NoiseYaml, EveryNumberOfTheFileComesBackInTheSidecar) {
  const TestFolder folder;
  const YamlField file = read_yaml(folder.write("s.yaml", "noise:\n" + kEvery));
  const std::vector<YamlField> steps = items(need(file, "noise"));
  const nlohmann::ordered_json reported = report(read(kEvery));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::set<std::string> keys;
    for (const auto& [key, value] : entries(steps[i])) {
      keys.insert(key);
      if (!reported[i].at(key).is_number()) continue;
      const double expected = number(value, kFinite);
      EXPECT_NEAR(reported[i].at(key).get<double>(), expected, 1e-12 * std::abs(expected)) << key;
    }
    for (const auto& [key, value] : reported[i].items()) EXPECT_TRUE(keys.contains(key)) << key;
  }
}

TEST(NoiseYaml, DefaultsAreThoseOfTheStructs) {
  const std::vector<NoiseStep> noise = read("  - {type: kinect_v1}\n  - {type: nguyen_axial}\n");
  EXPECT_EQ(std::get<KinectV1>(noise[0]).k_m, KinectV1{}.k_m);
  EXPECT_EQ(std::get<KinectV1>(noise[0]).window, 9U);
  EXPECT_EQ(std::get<NguyenAxial>(noise[1]).b_per_m, 0.0019);
}

class NoiseYamlError : public ::testing::TestWithParam<BadFile> {};

TEST_P(NoiseYamlError, NamesPlaceFieldAndCure) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", kOptics + "noise: [" + GetParam().content + "]\n");
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

const BadFile kBadSteps[] = {
    {"NotAMap", "3", "s.yaml:2:9: noise[0]: 3; allowed: a map with the key 'type'"},
    {"NoType", "{sigma_m: 1}", "s.yaml:2:9: noise[0]: the key 'type' is missing; add 'type: ...'"},
    {"MissingNumber", "{type: range_quantization}",
     "s.yaml:2:9: noise[0]: the key 'step_m' is missing; add 'step_m: ...'"},
    {"UnknownKey", "{type: range_gaussian, sigma: 1}",
     "s.yaml:2:32: noise[0].sigma: unknown key 'sigma'; allowed: type, sigma_m, sigma_per_m; did "
     "you mean 'sigma_m'?"},
    {"Negative", "{type: range_gaussian, sigma_m: -1}",
     "s.yaml:2:41: noise[0].sigma_m: -1; allowed: a finite number from 0"},
    {"Probability", "{type: dropout, probability: 2}",
     "s.yaml:2:38: noise[0].probability: 2; allowed: a number from 0 to 1"},
    {"TableFalls", "{type: dropout, by_range_m: [[2, 0], [1, 0]]}",
     "s.yaml:2:47: noise[0].by_range_m[1][0]: 1, not above the one before; allowed: numbers that "
     "rise"},
    {"TableOfTriples", "{type: dropout, by_range_m: [[2, 0, 1]]}",
     "s.yaml:2:38: noise[0].by_range_m[0]: a list of 3; allowed: a pair of numbers"},
    {"EvenWindow", "{type: kinect_v1, window: 8}",
     "s.yaml:2:35: noise[0].window: 8; allowed: an odd number from 1 to 33"},
    {"GateEndsBeforeItBegins", "{type: false_alarms, rate_hz: 1, near_m: 2, far_m: 1}",
     "s.yaml:2:60: noise[0].far_m: 1, not beyond near_m; allowed: a finite number above near_m"},
    {"NoFrequency", "{type: continuous_wave, electrons_at_full_scale: 1, frequencies_hz: []}",
     "s.yaml:2:77: noise[0].frequencies_hz: an empty list; allowed: 1 to 8 frequencies"},
    {"OddFrequencies",
     "{type: continuous_wave, electrons_at_full_scale: 1, frequencies_hz: [80e6, 16000001]}",
     "s.yaml:2:77: noise[0].frequencies_hz: their greatest common divisor is below a thousandth of "
     "the greatest; allowed: frequencies in simple ratios; round them to whole MHz"},
    {"Distribution", "{type: range_uniform, distribution: normall}",
     "s.yaml:2:45: noise[0].distribution: 'normall'; allowed: uniform, normal; did you mean "
     "'normal'?"},
};

INSTANTIATE_TEST_SUITE_P(All, NoiseYamlError, ::testing::ValuesIn(kBadSteps), bad_file_name);

TEST(NoiseYaml, AnUnknownTypeIsToldWithTheNearest) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", kOptics + "noise: [{type: range_gausian}]\n");
  const std::string error = error_of(folder, [&] { load_sensor_file(file); });
  EXPECT_TRUE(error.starts_with("s.yaml:2:16: noise[0].type: 'range_gausian'; allowed: range_gau"))
      << error;
  EXPECT_TRUE(error.ends_with("did you mean 'range_gaussian'?")) << error;
}

}  // namespace
}  // namespace glidar
