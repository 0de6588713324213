// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/imu.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
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

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using VectorList = ImuSamples::Vectors;

/// Blocks of random words of a triad and purpose.
constexpr std::uint32_t kGyroscope = 0;
constexpr std::uint32_t kAccelerometer = 1;

RngKey key_of(const ImuRun& run, Purpose purpose, std::uint32_t block) {
  return {.seed = run.seed, .sensor = run.imu, .purpose = purpose, .block = block};
}

/// Three normal numbers that an IMU has throughout a run.
Vector3d constant_normals(const ImuRun& run, std::uint32_t triad, std::uint32_t which) {
  constexpr std::uint32_t kPerTriad = 4;
  return normal_vector(key_of(run, Purpose::imu_constants, kPerTriad * triad + which));
}

/// I + S. Each axis is misaligned independently, so S has nine independent entries (Woodman,
/// UCAM-CL-TR-696, section 3.2.5; kalibr's "scale-misalignment" model).
Matrix3d constant_matrix(const InertialTriad& triad, const ImuRun& run, std::uint32_t number) {
  Matrix3d matrix = Matrix3d::Identity();
  const Vector3d scale = triad.scale_error * constant_normals(run, number, 1);
  const Vector3d above = triad.misalignment_rad * constant_normals(run, number, 2);
  const Vector3d below = triad.misalignment_rad * constant_normals(run, number, 3);
  matrix.diagonal() += scale;
  matrix(0, 1) = above[0];
  matrix(0, 2) = above[1];
  matrix(1, 2) = above[2];
  matrix(1, 0) = below[0];
  matrix(2, 0) = below[1];
  matrix(2, 1) = below[2];
  return matrix;
}

double reported(const InertialTriad& triad, double value) {
  if (triad.resolution > 0.0) {
    value = triad.resolution * std::floor(value / triad.resolution + 0.5);
  }
  return std::clamp(value, -triad.range, triad.range);
}

/// The errors of one triad in a run.
struct TriadErrors {
  const InertialTriad& triad;
  std::uint32_t number;
  double rate_hz;
  const ImuRun& run;
  std::uint64_t first;  ///< number of the first sample
  Matrix3d matrix;
  Vector3d turn_on_bias;
};

void sample_biases(const TriadErrors& errors, VectorList& biases) {
  const InertialTriad& triad = errors.triad;
  std::fill(biases.begin(), biases.end(), errors.turn_on_bias);
  add_process(
      correlated_process(correlated_bias_sigma(triad), triad.correlation_time_s, errors.rate_hz),
      key_of(errors.run, Purpose::imu_correlated_bias, errors.number), errors.first, biases);
  add_process(random_walk(triad.random_walk, errors.rate_hz),
              key_of(errors.run, Purpose::imu_random_walk, errors.number), errors.first, biases);
}

void measure_triad(const TriadErrors& errors, const VectorList& truth, VectorList& biases,
                   VectorList& measured) {
  biases.resize(truth.size());
  measured.resize(truth.size());
  sample_biases(errors, biases);
  const double sigma = errors.triad.noise_density * std::sqrt(errors.rate_hz);
  const RngKey key = key_of(errors.run, Purpose::imu_noise, errors.number);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Vector3d value = errors.matrix * truth[i] + biases[i];
    if (sigma > 0.0) value += sigma * normal_vector(key_of_sample(key, errors.first + i));
    for (double& axis : value) axis = reported(errors.triad, axis);
    measured[i] = value;
  }
}

}  // namespace

ImuConstants imu_constants(const Imu& imu, const ImuRun& run) {
  return {.gyroscope_matrix = constant_matrix(imu.gyroscope, run, kGyroscope),
          .accelerometer_matrix = constant_matrix(imu.accelerometer, run, kAccelerometer),
          .gyroscope_bias_rad_s = imu.gyroscope.turn_on_bias * constant_normals(run, kGyroscope, 0),
          .accelerometer_bias_m_s2 =
              imu.accelerometer.turn_on_bias * constant_normals(run, kAccelerometer, 0)};
}

void measure(const Imu& imu, const ImuRun& run, ImuSamples& samples) {
  const ImuConstants constants = imu_constants(imu, run);
  ImuSamples::GroundTruth& truth = samples.ground_truth;
  measure_triad({imu.gyroscope, kGyroscope, imu.rate_hz, run, samples.first,
                 constants.gyroscope_matrix, constants.gyroscope_bias_rad_s},
                truth.angular_velocity_rad_s, truth.gyroscope_bias_rad_s,
                samples.angular_velocity_rad_s);
  measure_triad({imu.accelerometer, kAccelerometer, imu.rate_hz, run, samples.first,
                 constants.accelerometer_matrix, constants.accelerometer_bias_m_s2},
                truth.specific_force_m_s2, truth.accelerometer_bias_m_s2,
                samples.specific_force_m_s2);
}

