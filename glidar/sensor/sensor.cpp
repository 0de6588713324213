// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

#include <glidar/core/dot_product.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/point_cloud.hpp>
#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/math/simd.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidar {
namespace {

bool is_unlimited(const Limits& limits) {
  return limits.near_m <= 0.0 && std::isinf(limits.far_m);
}

Status status_at(const Limits& limits, double distance_m) {
  if (limits.near_m > 0.0 && distance_m < limits.near_m) return Status::too_near;
  if (distance_m > limits.far_m) return Status::too_far;
  return Status::hit;
}

/// What the limits apply to: depths, or ranges as reported.
GLIDAR_SIMD void find_distances(const Limits& limits, const Beams& beams, BeamRange range,
                                const std::vector<double>& ranges_m, Batch<double>& distance_m) {
  const std::size_t count = range.end - range.begin;
  const double* const range_m = ranges_m.data() + range.begin;
  if (limits.along == Limits::Along::range) {
    const double offset_m = beams.range_offset_m;
    for (std::size_t k = 0; k < count; ++k) distance_m[k] = range_m[k] + offset_m;
    return;
  }
  const Eigen::Vector3d boresight = beams.boresight;
  const Eigen::Vector3d* const directions = beams.directions.data() + range.begin;
  for (std::size_t k = 0; k < count; ++k) {
    distance_m[k] = range_m[k] * dot_product(directions[k], boresight);  // as depth_m()
  }
  if (beams.origins_m.empty()) return;
  const Eigen::Vector3d* const origins_m = beams.origins_m.data() + range.begin;
  for (std::size_t k = 0; k < count; ++k) {
    distance_m[k] += dot_product(origins_m[k], boresight);
  }
}

/// Ranges and statuses, as check_limits() of each hit.
GLIDAR_SIMD void classify_batch(const Limits& limits, const Batch<double>& distance_m,
                                BeamRange range, Frame& frame) {
  static_assert(static_cast<unsigned>(Status::hit) == 0);
  constexpr auto kMiss = static_cast<unsigned>(Status::miss);
  constexpr auto kTooNear = static_cast<unsigned>(Status::too_near);
  constexpr auto kTooFar = static_cast<unsigned>(Status::too_far);
  const double near_m = limits.near_m > 0.0 ? limits.near_m : -kInfinity;
  const double far_m = limits.far_m;
  const double* const true_range_m = frame.ground_truth.range_m.data() + range.begin;
  double* const range_m = frame.range_m.data() + range.begin;
  Status* const status = frame.status.data() + range.begin;
  for (std::size_t k = 0; k < range.end - range.begin; ++k) {
    // Integers, of which at most one is 1, so that the loop vectorises.
    const auto is_miss = static_cast<unsigned>(true_range_m[k] != true_range_m[k]);
    const auto is_near = static_cast<unsigned>(distance_m[k] < near_m);
    const auto is_far = static_cast<unsigned>(distance_m[k] > far_m) & (is_near ^ 1U);
    status[k] = static_cast<Status>(is_miss * kMiss + is_near * kTooNear + is_far * kTooFar);
    range_m[k] = (is_near | is_far) != 0 ? kNaN : true_range_m[k];
  }
}

/// Calls body(batch) for the batches of a run of beams.
template <class Body>
void for_sample_batches(BeamRange beams, const Body& body) {
  for (std::size_t begin = beams.begin; begin < beams.end; begin += kSampleBatch)
    body(BeamRange{begin, std::min(begin + kSampleBatch, beams.end)});
}

void remove_batch(const Limits& limits, const Beams& beams, BeamRange run, Frame& frame) {
  Batch<double> distance_m{};
  find_distances(limits, beams, run, frame.range_m, distance_m);
  for (std::size_t i = run.begin; i < run.end; ++i) {
    if (frame.status[i] != Status::hit) continue;
    const Status status = status_at(limits, distance_m[i - run.begin]);
    if (status != Status::hit) invalidate_return(frame, i, status);
  }
}

}  // namespace

Status check_limits(const Limits& limits, const Beams& beams, std::size_t beam, double range_m) {
  const double distance = limits.along == Limits::Along::depth ? depth_m(beams, beam, range_m)
                                                               : range_m + beams.range_offset_m;
  return status_at(limits, distance);
}

