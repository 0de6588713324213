// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_document.hpp>

#include <glidar/core/unit_conversion.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/io/formats/sidecar.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <random>

namespace glidar {
namespace {

/// Whether two lists hold the same bytes; for numbers side by side, NaN being NaN.
template <class Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(static_cast<const void*>(a.data()),
                                                           static_cast<const void*>(b.data()),
                                                           a.size() * sizeof(Value)) == 0);
}

void expect_same(const Beams& a, const Beams& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.cols, b.cols);
  EXPECT_TRUE(same_bits(a.directions, b.directions));
  EXPECT_TRUE(same_bits(a.origins_m, b.origins_m));
  EXPECT_TRUE(same_bits(a.times_ns, b.times_ns));
  EXPECT_TRUE(same_bits(a.rings, b.rings));
}

/// Documents differ where a bit does: their numbers are exact and written in full.
void expect_same_noise(const Sensor& one, const Sensor& other) {
  ASSERT_EQ(one.noise.size(), other.noise.size());
  for (std::size_t k = 0; k < one.noise.size(); ++k) {
    ASSERT_EQ(one.noise[k].index(), other.noise[k].index());
    EXPECT_EQ(write_struct(FieldVisitor::Mode::document, one.noise[k]).dump(),
              write_struct(FieldVisitor::Mode::document, other.noise[k]).dump());
  }
}

/// Writes the sensor and reads it again; everything must be the same to the last bit.
Sensor expect_round_trip(const Sensor& sensor) {
  const auto* table = std::get_if<RayTable>(&sensor.optics);
  const std::string text = sensor_document(sensor);
  Sensor read = table != nullptr ? parse_sensor(text, *table) : parse_sensor(text);
  EXPECT_EQ(sensor_document(read), text);
  const Beams beams = make_beams(sensor);
  const Beams read_beams = make_beams(read);
  expect_same(beams, read_beams);
  EXPECT_EQ(sensor_to_json(read, read_beams), sensor_to_json(sensor, beams));
  expect_same(make_beams(sensor, frame_interval(sensor, 3)),
              make_beams(read, frame_interval(read, 3)));
  expect_same_noise(sensor, read);
  return read;
}

TEST(SensorDocument, EveryPresetReadsBackTheSameToTheLastBit) {
  for (const SensorPreset& preset : sensor_presets()) {
    SCOPED_TRACE(preset.name);
    const Sensor sensor = load_sensor_file(preset.reference);
    expect_round_trip(sensor);
    expect_round_trip(ground_truth_sensor(sensor));
  }
}

/// Steps with what they need alone, and with numbers whose digits do not end in binary. RoundTrip
/// has every kind.
TEST(SensorDocument, NoiseReadsBackTheSame) {
  const std::vector<std::string> steps = {
      "range_gaussian",
      "range_gaussian, sigma_m: 0.1, sigma_per_m: 0.003",
      "range_snr, k_m: 0.1, snr_at_full_scale: 33.3, floor_m: 0.007",
      "range_crlb, pulse_fwhm_ns: 5.3, sample_ns: 0.7, noise: 0.01",
      "range_shot_noise, pulse_fwhm_ns: 3.1, photons_at_full_scale: 1234.5",
      "range_uniform",
      "range_uniform, additive_m: 0.1, multiplicative: 0.01, distribution: normal",
      "range_quantization, step_m: 0.004",
      "range_bias",
      "range_bias, offset_m: -0.03, sigma_m: 0.01",
      "range_drift, sigma_m: 0.1, tau_s: 77.7, per_ring: true",
      "dropout",
      "dropout, probability: 0.1, by_range_m: [[1, 0.1], [7.7, 0.9]], by_incidence_deg: [[10.1, "
      "0], "
      "[77.7, 0.3]]",
      "crosstalk, probability: 0.01, near_m: 0.3",
      "false_alarms, rate_hz: 1e4, near_m: 0.1, far_m: 99.9, intensity: 0.3",
      "disparity_quantization, k_m: 0.003, offset_steps: -0.3",
      "kinect_v1",
      "kinect_v1, k_m: 0.0028, offset_steps: 0.7, sigma_steps: 0.3, window: 9",
      "khoshelham",
      "nguyen_axial",
      "nguyen_lateral, a_px: 0.8, b_px: 0.035",
      "icl_kinect",
      "stereo, focal_px: 383.7, baseline_m: 0.05, sigma_px: 0.08, step_px: 0.03",
      "continuous_wave, frequencies_hz: [80e6, 16e6, 120e6], electrons_at_full_scale: 5e4",
      "continuous_wave, frequencies_hz: [20e6], electrons_at_full_scale: 5e4, max_phase_residual: "
      "0.3",
      "intensity_gaussian, sigma: 0.01, relative: 0.003",
      "intensity_scale",
      "intensity_scale, kind: vendor, gain: 1.1, reference_m: 0.3, max_reflectance: 255.5",
      "pointing_jitter, sigma_azimuth_deg: 0.013, sigma_elevation_deg: 0.007",
      "encoder_error, step_deg: 0.011, eccentricity_deg: 0.003, phase_deg: 77.7, turn_sigma_deg: "
      "0.017"};
  for (const std::string& step : steps) {
    SCOPED_TRACE(step);
    const Sensor sensor =
        parse_sensor("{optics: {width: 4, height: 3, fov_deg: 20}, noise: [{type: " + step + "}]}");
    expect_round_trip(sensor);
  }
}