namespace {

using Eigen::Vector3d;

/// The values of a process that a caller wants.
struct Wanted {
  const BiasProcess& process;
  const RngKey& key;
  std::uint64_t first;
  std::span<Vector3d> values;
};

/// Sample numbers with the values at both ends.
struct ProcessInterval {
  std::uint64_t begin;
  int level;  ///< the length is 2^level
  Vector3d at_begin;
  Vector3d at_end;
};

/// Adds the values of the wanted samples within an interval, without its end.
void descend(const Wanted& wanted, const ProcessInterval& interval) {
  const std::uint64_t end = interval.begin + (std::uint64_t{1} << interval.level);
  if (end <= wanted.first || interval.begin >= wanted.first + wanted.values.size()) return;
  if (interval.level == 0) {
    wanted.values[static_cast<std::size_t>(interval.begin - wanted.first)] += interval.at_begin;
    return;
  }
  const int level = interval.level - 1;
  const BiasProcess::Level& half = wanted.process.levels[static_cast<std::size_t>(level)];
  const std::uint64_t middle = interval.begin + (std::uint64_t{1} << level);
  const Vector3d at_middle = half.weight * (interval.at_begin + interval.at_end) +
                             half.sigma * normal_vector(key_of_sample(wanted.key, middle));
  descend(wanted, {interval.begin, level, interval.at_begin, at_middle});
  descend(wanted, {middle, level, at_middle, interval.at_end});
}

/// 1 - exp(-2 x) without cancellation.
double one_minus_square(double x) {
  constexpr double kSmall = 1e-5;  // below it the omitted term is 1e-15 of the result
  return x < kSmall ? 2.0 * x * (1.0 - x * (1.0 - x * (2.0 / 3.0))) : 1.0 - portable_exp(-2.0 * x);
}

}  // namespace

BiasProcess random_walk(double density, double rate_hz) {
  BiasProcess process;
  const double step = density / std::sqrt(rate_hz);
  process.end_weight = 1.0;
  process.end_sigma = step * std::ldexp(1.0, kMaxSampleBits / 2);
  for (int k = 0; k < kMaxSampleBits; ++k) {
    // Brownian bridge: a quarter of the variance over the whole interval
    process.levels[static_cast<std::size_t>(k)] = {0.5, step * std::sqrt(0.5 * std::ldexp(1.0, k))};
  }
  return process;
}

BiasProcess correlated_process(double sigma, double correlation_time_s, double rate_hz) {
  BiasProcess process;
  const auto steps = [&](int k) { return std::ldexp(1.0, k) / (rate_hz * correlation_time_s); };
  process.start_sigma = sigma;
  process.end_weight = portable_exp(-steps(kMaxSampleBits));
  process.end_sigma = sigma * std::sqrt(one_minus_square(steps(kMaxSampleBits)));
  for (int k = 0; k < kMaxSampleBits; ++k) {
    // the normal distribution of the middle given both ends, with r the correlation over half
    const double r = portable_exp(-steps(k));
    const double sum = 1.0 + r * r;
    process.levels[static_cast<std::size_t>(k)] = {
        r / sum, sigma * std::sqrt(one_minus_square(steps(k)) / sum)};
  }
  return process;
}

RngKey key_of_sample(RngKey key, std::uint64_t sample) {
  key.beam = static_cast<std::uint32_t>(sample);
  key.frame = static_cast<std::uint32_t>(sample >> 32U);
  return key;
}

Vector3d normal_vector(const RngKey& key) {
  const std::array<double, 4> numbers = normals(random_words(key));
  return {numbers[0], numbers[1], numbers[2]};
}

void add_process(const BiasProcess& process, const RngKey& key, std::uint64_t first,
                 std::span<Vector3d> values) {
  if (process.end_sigma == 0.0) return;
  const Vector3d start = process.start_sigma * normal_vector(key_of_sample(key, 0));
  const Vector3d end = process.end_weight * start +
                       process.end_sigma * normal_vector(key_of_sample(key, kMaxSamples));
  descend({process, key, first, values}, {0, kMaxSampleBits, start, end});
}

}  // namespace glidar