void classify_surfaces(const Limits& limits, const Beams& beams, BeamRange tile, Frame& frame) {
  Batch<double> distance_m{};
  for_sample_batches(tile, [&](BeamRange run) {
    if (!is_unlimited(limits))
      find_distances(limits, beams, run, frame.ground_truth.range_m, distance_m);
    classify_batch(limits, distance_m, run, frame);
  });
  if (beams.pinhole) return;
  for (std::size_t i = tile.begin; i < tile.end; ++i) {
    if (frame.status[i] != Status::miss) continue;
    if (std::isnan(beams.directions[i].x())) frame.status[i] = Status::invalid_pixel;
  }
}

void remove_returns_outside(const Limits& limits, const Beams& beams, ThreadPool& thread_pool,
                            Frame& frame) {
  if (is_unlimited(limits)) return;
  thread_pool.parallel_for(beams.size(), 8 * kSampleBatch, [&](std::size_t begin, std::size_t end) {
    for_sample_batches({begin, end},
                       [&](BeamRange run) { remove_batch(limits, beams, run, frame); });
  });
}

double to_whole_units(const Limits& limits, Limits::Along along, double distance_m, double unit_m) {
  constexpr double kRounding = 1e-6;  // of the quotients, in units
  const double nearest = std::floor(distance_m / unit_m + 0.5);
  if (limits.along != along) return nearest;
  const double min =
      limits.near_m > 0.0 ? std::ceil(limits.near_m / unit_m - kRounding) : -kInfinity;
  const double max = std::floor(limits.far_m / unit_m + kRounding);
  const double within = std::min(std::max(nearest, min), max);
  return std::abs(within - nearest) <= 1.0 ? within : nearest;
}

void describe(Limits& limits, FieldVisitor& visitor) {
  using Along = Limits::Along;
  constexpr std::array<Named<Along>, 2> kNames = {
      {{"depth", Along::depth}, {"range", Along::range}}};
  visitor.number({"near_m", "shortest reported distance", kUnitMetre}, kFromZero, limits.near_m);
  visitor.number(
      {"far_m", "longest reported distance, beyond `near_m`", kUnitMetre, false, "no limit"},
      kAboveZero, limits.far_m);
  visit_choice(visitor,
               {"along", "whether limits apply along the boresight or along the beam", kNoUnit,
                false, "`depth` for cameras, else `range`"},
               kNames, limits.along);
  if (visitor.is_reading() && limits.far_m <= limits.near_m) {
    visitor.reject("far_m", "{}, not beyond near_m", "a finite number above near_m");
  }
}

namespace {

/// Equation (3): attenuation at the distance d between surface and sensor.
inline double attenuation(const PhongHeadlight& light, double d) {
  return 1.0 / (light.attenuation_constant + light.attenuation_linear_per_m * d +
                light.attenuation_quadratic_per_m2 * d * d);
}

/// max(n . h, 0) with the half-vector h = l of equation (2): l = v = -direction.
inline float clamped_cosine(float cos_shading) {
  return cos_shading > 0.0F ? cos_shading : 0.0F;
}

/// The ambient and diffuse terms of equation (5).
inline float ambient_and_diffuse(const Reflectance& surface, float ambient, float n_dot_h) {
  return ambient * surface.ambient + surface.diffuse * n_dot_h;
}

/// Equations (3) to (5) without the specular term. Returns true if a surface has one.
GLIDAR_SIMD bool shade_diffuse(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  const Hits& hits = frame.ground_truth;
  const auto ambient = static_cast<float>(light.ambient);
  unsigned specular = 0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reflectance& surface = hits.reflectance[i];
    const float n_dot_h = clamped_cosine(hits.cos_shading[i]);
    const auto received = static_cast<float>(attenuation(light, hits.range_m[i])) *
                          ambient_and_diffuse(surface, ambient, n_dot_h);
    frame.intensity[i] = frame.status[i] == Status::hit ? received : 0.0F;
    specular |= static_cast<unsigned>(surface.specular > 0.0F);
  }
  return specular != 0;
}

