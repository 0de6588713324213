// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/imu/imu.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>

#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr double kHour_s = 3600.0;
constexpr NumberRule kErrorRule = {0.0, 1e9, false, "a number from 0 to 1e9"};
constexpr NumberRule kPercentRule = {0.0, 100.0, false, "percent from 0 to 100"};
constexpr NumberRule kMisalignmentRule = {0.0, 45.0, false, "degrees from 0 to 45"};
constexpr NumberRule kRangeRule = {0.0, 1e9, true, "a number above 0 and below 1e9"};
constexpr NumberRule kTimeRule = {1e-3, 1e9, false, "seconds from 0.001 to 1e9"};
constexpr NumberRule kRateRule = {1e-3, kMaxImuRate_hz, false, "a number from 0.001 to 1e5"};

constexpr FieldUnit kPercent = {"%", 1e-2};

/// A key and its unit.
struct TriadKey {
  const char* key;
  FieldUnit unit;
};

/// The keys whose units differ between gyroscopes and accelerometers.
struct TriadKeys {
  TriadKey noise_density;
  TriadKey random_walk;
  TriadKey bias_instability;
  TriadKey turn_on_bias;
  TriadKey range;
  TriadKey resolution;
};

constexpr double kMilliG_m_s2 = 1e-3 * kStandardGravity_m_s2;
constexpr double kMicroG_m_s2 = 1e-6 * kStandardGravity_m_s2;

constexpr TriadKeys kGyroscopeKeys = {
    .noise_density = {"noise_density_deg_s_sqrt_hz", {"deg/s/√Hz", kDegree}},
    .random_walk = {"random_walk_deg_s2_sqrt_hz", {"deg/s²/√Hz", kDegree}},
    .bias_instability = {"bias_instability_deg_h", {"deg/h", kDegree / kHour_s}},
    .turn_on_bias = {"turn_on_bias_deg_s", {"deg/s", kDegree}},
    .range = {"range_deg_s", {"deg/s", kDegree}},
    .resolution = {"resolution_deg_s", {"deg/s", kDegree}}};

constexpr TriadKeys kAccelerometerKeys = {
    .noise_density = {"noise_density_ug_sqrt_hz", {"µg/√Hz", kMicroG_m_s2}},
    .random_walk = {"random_walk_ug_s_sqrt_hz", {"µg/s/√Hz", kMicroG_m_s2}},
    .bias_instability = {"bias_instability_ug", {"µg", kMicroG_m_s2}},
    .turn_on_bias = {"turn_on_bias_mg", {"mg", kMilliG_m_s2}},
    .range = {"range_g", {"g", kStandardGravity_m_s2}},
    .resolution = {"resolution_mg", {"mg", kMilliG_m_s2}}};

void describe_triad(const TriadKeys& keys, InertialTriad& triad, FieldVisitor& visitor) {
  const auto number = [&](const TriadKey& key, const char* text, double& value) {
    visitor.number({key.key, text, key.unit}, kErrorRule, value);
  };
  number(keys.noise_density, "white noise: Allan deviation at 1 s", triad.noise_density);
  number(keys.random_walk, "random walk of the bias: Allan deviation at 3 s", triad.random_walk);
  number(keys.bias_instability, "correlated bias: maximum of its Allan deviation",
         triad.bias_instability);
  visitor.number({"correlation_time_s", "of the correlated bias", kUnitSecond}, kTimeRule,
                 triad.correlation_time_s);
  number(keys.turn_on_bias, "constant bias of each unit, standard deviation", triad.turn_on_bias);
  visitor.number({"scale_error_percent", "of each axis, standard deviation", kPercent},
                 kPercentRule, triad.scale_error);
  visitor.number(
      {"misalignment_deg", "of each axis about each other axis, standard deviation", kUnitDegree},
      kMisalignmentRule, triad.misalignment_rad);
  visitor.number(
      {keys.range.key, "larger values are reported as this", keys.range.unit, false, "no limit"},
      kRangeRule, triad.range);
  number(keys.resolution, "step of the reported values; 0: none", triad.resolution);
}

[[noreturn]] void refuse_number(const std::string& where, double found, const char* allowed) {
  throw Error({where, number_text(found), allowed});
}

/// What the bounds of the keys mean in SI units, with a margin for their conversion.
void check(const InertialTriad& triad, const std::string& name) {
  constexpr double kMax = 1.1e9 * kStandardGravity_m_s2;
  const auto require = [&](const char* field, double value, double max) {
    if (value >= 0.0 && value <= max) return;
    refuse_number(name + ", " + field, value, "a finite number from 0, as IMU files have");
  };
  require("noise density", triad.noise_density, kMax);
  require("random walk", triad.random_walk, kMax);
  require("bias instability", triad.bias_instability, kMax);
  require("turn-on bias", triad.turn_on_bias, kMax);
  require("scale error", triad.scale_error, 1.0);
  require("misalignment", triad.misalignment_rad, 1.0);
  require("resolution", triad.resolution, kMax);
  if (!(triad.range > 0.0)) refuse_number(name + ", range", triad.range, "a number above 0");
  if (!accepts(kTimeRule, triad.correlation_time_s)) {
    refuse_number(name + ", correlation time", triad.correlation_time_s, kTimeRule.allowed);
  }
}

}  // namespace

Imu ground_truth_imu(Imu imu) {
  return {
      .name = std::move(imu.name), .rate_hz = imu.rate_hz, .gyroscope = {}, .accelerometer = {}};
}

double correlated_bias_sigma(const InertialTriad& triad) {
  constexpr double kPeak = 0.6173642831443085;
  return triad.bias_instability / kPeak;
}

void validate(const Imu& imu) {
  require_number(imu.rate_hz >= kRateRule.min && imu.rate_hz <= kRateRule.max, "imu, rate",
                 imu.rate_hz, "samples per second from 0.001 to 1e5");
  check(imu.gyroscope, "imu, gyroscope");
  check(imu.accelerometer, "imu, accelerometer");
}

void describe(Imu& imu, FieldVisitor& visitor) {
  visitor.text({"name", "of the IMU"}, imu.name);
  visitor.number({"rate_hz", "samples per second", kUnitHertz}, kRateRule, imu.rate_hz);
  const auto gyroscope = [&](FieldVisitor& nested) {
    describe_triad(kGyroscopeKeys, imu.gyroscope, nested);
  };
  visitor.object({"gyroscope", "errors of the gyroscopes"}, true,
                 FieldVisitor::Describe(gyroscope));
  const auto accelerometer = [&](FieldVisitor& nested) {
    describe_triad(kAccelerometerKeys, imu.accelerometer, nested);
  };
  visitor.object({"accelerometer", "errors of the accelerometers"}, true,
                 FieldVisitor::Describe(accelerometer));
  visitor.provenance({"source", "where the numbers come from: text for keys of this map"}, true);
  visitor.provenance(
      {"unverified", "keys that were not checked against the manufacturer's documents"}, false);
}

}  // namespace glidar
