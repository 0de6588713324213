// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_file.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_document.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/lidar/return_names.hpp>

#include <gtest/gtest.h>
#include <io/material_keys.hpp>
#include <io/yaml_files.hpp>
#include <support/error_text.hpp>

#include <cmath>
#include <set>

namespace glidar {
namespace {

const std::string kPulsed =
    "optics: {width: 4, height: 2, fov_deg: 20}\n"
    "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n";

Sensor sensor(const std::string& keys) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", kPulsed + keys + "\n"));
}

std::vector<std::string> returns(const std::string& value) {
  std::vector<std::string> names;
  for (const Return& one : sensor("receiver: {returns: " + value + "}").receiver.returns) {
    names.push_back(return_name(one));
  }
  return names;
}

TEST(FootprintInASensorFile, GivesWidthsAcrossAndUp) {
  const Footprint f =
      *sensor("footprint: {divergence_mrad: [3, 1.5], exit_mm: [9.5, 12.7], rings: 1}").footprint;
  EXPECT_DOUBLE_EQ(f.divergence_x_rad, 3e-3);
  EXPECT_DOUBLE_EQ(f.divergence_y_rad, 1.5e-3);
  EXPECT_DOUBLE_EQ(f.exit_x_m, 9.5e-3);
  EXPECT_DOUBLE_EQ(f.exit_y_m, 12.7e-3);
  EXPECT_EQ(f.rings, 1U);
}

// theta(1/e^2) = 1.699 theta(FWHM) for a Gaussian beam.
TEST(FootprintInASensorFile, TurnsWidthsAtHalfMaximumIntoThoseAtOneOverESquared) {
  const Footprint f = *sensor("footprint: {divergence_mrad: 2, width_definition: fwhm}").footprint;
  EXPECT_NEAR(f.divergence_x_rad, 2e-3 * 1.699, 2e-6);
  EXPECT_EQ(f.divergence_y_rad, f.divergence_x_rad);
  EXPECT_EQ(f.exit_x_m, 0.0);
}

TEST(ReceiverInASensorFile, GivesEveryNumber) {
  const Receiver r = sensor(
                         "receiver: {pulse_ns: 6, timing: leading_edge, min_return_separation_m: "
                         "1.2, returns: [last]}")
                         .receiver;
  EXPECT_DOUBLE_EQ(r.pulse_fwhm_s, 6e-9);
  EXPECT_EQ(r.timing, Receiver::Timing::leading_edge);
  EXPECT_EQ(r.min_return_separation_m, 1.2);
}

TEST(ReceiverInASensorFile, TakesNamesOrANumberOfReturns) {
  EXPECT_EQ(returns("[strongest, last]"), (std::vector<std::string>{"strongest", "last"}));
  EXPECT_EQ(returns("[first, second, third, second_strongest]"),
            (std::vector<std::string>{"first", "second", "third", "second_strongest"}));
  EXPECT_EQ(returns("5"),
            (std::vector<std::string>{"first", "second", "third", "return 4", "return 5"}));
}

TEST(ReceiverInASensorFile, MakesEveryBeamStandOncePerReturn) {
  const Sensor dual = sensor("receiver: {returns: [strongest, last]}");
  EXPECT_EQ(make_beams(dual).size(), 16U);
}

TEST(ReceiverInASensorFile, ErrorsNamePlaceAndWhatIsAllowed) {
  const auto text = [](const std::string& keys) { return error_text([&] { sensor(keys); }); };
  EXPECT_NE(text("receiver: {returns: [strongst]}").find("did you mean 'strongest'?"),
            std::string::npos);
  EXPECT_NE(text("receiver: {returns: 17}").find("s.yaml:3:21"), std::string::npos);
  EXPECT_NE(text("receiver: {returns: []}").find("1 to 16 returns"), std::string::npos);
  EXPECT_NE(text("receiver: {pulse_ns: 0}").find("nanoseconds above 0"), std::string::npos);
  EXPECT_NE(text("footprint: {exit_mm: 3}").find("divergence_mrad"), std::string::npos);
  EXPECT_NE(text("footprint: {divergence_mrad: [1, 2, 3]}").find("[across, up]"),
            std::string::npos);
  EXPECT_NE(text("footprint: {divergence_mrad: 1, rings: 9}").find("1 to 8"), std::string::npos);
}

TEST(ReceiverInASensorFile, NeedsPulseLight) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "optics: {width: 4, height: 2, fov_deg: 20}\nfootprint: {divergence_mrad: 1}\n");
  const std::string text = error_text([&] { load_sensor_file(file); });
  EXPECT_NE(text.find("lidar_equation"), std::string::npos) << text;
}