TEST(SensorDocument, EveryKindOfOpticsReadsBackTheSame) {
  for (const char* optics : {
           "width: 7, height: 5, fov_deg: 33.3",
           "width: 7, height: 5, fov_x_deg: 33.3, pixel_centre: 0, distortion: {model: "
           "radial_tangential, k1: 0.1, k2: -0.02, p1: 0.003, p2: -0.004, k3: 0.05, k6: 0.1}",
           "width: 7, height: 5, fx: 10.1, fy: 10.3, cx: 3.3, cy: 2.2, distortion: {model: "
           "fisheye, "
           "k1: 0.1, k4: 0.003}",
           "type: spinning, elevation_deg: [-15.1, 0.7, 2], azimuth_right_deg: [0.1, 7.7, -3.3], "
           "fire_time_us: [0, 2.304, 4.608], firing_period_us: 55.296, beam_origin_axial_mm: 7.7, "
           "beam_origin_radial_mm: [1.1, 2.2, 3.3], channel_order: rising_elevation, "
           "rotation_direction: "
           "counterclockwise, "
           "start_azimuth_deg: 33.3",
           "type: spinning, elevation_deg: [3, 1], columns_per_turn: 90, beam_origin_mm: 15.806, "
           "azimuth_range: {from_deg: 170.1, to_deg: 190.3}",
           "type: spinning, elevation_deg: [3, 1], columns_per_turn: 90, azimuth_range: {from_rad: "
           "-0.7000000000000001, width_rad: 1.2345678901234567}",
           "type: line_scan, azimuth_deg: {from: -35.1, to: 35.3, count: 71}, elevation_deg: [1.1, "
           "0.7], point_us: 7.7, bidirectional: true",
           "type: line_scan, azimuth_deg: [3.3, 1.1], point_us: 0.3, line_us: 1.7",
           "type: prism, pulse_hz: 1003.3, incidence_deg: [-5.7, 17.1], incidence_roll_deg: 33.7, "
           "prisms: [{rotation_hz: "
           "121.3, apex_deg: 18.1, refractive_index: 1.51, phase_deg: 33.3}, {rotation_hz: -77.7, "
           "apex_deg: 17.3, refractive_index: 1.51, slope: exit}]",
       }) {
    SCOPED_TRACE(optics);
    expect_round_trip(parse_sensor(std::string("{rate_hz: 11.1, optics: {") + optics + "}}"));
  }
}

TEST(SensorDocument, LightReceiverWeatherAndLimitsReadBackTheSame) {
  const std::string pulse =
      "{name: 'a \"name\": \xC3\xA4 \xF0\x9F\x98\x80', wavelength_nm: 905.3, cull_back_faces: "
      "true, "
      "optics: {type: line_scan, azimuth_deg: [1, 2]}, "
      "limits: {near_m: 0.3, far_m: 99.9, along: depth}, lidar_equation: {reference_reflectance: "
      "0.8, "
      "reference_range_m: 77.7, range90_m: 70.1, range_exponent: 2.1, overlap: [[0, 0.1], [3.3, "
      "1]], saturation: 1e5, extinction_per_m: 1e-4}, ";
  for (const char* rest : {
           "footprint: {divergence_mrad: [3.3, 1.1], exit_mm: 7.7, rings: 3}",
           "footprint: {divergence_mrad: [3.3, 1.1], exit_mm: 7.7, width_definition: fwhm}, "
           "receiver: "
           "{pulse_ns: 5.3, timing: leading_edge, min_return_separation_m: 0.7, returns: 5}",
           "receiver: {returns: [strongest, last, second_strongest]}, weather: {visibility_m: "
           "77.7, "
           "visibility_kind: mor, fog_model: kruse, rain_mm_per_h: 3.3, rain_model: goodin, "
           "snow_mm_per_h: 0.7, snow_model: sekhon_srivastava, min_signal: 0.3}",
       }) {
    SCOPED_TRACE(rest);
    const Sensor sensor = parse_sensor(pulse + rest + "}");
    EXPECT_EQ(expect_round_trip(sensor).name, sensor.name);
  }
  expect_round_trip(parse_sensor(
      "{optics: {width: 4, height: 3, fov_deg: 20}, projector_origin_m: [0.075, -0.1, 0.3], "
      "limits: {near_m: 0.1, along: range}, light: {ambient: 0.3, attenuation: "
      "{constant: 0.1, linear_per_m: 0.3}}}"));
}