/// Raises the first `count` numbers, rounded up to whole vectors.
GLIDAR_SIMD void raise(std::size_t count, const Batch<double>& exponent, Batch<double>& base) {
  constexpr std::size_t kWidth = 8;
  for (std::size_t first = 0; first < count; first += kWidth) {
    for (std::size_t k = first; k < first + kWidth; ++k) {
      base[k] = portable_pow(base[k], exponent[k]);
    }
  }
}

/// What the specular term raises to a power, and the exponents.
GLIDAR_SIMD void find_lobes(BeamRange range, const Hits& hits, Batch<double>& lobe,
                            Batch<double>& shininess) {
  const float* const cos_shading = hits.cos_shading.data() + range.begin;
  const Reflectance* const surface = hits.reflectance.data() + range.begin;
  for (std::size_t k = 0; k < range.end - range.begin; ++k) {
    lobe[k] = clamped_cosine(cos_shading[k]);
    shininess[k] = surface[k].shininess;
  }
}

/// Equations (3) to (5) where a surface has a specular term.
GLIDAR_SIMD void shade_specular(const PhongHeadlight& light, BeamRange range,
                                const Batch<double>& lobe, Frame& frame) {
  const Hits& hits = frame.ground_truth;
  const auto ambient = static_cast<float>(light.ambient);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reflectance& surface = hits.reflectance[i];
    const float colour =
        ambient_and_diffuse(surface, ambient, clamped_cosine(hits.cos_shading[i])) +
        surface.specular * static_cast<float>(lobe[i - range.begin]);
    const float received = static_cast<float>(attenuation(light, hits.range_m[i])) * colour;
    const bool is_lit = frame.status[i] == Status::hit && surface.specular > 0.0F;
    frame.intensity[i] = is_lit ? received : frame.intensity[i];
  }
}

/// Equations (3) to (5) for a batch with surfaces that have a specular term.
void measure_specular(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  Batch<double> lobe{};
  Batch<double> shininess{};
  find_lobes(range, frame.ground_truth, lobe, shininess);
  raise(range.end - range.begin, shininess, lobe);
  shade_specular(light, range, lobe, frame);
}

}  // namespace

void validate(const PhongHeadlight& light) {
  const auto good = [](double value) { return std::isfinite(value) && value >= 0.0; };
  const double sum = light.attenuation_constant + light.attenuation_linear_per_m +
                     light.attenuation_quadratic_per_m2;
  if (good(light.attenuation_constant) && good(light.attenuation_linear_per_m) &&
      good(light.attenuation_quadratic_per_m2) && good(light.ambient) && sum > 0.0) {
    return;
  }
  throw Error({.where = "light",
               .found = "a number is negative or not finite, or all attenuation coefficients are 0",
               .allowed = "finite numbers of at least 0, and one attenuation coefficient above 0"});
}

void shade_phong(const PhongHeadlight& light, BeamRange range, Frame& frame) {
  for (std::size_t begin = range.begin; begin < range.end; begin += kSampleBatch) {
    const BeamRange run{begin, std::min(begin + kSampleBatch, range.end)};
    if (shade_diffuse(light, run, frame)) measure_specular(light, run, frame);
  }
}