TEST(MirrorsInASceneFile, AreAShareOfTheLight) {
  const TestFolder folder;
  const auto file = folder.write(
      "s.yaml", "models:\n  - model: builtin:box\n    materials: {\"*\": {mirror: 0.8}}\n");
  const SceneFile loaded = load_scene_file(file, {}, {});
  EXPECT_EQ(loaded.scene.materials[loaded.scene.instances[0].materials[0]].mirror, 0.8F);
}

const std::string kNoiseOptics = "optics: {width: 4, height: 2, fov_deg: 20}\n";

std::vector<NoiseStep> read(const std::string& steps) {
  const TestFolder folder;
  return load_sensor_file(folder.write("s.yaml", kNoiseOptics + "noise:\n" + steps)).noise;
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
  const auto file = folder.write("s.yaml", kNoiseOptics + "noise: [" + GetParam().content + "]\n");
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
  const auto file = folder.write("s.yaml", kNoiseOptics + "noise: [{type: range_gausian}]\n");
  const std::string error = error_of(folder, [&] { load_sensor_file(file); });
  EXPECT_TRUE(error.starts_with("s.yaml:2:16: noise[0].type: 'range_gausian'; allowed: range_gau"))
      << error;
  EXPECT_TRUE(error.ends_with("did you mean 'range_gaussian'?")) << error;
}

const std::string kOptics = "optics: {width: 4, height: 2, fov_deg: 20}\n";

LidarEquation pulse(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kOptics + "lidar_equation: " + map + "\n"))
              .lidar_equation;
}

TEST(PulseLightInASensorFile, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kOptics)).lidar_equation.has_value());
}

TEST(PulseLightInASensorFile, GivesEveryNumber) {
  const LidarEquation light = pulse(
      "{reference_reflectance: 0.1, reference_range_m: 55, range_exponent: 2.6, overlap: "
      "[[0.9, 0], [1, 1]], extinction_per_m: 0.01, noise_sigma: 0.3, saturation: 900}");
  EXPECT_EQ(light.reference_reflectance, 0.1);
  EXPECT_EQ(light.reference_range_m, 55.0);
  EXPECT_EQ(light.range_exponent, 2.6);
  EXPECT_EQ(light.extinction_per_m, 0.01);
  EXPECT_EQ(light.noise_sigma, 0.3);
  EXPECT_EQ(light.saturation, 900.0);
  EXPECT_EQ(light.overlap, (LookupTable{{0.9, 0.0}, {1.0, 1.0}}));
}

TEST(PulseLightInASensorFile, TakesTheNoiseFromTheRangeOfNinetyPercent) {
  const LidarEquation light =
      pulse("{reference_reflectance: 0.8, reference_range_m: 120, range90_m: 100}");
  EXPECT_EQ(light.noise_sigma, noise_sigma_of(120.0, 100.0, 2.0));
}

TEST(SurfacesInASceneFile, SendBackAsTold) {
  EXPECT_TRUE(std::holds_alternative<Lambert>(
      testing::material_of_keys("backscatter: {type: lambert}").backscatter));
  const auto phong = std::get<PhongLike>(
      testing::material_of_keys("backscatter: {type: phong, specular_fraction: 0.4, exponent: 9}")
          .backscatter);
  EXPECT_EQ(phong.specular_fraction, 0.4);
  EXPECT_EQ(phong.exponent, 9.0);
  EXPECT_NEAR(std::get<OrenNayar>(
                  testing::material_of_keys("backscatter: {type: oren_nayar, roughness_deg: 20}")
                      .backscatter)
                  .roughness_rad,
              20.0 * kDegree, 1e-15);
  const auto retro = std::get<RetroReflector>(
      testing::material_of_keys("backscatter: {type: retro, gain: 500, width_deg: 25}")
          .backscatter);
  EXPECT_EQ(retro.gain, 500.0);
  EXPECT_NEAR(retro.width_rad, 25.0 * kDegree, 1e-15);
  const auto glossy = std::get<Glossy>(
      testing::material_of_keys(
          "backscatter: {type: glossy, diffuse_fraction: 0.1, lobe_gain: 4, width_deg: 2}")
          .backscatter);
  EXPECT_EQ(glossy.diffuse_fraction, 0.1);
  EXPECT_EQ(glossy.lobe_gain, 4.0);
  EXPECT_NEAR(glossy.width_rad, 2.0 * kDegree, 1e-15);
}