TEST(SensorDocument, TableOfBeamsIsPassedBesideTheText) {
  RayTable table;
  table.rows = 1;
  table.cols = 3;
  table.directions = {{1, 0, 0}, {1, 0.1, 0.2}, {std::nan(""), 0, 0}};
  table.times_ns = {0.0, 10.1, 20.2};
  table.period_ns = 30.3;
  table.rings = {7, 3, 1};
  const Sensor sensor = parse_sensor("{name: rays, rate_hz: 1e6}", table);
  EXPECT_EQ(sensor_document(sensor).find("optics"), std::string::npos);
  expect_round_trip(sensor);
  const TestFolder folder;
  EXPECT_EQ(error_of(folder, [&] { parse_sensor("{optics: {width: 1}}", table); }),
            "sensor: optics: given beside a table of beams; allowed: one of the two; remove one of "
            "them");
}

/// Every angle in degrees has one that gives the same radians, whatever its digits: 100000 random
/// ones, of which none may be missed.
TEST(ExactUnit, FindsTheNumberOfTheFileAgain) {
  constexpr double kRadian = std::numbers::pi / 180.0;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(-360.0, 360.0);
  for (int k = 0; k < 100000; ++k) {
    const double inside = angle(random) * kRadian;
    const std::optional<double> found = find_exact_in(inside, kRadian);
    ASSERT_TRUE(found);
    ASSERT_EQ(*found * kRadian, inside);
  }
  EXPECT_EQ(find_exact_in(-0.0, 1e-3).value(), 0.0);
  EXPECT_TRUE(std::signbit(find_exact_in(-0.0, 1e-3).value()));
}

/// About a tenth of all numbers are no product; then there is an error and nothing is rounded.
TEST(ExactUnit, NumberThatIsNoProductIsRefusedNotRounded) {
  constexpr double kRadian = std::numbers::pi / 180.0;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(0.0, 6.0);
  int missed = 0;
  for (int k = 0; k < 1000; ++k) {
    const double inside = angle(random);
    if (find_exact_in(inside, kRadian)) continue;
    ++missed;
    EXPECT_THROW(exact_in(inside, kRadian), Error);
  }
  EXPECT_GT(missed, 0);
}

TEST(ImplausibleNumbers, OfPresetsThereAreNone) {
  for (const SensorPreset& preset : sensor_presets()) {
    EXPECT_THAT(implausible_numbers(load_sensor_file(preset.reference)), ::testing::IsEmpty())
        << preset.name;
  }
}

TEST(ImplausibleNumbers, AreNamedWithTheirKeyAndAGuess) {
  Spinning spinning;
  spinning.channels.resize(2);
  spinning.channels[0].elevation_rad = -0.0045;
  spinning.channels[1].elevation_rad = 0.0045;
  spinning.channels[1].ring = 1;
  spinning.columns_per_turn = 900;
  Sensor sensor;
  sensor.optics = spinning;
  sensor.lidar_equation = LidarEquation{.reference_reflectance = 80.0};
  sensor.noise = {RangeGaussian{.sigma_m = 30.0}};
  EXPECT_THAT(implausible_numbers(sensor),
              ::testing::UnorderedElementsAre(
                  "optics.elevation_deg: from -0.257831 to 0.257831; usual: at least 1 between "
                  "them; are these radians?",
                  "lidar_equation.reference_reflectance: 80; usual: 0.001 to 1.5; is this in "
                  "percent?",
                  "noise[0].sigma_m: 30; usual: 0 to 3; is this in millimetres?"));
}

}  // namespace
}  // namespace glidar