namespace {

template <class T>
void repeat(std::vector<T>& column, std::size_t times) {
  const std::size_t size = column.size();
  column.reserve(size * times);
  for (std::size_t k = 1; k < times; ++k) {
    column.insert(column.end(), column.begin(), column.begin() + static_cast<std::ptrdiff_t>(size));
  }
}

/// Repeats every beam once for each return.
void repeat_for_returns(std::size_t returns, Beams& beams) {
  if (returns == 1) return;
  if (beams.rings.empty()) {
    for (std::size_t i = 0; i < beams.size(); ++i) {
      beams.rings.push_back(static_cast<std::uint16_t>(i / beams.cols));
    }
  }
  repeat(beams.directions, returns);
  repeat(beams.origins_m, returns);
  repeat(beams.times_ns, returns);
  repeat(beams.rings, returns);
  beams.rows *= static_cast<std::uint32_t>(returns);
  beams.returns = static_cast<std::uint32_t>(returns);
  beams.pinhole.reset();  // no longer one grid
}

std::size_t channels_of(const Pinhole& /*optics*/) {
  return 1;
}
std::size_t channels_of(const Spinning& optics) {
  return optics.channels.size();
}
std::size_t channels_of(const LineScan& optics) {
  const bool is_vertical = optics.lines == LineScan::Lines::vertical;
  return is_vertical ? optics.azimuths_rad.size() : optics.elevations_rad.size();
}
std::size_t channels_of(const Prism& optics) {
  return optics.incidence_rad.size();
}
std::size_t channels_of(const WedgeMirror& optics) {
  return optics.incidence_rad.size();
}
std::size_t channels_of(const RayTable& optics) {
  return optics.rows;
}

/// Stereo images are rectified.
void check_pinhole(const ActiveStereo& camera, const Pinhole& pinhole) {
  if (!is_perspective(pinhole)) {
    throw Error({.where = "depth_camera",
                 .found = "the optics have a lens distortion",
                 .allowed = "optics without distortion: stereo images are rectified",
                 .remedy = "remove 'distortion', or 'depth_camera'"});
  }
  check_image(camera, pinhole.intrinsics);
}

void check_pinhole(const TofCamera& camera, const Pinhole& pinhole) {
  validate(camera);
  check_sub_rays(pinhole.intrinsics, camera.sub_rays);
}

void check_pinhole(const StructuredLightCamera& camera, const Pinhole& pinhole) {
  validate(camera);
  check_sub_rays(pinhole.intrinsics, camera.sub_rays);
  check_image(camera, pinhole.intrinsics);
}

}  // namespace

void set_depth_model(DepthModel model, const std::string& where, Sensor& sensor) {
  if (model == DepthModel::physical && !sensor.depth_camera) {
    throw Error({.where = where,
                 .found = "physical, but the sensor '" + sensor.name + "' has no depth_camera",
                 .allowed = "law, or a sensor with a depth_camera such as D435",
                 .remedy = "choose another sensor, or add 'depth_camera' to a sensor file"});
  }
  sensor.depth_model = model;
}

const DepthCamera* physical_camera(const Sensor& sensor) {
  const bool is_physical = sensor.depth_model == DepthModel::physical && sensor.depth_camera;
  return is_physical ? &*sensor.depth_camera : nullptr;
}

void check_depth_camera(const Sensor& sensor) {
  if (!sensor.depth_camera) return;
  const auto* pinhole = std::get_if<Pinhole>(&sensor.optics);
  if (pinhole == nullptr) {
    throw Error({.where = "depth_camera",
                 .found = "the optics are not a pinhole",
                 .allowed = "optics of type pinhole",
                 .remedy = "change 'optics', or remove 'depth_camera'"});
  }
  if (!(sensor.wavelength_m > 0.0)) {
    throw Error({.where = "depth_camera",
                 .found = "no 'wavelength_nm', on which reflectances and photons depend",
                 .allowed = "light of a known wavelength",
                 .remedy = "add 'wavelength_nm: ...'"});
  }
  std::visit([&](const auto& camera) { check_pinhole(camera, *pinhole); }, *sensor.depth_camera);
}

Sensor ground_truth_sensor(Sensor sensor) {
  sensor.lidar_equation.reset();
  sensor.footprint.reset();
  sensor.weather.reset();
  sensor.projector_origin_m.reset();
  sensor.receiver = {};
  if (sensor.doppler) sensor.doppler = Doppler{};
  sensor.noise.clear();
  sensor.depth_model = DepthModel::law;
  return sensor;
}

void set_rate(Sensor& sensor, double rate_hz) {
  require_number(rate_hz >= 1e-6 && rate_hz <= 1e9, "optics, rate", rate_hz,
                 "frames per second from 1e-6 to 1e9");
  sensor.rate_hz = rate_hz;
  if (auto* spinning = std::get_if<Spinning>(&sensor.optics)) spinning->rotation_hz = rate_hz;
  if (auto* raster = std::get_if<LineScan>(&sensor.optics)) raster->scan_hz = rate_hz;
}