TEST(SurfacesInASceneFile, HaveASpectrumInNanometres) {
  const Material asphalt =
      testing::material_of_keys("spectrum: [[850, 0.269], [905, 0.278], [1550, 0.362]]");
  EXPECT_NEAR(reflectance_at(asphalt, 905e-9), 0.278, 1e-12);
  EXPECT_NEAR(reflectance_at(asphalt, 1550e-9), 0.362, 1e-12);
}

std::string sensor_error(const std::string& map) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", kOptics + "lidar_equation: " + map + "\n");
  return error_of(folder, [&] { load_sensor_file(file); });
}

TEST(PulseLightInASensorFile, RefusesWhatMeansNothingAndNamesThePlace) {
  EXPECT_EQ(sensor_error("{reference_range_m: 5}"),
            "s.yaml:2:17: lidar_equation: the key 'reference_reflectance' is missing; add "
            "'reference_reflectance: ...'");
  EXPECT_EQ(
      sensor_error("{reference_reflectance: 0.8, reference_range_m: 5, range90_m: 7}"),
      "s.yaml:2:79: lidar_equation.range90_m: 7, not below the reference range; allowed: metres "
      "below reference_range_m, which is seen with probability 1/2");
  EXPECT_EQ(
      sensor_error("{reference_reflectance: 0.8, reference_range_m: 5, overlap: [[2, 1], [1, "
                   "1]]}"),
      "s.yaml:2:87: lidar_equation.overlap[1][0]: 1, not above the one before; allowed: numbers "
      "that rise");
}

const std::string kCamera = "optics: {width: 4, height: 2, fov_deg: 20}\n";
const std::string kEveryDopplerKey =
    "{sigma_m_s: 0.03, signal_sigma_m_s: 0.4, step_m_s: 0.01, max_m_s: 75}";

Doppler doppler(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kCamera + "doppler: " + map + "\n")).doppler;
}

TEST(DopplerYaml, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kCamera)).doppler.has_value());
}

TEST(DopplerYaml, GivesEveryNumber) {
  const Doppler read = doppler(kEveryDopplerKey);
  EXPECT_EQ(read.sigma_m_s, 0.03);
  EXPECT_EQ(read.signal_sigma_m_s, 0.4);
  EXPECT_EQ(read.step_m_s, 0.01);
  EXPECT_EQ(read.max_m_s, 75.0);
}

TEST(DopplerYaml, IsExactAndUnlimitedByDefault) {
  const Doppler read = doppler("{}");
  EXPECT_EQ(read.sigma_m_s, 0.0);
  EXPECT_EQ(read.signal_sigma_m_s, 0.0);
  EXPECT_EQ(read.step_m_s, 0.0);
  EXPECT_TRUE(std::isinf(read.max_m_s));
}

TEST(DopplerYaml, ComesBackInTheSidecarAsTheFileSaysIt) {
  const nlohmann::ordered_json reported =
      write_struct(FieldVisitor::Mode::report, doppler(kEveryDopplerKey));
  EXPECT_EQ(reported.dump(),
            R"({"sigma_m_s":0.03,"signal_sigma_m_s":0.4,"step_m_s":0.01,"max_m_s":75.0})");
}

