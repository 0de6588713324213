// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/prepared_sensor.hpp>

#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/simulate/mirrors.hpp>

#include <cmath>
#include <variant>

namespace glidar {
namespace {

/// The pattern as a camera at the position of the projector sees it, W/sr.
std::vector<float> view_pattern(const PreparedActiveStereo& prepared) {
  const PreparedImager& imager = prepared.imager;
  std::vector<float> rays;
  rays.reserve(imager.rays.size());
  for (const Eigen::Vector3d& ray : imager.rays.directions) {
    rays.push_back(
        static_cast<float>(intensity_at(prepared.pattern, ray.x() / ray.z(), ray.y() / ray.z())));
  }
  std::vector<float> view;
  ThreadPool one_thread(1);
  average_rays(rays, imager.setup.sub_rays, imager.weights, imager.size, one_thread, view);
  return view;
}

/// The weather for this sensor's beams; without a footprint they are those of BeamShape.
std::optional<PreparedWeather> weather_of(const Sensor& sensor) {
  if (!sensor.weather) return {};
  check_weather(sensor);
  BeamShape beam;
  if (sensor.footprint) {
    const Footprint& f = *sensor.footprint;
    beam = {.divergence_rad = std::sqrt(f.divergence_x_rad * f.divergence_y_rad),
            .exit_diameter_m = std::sqrt(f.exit_x_m * f.exit_y_m)};
  }
  return prepare_weather(*sensor.weather, *sensor.lidar_equation, sensor.wavelength_m, beam,
                         sensor.receiver.pulse_fwhm_s);
}

PulseModel pulse_model(const Sensor& sensor, bool has_mirrors) {
  PulseModel model;
  model.sub_rays = sensor.footprint ? sample_footprint(*sensor.footprint) : std::vector<SubRay>(1);
  model.weather = weather_of(sensor);
  model.lidar_equation = model.weather ? model.weather->light : *sensor.lidar_equation;
  model.has_mirrors = has_mirrors;
  model.has_closed_form = sensor.footprint && !has_mirrors && !model.weather && !sensor.doppler &&
                          model.lidar_equation.overlap.empty() &&
                          model.lidar_equation.extinction_per_m == 0.0;
  return model;
}

HitColumnMask required_hit_columns(const Sensor& sensor) {
  HitColumnMask hit_columns;
  hit_columns.shading = true;
  hit_columns.diffuse = sensor.lidar_equation.has_value();
  hit_columns.reflectance = !sensor.lidar_equation;
  const bool is_physical = physical_camera(sensor) != nullptr;
  hit_columns.normal = sensor.projector_origin_m.has_value() || is_physical;
  hit_columns.radial_velocity = sensor.doppler.has_value();
  hit_columns.noise_scale = sensor.doppler.has_value();
  if (!is_physical) add_required_hit_columns(sensor.noise, hit_columns);
  return hit_columns;
}

PreparedDepthCamera prepare(const ActiveStereo& camera, const Sensor& sensor) {
  return prepare_active_stereo(camera, sensor);
}

PreparedDepthCamera prepare(const TofCamera& camera, const Sensor& sensor) {
  return prepare_tof(camera, sensor);
}

PreparedDepthCamera prepare(const StructuredLightCamera& camera, const Sensor& sensor) {
  return prepare_structured_light(camera, sensor);
}

/// Images have noise of their own.
std::vector<NoiseStep> noise_steps(const Sensor& sensor) {
  return physical_camera(sensor) != nullptr ? std::vector<NoiseStep>{} : sensor.noise;
}

}  // namespace

PreparedImager prepare_imager(const Sensor& sensor, const ImagerSetup& setup) {
  const auto& pinhole = std::get<Pinhole>(sensor.optics);
  return {.setup = setup,
          .size = {pinhole.intrinsics.width, pinhole.intrinsics.height},
          .wavelength_m = sensor.wavelength_m,
          .rays = make_beams(divide_pixels(pinhole, setup.sub_rays)),
          .weights = point_spread_weights(setup.sub_rays, setup.imager.blur_px),
          .electron_rate =
              electron_rate_per_radiance(setup.imager, pinhole.intrinsics.fx, sensor.wavelength_m)};
}

PreparedActiveStereo prepare_active_stereo(const ActiveStereo& camera, const Sensor& sensor) {
  PreparedActiveStereo prepared{
      .camera = camera,
      .imager = prepare_imager(sensor, {camera.imager, camera.illumination, camera.sub_rays}),
      .focal_length_px = std::get<Pinhole>(sensor.optics).intrinsics.fx,
      .pattern = make_intensity_map(camera.projector),
      .pattern_view = {}};
  if (camera.reference == ActiveStereo::Reference::pattern) {
    prepared.pattern_view = view_pattern(prepared);
  }
  return prepared;
}

PreparedStructuredLight prepare_structured_light(const StructuredLightCamera& camera,
                                                 const Sensor& sensor) {
  const Pose camera_from_projector = camera.projector_from_camera.inverse();
  PreparedStructuredLight prepared{
      .camera = camera,
      .setup = setup_of(camera, std::get<Pinhole>(sensor.optics)),
      .imager = prepare_imager(sensor, {camera.imager, camera.illumination, camera.sub_rays}),
      .projection = PinholeProjection(camera.projector),
      .projector_m = camera_from_projector.translation(),
      .white_w_per_sr = white_intensity_w_per_sr(camera.projector, camera.light.power_w),
      .lines = {}};
  for (std::size_t i = 0; i < image_count(camera.patterns); ++i) {
    prepared.lines.push_back(projected_line(camera.patterns, camera.light, i));
  }
  return prepared;
}

std::optional<Eigen::Vector2d> projector_pixel(const PreparedStructuredLight& prepared,
                                               const Eigen::Vector3d& path) {
  const PinholeIntrinsics& image = prepared.camera.projector.intrinsics;
  const auto pixel =
      prepared.projection.pixel_of(prepared.camera.projector_from_camera.linear() * path);
  if (!pixel) return {};
  const bool is_inside = pixel->x() >= -0.5 && pixel->x() <= image.width - 0.5 &&
                         pixel->y() >= -0.5 && pixel->y() <= image.height - 0.5;
  return is_inside ? pixel : std::nullopt;
}

bool needs_waveform(const Sensor& sensor, bool has_mirrors) {
  if (sensor.weather) return true;
  if (!sensor.lidar_equation) return false;
  const Receiver& receiver = sensor.receiver;
  const Return& first = receiver.returns[0];
  const bool reports_strongest =
      receiver.returns.size() == 1 && first.order == Return::Order::strongest && first.rank == 0;
  return sensor.footprint || !reports_strongest || receiver.timing != Receiver::Timing::centroid ||
         has_mirrors;
}

PreparedSensor prepare_sensor(const Sensor& sensor, bool has_mirrors) {
  check_channel_ranges(sensor);
  check_doppler(sensor);
  if (physical_camera(sensor) != nullptr) check_depth_camera(sensor);
  PreparedSensor prepared{.sensor = sensor,
                          .noise = plan_noise(noise_steps(sensor), 1.0 / sensor.rate_hz),
                          .required_hit_columns = required_hit_columns(sensor),
                          .pulse_model = {},
                          .depth_camera = {}};
  if (needs_waveform(sensor, has_mirrors)) prepared.pulse_model = pulse_model(sensor, has_mirrors);
  if (const DepthCamera* depth_camera = physical_camera(sensor)) {
    std::visit([&](const auto& camera) { prepared.depth_camera.emplace(prepare(camera, sensor)); },
               *depth_camera);
  }
  return prepared;
}

}  // namespace glidar