void check_weather(const Sensor& sensor) {
  if (!sensor.weather) return;
  if (!sensor.lidar_equation) {
    throw Error({.where = "weather",
                 .found = "the sensor '" + sensor.name + "' has no lidar_equation",
                 .allowed = "weather for a sensor with 'lidar_equation'",
                 .remedy = "add 'lidar_equation' to a sensor file (docs/files.md)"});
  }
  extinction_per_m(*sensor.weather, sensor.wavelength_m);
}

void check_doppler(const Sensor& sensor) {
  if (!sensor.doppler || std::isfinite(sensor.doppler->max_m_s)) return;
  const bool has_false_alarms =
      std::any_of(sensor.noise.begin(), sensor.noise.end(),
                  [](const NoiseStep& step) { return std::holds_alternative<FalseAlarms>(step); });
  if (!has_false_alarms) return;
  throw Error({.where = "doppler",
               .found = "no max_m_s beside the noise step 'false_alarms'",
               .allowed = "a limit up to which the velocities of false alarms are uniform",
               .remedy = "add 'max_m_s: ...' to 'doppler'"});
}

void check_columns(const Sensor& sensor, std::span<const std::string> column_names) {
  const bool is_named =
      std::find(column_names.begin(), column_names.end(), "radial_velocity") != column_names.end();
  if (sensor.doppler || !is_named || column_names.size() == cloud_column_names().size()) return;
  throw Error({.where = "cloud column 'radial_velocity'",
               .found = "the sensor '" + sensor.name + "' does not measure it",
               .allowed = "true_radial_velocity, or a sensor with 'doppler'",
               .remedy = "add 'doppler: {}' to a sensor file (docs/doppler.md)"});
}

std::size_t channel_count(const Optics& optics) {
  return std::visit([](const auto& alternative) { return channels_of(alternative); }, optics);
}

void check_channel_ranges(const Sensor& sensor) {
  if (!sensor.lidar_equation || sensor.lidar_equation->channel_range_m.empty()) return;
  const std::size_t channels = channel_count(sensor.optics);
  const std::size_t found = sensor.lidar_equation->channel_range_m.size();
  if (found == channels) return;
  throw Error({.where = "lidar_equation, channel_range_m",
               .found = std::to_string(found) + " ranges for " + std::to_string(channels) +
                        (channels == 1 ? " channel" : " channels"),
               .allowed = "one range for each channel of the optics",
               .remedy = "add or remove ranges, or leave channel_range_m out"});
}

FrameInterval frame_interval(const Sensor& sensor, std::uint32_t frame) {
  const auto start_of = [&](double count) {
    return static_cast<std::int64_t>(std::llround(count * kSecond_ns / sensor.rate_hz));
  };
  return {start_of(frame), start_of(frame + 1.0)};
}

Beams make_beams(const Sensor& sensor, const FrameInterval& interval) {
  try {
    Beams beams =
        std::visit([&](const auto& optics) { return make_beams(optics, interval); }, sensor.optics);
    repeat_for_returns(sensor.receiver.returns.size(), beams);
    return beams;
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    parts.where = "sensor '" + excerpt(sensor.name) + "': " + parts.where;
    throw Error(parts);
  }
}

Beams make_beams(const Sensor& sensor) {
  return make_beams(sensor, frame_interval(sensor, 0));
}

BeamCache::BeamCache(Sensor sensor)
    : sensor_(std::move(sensor)), first_(std::make_shared<const Beams>(make_beams(sensor_))) {}

BeamCache::BeamCache(Sensor sensor, Beams first)
    : sensor_(std::move(sensor)), first_(std::make_shared<const Beams>(std::move(first))) {}

std::shared_ptr<const Beams> BeamCache::beams(std::uint32_t frame) const {
  if (frame == 0 || std::holds_alternative<Pinhole>(sensor_.optics)) return first_;
  const std::lock_guard lock(mutex_);
  if (const auto found = in_use_.find(frame); found != in_use_.end()) {
    if (std::shared_ptr<const Beams> beams = found->second.lock()) return beams;
  }
  latest_ = std::make_shared<const Beams>(make_beams(sensor_, frame_interval(sensor_, frame)));
  std::erase_if(in_use_, [](const auto& entry) { return entry.second.expired(); });
  in_use_[frame] = latest_;
  return latest_;
}

}  // namespace glidar