TEST(DopplerYaml, DocumentsReadBackTheSame) {
  for (const std::string map : {"{}", "{sigma_m_s: 0.1}", kEveryDopplerKey.c_str()}) {
    const TestFolder folder;
    const Sensor first =
        load_sensor_file(folder.write("s.yaml", kCamera + "doppler: " + map + "\n"));
    const std::string document = sensor_document(first);
    const Sensor again = load_sensor_file(folder.write("again.yaml", document));
    ASSERT_TRUE(again.doppler.has_value()) << map;
    EXPECT_EQ(again.doppler->sigma_m_s, first.doppler->sigma_m_s);
    EXPECT_EQ(again.doppler->max_m_s, first.doppler->max_m_s);
    EXPECT_EQ(sensor_document(again), document);
  }
}

class DopplerYamlError : public ::testing::TestWithParam<BadFile> {};

TEST_P(DopplerYamlError, NamesPlaceFieldAndWhatIsAllowed) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

const BadFile kBadDopplerFiles[] = {
    {"UnknownKey", kCamera + "doppler: {sigma_m: 3}\n",
     "s.yaml:2:11: doppler.sigma_m: unknown key 'sigma_m'; allowed: sigma_m_s, signal_sigma_m_s, "
     "step_m_s, max_m_s; did you mean 'sigma_m_s'?"},
    {"NegativeSigma", kCamera + "doppler: {sigma_m_s: -1}\n",
     "s.yaml:2:22: doppler.sigma_m_s: -1; allowed: m/s from 0 to 1e6"},
    {"NoLimitAtAll", kCamera + "doppler: {max_m_s: 0}\n",
     "s.yaml:2:20: doppler.max_m_s: 0; allowed: a finite number above 0"},
    {"StepAboveTheLimit", kCamera + "doppler: {step_m_s: 3, max_m_s: 2}\n",
     "s.yaml:2:21: doppler.step_m_s: 3, above max_m_s; allowed: a step of at most max_m_s"},
    {"FalseAlarmsWithoutALimit",
     kCamera + "doppler: {}\nnoise:\n  - {type: false_alarms, rate_hz: 100, far_m: 50}\n",
     "s.yaml:2:10: doppler: no max_m_s beside the noise step 'false_alarms'; allowed: a limit up "
     "to which the velocities of false alarms are uniform; add 'max_m_s: ...' to 'doppler'"},
};

INSTANTIATE_TEST_SUITE_P(All, DopplerYamlError, ::testing::ValuesIn(kBadDopplerFiles),
                         bad_file_name);

const std::string kPulsedInWeather =
    "optics: {width: 4, height: 2, fov_deg: 20}\n"
    "wavelength_nm: 905\n"
    "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n";

const std::string kEveryWeatherKey =
    "{visibility_m: 200, visibility_kind: mor, fog_model: kruse, fog_backscatter_per_sr: 0.092, "
    "fog_looks: 4, rain_mm_per_h: 12, rain_model: goodin, snow_mm_per_h: 3, snow_model: "
    "sekhon_srivastava, "
    "min_signal: 0.2}";

Weather weather(const std::string& map) {
  const TestFolder folder;
  return *load_sensor_file(folder.write("s.yaml", kPulsedInWeather + "weather: " + map + "\n"))
              .weather;
}

TEST(WeatherYaml, IsAbsentUnlessGiven) {
  const TestFolder folder;
  EXPECT_FALSE(load_sensor_file(folder.write("s.yaml", kPulsedInWeather)).weather.has_value());
}

TEST(WeatherYaml, GivesEveryNumberAndModel) {
  const Weather read = weather(kEveryWeatherKey);
  EXPECT_EQ(read.visibility_m, 200.0);
  EXPECT_EQ(read.visibility_kind, Weather::Visibility::mor);
  EXPECT_EQ(read.fog_model, Weather::FogModel::kruse);
  EXPECT_EQ(read.fog_backscatter_per_sr, 0.092);
  EXPECT_EQ(read.fog_looks, 4U);
  EXPECT_EQ(read.rain_mm_per_h, 12.0);
  EXPECT_EQ(read.rain_model, Weather::RainModel::goodin);
  EXPECT_EQ(read.snow_mm_per_h, 3.0);
  EXPECT_EQ(read.snow_model, Weather::SnowModel::sekhon_srivastava);
  EXPECT_EQ(read.min_signal, 0.2);
}

TEST(WeatherYaml, IsClearByDefault) {
  const Weather read = weather("{}");
  EXPECT_EQ(extinction_per_m(read, 905e-9), 0.0);
  EXPECT_EQ(read.visibility_kind, Weather::Visibility::contrast);
  EXPECT_EQ(read.fog_model, Weather::FogModel::kim);
  EXPECT_EQ(read.rain_model, Weather::RainModel::geometric);
  EXPECT_EQ(read.snow_model, Weather::SnowModel::gunn_marshall);
}

TEST(WeatherYaml, ComesBackInTheSidecarAsTheFileSaysIt) {
  const nlohmann::ordered_json reported =
      write_struct(FieldVisitor::Mode::report, weather(kEveryWeatherKey));
  EXPECT_EQ(
      reported.dump(),
      R"({"visibility_m":200.0,"visibility_kind":"mor","fog_model":"kruse",)"
      R"("fog_backscatter_per_sr":0.092,"fog_looks":4,"rain_mm_per_h":12.0,"rain_model":"goodin",)"
      R"("snow_mm_per_h":3.0,"snow_model":"sekhon_srivastava","min_signal":0.2})");
}

class WeatherYamlError : public ::testing::TestWithParam<BadFile> {};

TEST_P(WeatherYamlError, NamesPlaceFieldAndWhatIsAllowed) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { load_sensor_file(file); }), GetParam().error);
}

const BadFile kBadWeatherFiles[] = {
    {"UnknownKey", kPulsedInWeather + "weather: {rain: 3}\n",
     "s.yaml:4:11: weather.rain: unknown key 'rain'; allowed: visibility_m, visibility_kind, "
     "fog_model, fog_backscatter_per_sr, fog_looks, rain_mm_per_h, rain_model, snow_mm_per_h, "
     "snow_model, min_signal; did you mean 'rain_mm_per_h'?"},
    {"MisspeltKey", kPulsedInWeather + "weather: {visiblity_m: 3}\n",
     "s.yaml:4:11: weather.visiblity_m: unknown key 'visiblity_m'; allowed: visibility_m, "
     "visibility_kind, fog_model, fog_backscatter_per_sr, fog_looks, rain_mm_per_h, rain_model, "
     "snow_mm_per_h, snow_model, min_signal; did you mean 'visibility_m'?"},
    {"VisibilityOfCentimetres", kPulsedInWeather + "weather: {visibility_m: 0.3}\n",
     "s.yaml:4:25: weather.visibility_m: 0.3; allowed: metres from 1 to 1e6, or 0 for clear air"},
    {"HalfALook", kPulsedInWeather + "weather: {fog_looks: 1.5}\n",
     "s.yaml:4:22: weather.fog_looks: 1.5; allowed: a whole number from 0 to 64"},
    {"TooManyLooks", kPulsedInWeather + "weather: {fog_looks: 65}\n",
     "s.yaml:4:22: weather.fog_looks: 65; allowed: a whole number from 0 to 64"},
    {"NegativeRain", kPulsedInWeather + "weather: {rain_mm_per_h: -1}\n",
     "s.yaml:4:26: weather.rain_mm_per_h: -1; allowed: mm/h from 0 to 1000"},
    {"UnknownModel", kPulsedInWeather + "weather: {fog_model: kin}\n",
     "s.yaml:4:22: weather.fog_model: 'kin'; allowed: kim, kruse; did you mean 'kim'?"},
    {"NoPulsedLight", "optics: {width: 4, height: 2, fov_deg: 20}\nweather: {rain_mm_per_h: 1}\n",
     "s.yaml:2:10: weather: given without 'lidar_equation'; allowed: weather for a sensor with "
     "pulsed "
     "light; add 'lidar_equation: ...'"},
    {"NoWavelength",
     "optics: {width: 4, height: 2, fov_deg: 20}\n"
     "lidar_equation: {reference_reflectance: 0.8, reference_range_m: 100}\n"
     "weather: {visibility_m: 100}\n",
     "s.yaml:3:10: weather: a visibility without 'wavelength_nm', on which fog's extinction "
     "depends; allowed: fog for light of a known wavelength; add 'wavelength_nm: ...'"},
};

INSTANTIATE_TEST_SUITE_P(All, WeatherYamlError, ::testing::ValuesIn(kBadWeatherFiles),
                         bad_file_name);

}  // namespace

}  // namespace glidar
