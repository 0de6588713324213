// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/explain/trace_text.hpp>

#include <glidar/io/config/noise_text.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <string_view>

namespace glidar {
namespace {

/// What the parts of a story are told from.
struct Teller {
  const PointTrace& story;
  const Setup& setup;
  const Frame& frame;
  std::string text = {};

  template <class... Values>
  void line(std::string_view head, fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text), "{:<10}", head);
    fmt::format_to(std::back_inserter(text), form, std::forward<Values>(values)...);
    text += '\n';
  }
  [[nodiscard]] bool has_hit() const {
    return frame.ground_truth.instance[story.entry] != kInvalidId;
  }
};

std::string triple(const Eigen::Vector3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
}

std::string reading_text(const Measurement& reading) {
  if (reading.status != Status::hit) return std::string(name(reading.status));
  std::string text = fmt::format("{:.6f} m, intensity {:.6g}", reading.range_m, reading.intensity);
  if (reading.sigma_m > 0.0F) text += fmt::format(", sigma {:.3g} m", reading.sigma_m);
  if (reading.return_source != ReturnSource::surface)
    text += fmt::format(", {}", name(reading.return_source));
  return text;
}

void tell_beam(Teller& to) {
  const Beams& beams = to.setup.beams;
  const std::size_t entry = to.story.entry;
  const std::size_t pulse = entry % beams.firings();
  to.line("beam", "{} of {}: row {}, col {}, ring {}", pulse, beams.firings(), pulse / beams.cols,
          pulse % beams.cols, ring_of(beams, entry));
  if (beams.returns > 1) {
    to.line("", "return {} of {}", entry / beams.firings() + 1, beams.returns);
  }
  const std::uint32_t time_ns = beams.times_ns.empty() ? 0U : beams.times_ns[entry];
  to.line("fired", "{} ns after the start of frame {} at {} ns; seed {}", time_ns, to.frame.number,
          to.frame.stamp_ns, to.frame.seed);
  const Eigen::Vector3d& nominal = beams.directions[entry];
  if (std::isnan(nominal.x())) return;
  const SensorAxes axes = axes_of(beams);
  to.line("aimed", "azimuth {:.6f} deg, elevation {:.6f} deg, {} in '{}'",
          kDegreesPerRadian * azimuth_rad(axes, nominal),
          kDegreesPerRadian * elevation_rad(axes, nominal), triple(nominal), beams.frame_id);
  if (to.story.direction != nominal) {
    to.line("went", "azimuth {:.6f} deg, elevation {:.6f} deg, by errors of pointing",
            kDegreesPerRadian * azimuth_rad(axes, to.story.direction),
            kDegreesPerRadian * elevation_rad(axes, to.story.direction));
  }
}

/// The sensor's pose when the beam left.
Pose sensor_pose(const Teller& to) {
  const PoseVector& told = to.frame.beam_poses.world_from_sensor[to.story.entry];
  Pose pose = Pose::Identity();
  pose.translation() = told.head<3>();
  pose.linear() = Eigen::Quaterniond(told[3], told[4], told[5], told[6]).toRotationMatrix();
  return pose;
}

void tell_ray(Teller& to) {
  if (std::isnan(to.story.direction.x())) return;
  const Pose pose = sensor_pose(to);
  const std::vector<Eigen::Vector3d>& origins = to.setup.beams.origins_m;
  const Eigen::Vector3d from =
      origins.empty() ? Eigen::Vector3d(pose.translation()) : pose * origins[to.story.entry];
  to.line("ray", "from {} along {} in the world", triple(from),
          triple(pose.linear() * to.story.direction));
}

void tell_hit(Teller& to) {
  const Hits& truth = to.frame.ground_truth;
  const std::size_t i = to.story.entry;
  if (!to.has_hit()) {
    to.line("met", "nothing");
    return;
  }
  const Instance& instance = to.setup.scene.instances[truth.instance[i]];
  const Material& material = material_of(to.setup.scene, instance, truth.primitive[i]);
  to.line("met", "object '{}' (id {}, class {}), triangle {}, material '{}'", instance.name,
          instance.id, to.setup.scene.class_names.at(instance.class_id), truth.primitive[i],
          material.name);
  if (to.story.pulse && to.story.pulse->sub_rays > 1)
    to.line("", "by the sub-ray of the strongest way");
  to.line("", "range {:.9g} m, depth {:.9g} m, incidence {:.4f} deg", truth.range_m[i],
          truth.depth_m[i], kDegreesPerRadian * std::acos(std::min(1.0F, truth.cos_incidence[i])));
  to.line("", "at {} of the object, normal {} in the sensor's frame",
          triple(truth.object_point_m[i]), triple(truth.normal[i].cast<double>()));
}

/// Names of what a material's Brdf is, in its order.
constexpr std::array<const char*, std::variant_size_v<Brdf>> kSurfaces = {
    "matt", "Phong-like", "Oren-Nayar", "retro-reflecting", "glossy"};

void tell_lidar_equation(Teller& to, const LidarEquation& light) {
  const Hits& truth = to.frame.ground_truth;
  const std::size_t i = to.story.entry;
  const Scene& scene = to.setup.scene;
  const Material& material =
      material_of(scene, scene.instances[truth.instance[i]], truth.primitive[i]);
  const double sent = backscatter_at(scene, to.setup.sensor.wavelength_m, truth, i);
  to.line("light", "{} surface at cosine {:.4f} sends back {:.4g} of a white one square on",
          kSurfaces.at(material.backscatter.index()), truth.cos_shading[i], sent);
  to.line("", "against {:.4g} at {:.4g} m, the range of 50 %: signal {:.6g} in clear air",
          light.reference_reflectance, light.reference_range_m,
          received_signal(light, sent, truth.range_m[i]));
  if (const auto& weather = to.setup.sensor.weather) {
    const double per_m = extinction_per_m(*weather, to.setup.sensor.wavelength_m);
    to.line("", "weather takes {:.4g} per m of way and leaves {:.4g} of it", per_m,
            std::exp(-2.0 * per_m * truth.range_m[i]));
  }
  if (!to.story.pulse && !to.story.receiver_noise.empty()) {
    to.line("", "noise of sigma {:.3g}, drew normal {:.6f}; threshold 1", light.noise_sigma,
            to.story.receiver_noise.front());
  }
}

void tell_paper_light(Teller& to) {
  const Hits& truth = to.frame.ground_truth;
  const PhongHeadlight& light = to.setup.sensor.light;
  const Reflectance& r = truth.reflectance[to.story.entry];
  to.line("light", "diffuse {:.4g}, specular {:.4g} (shininess {:.4g}), ambient {:.4g} x {:.4g}",
          r.diffuse, r.specular, r.shininess, r.ambient, light.ambient);
  to.line("", "at cosine {:.4f}; attenuation {:.4g}, {:.4g} per m, {:.4g} per m2",
          truth.cos_shading[to.story.entry], light.attenuation_constant,
          light.attenuation_linear_per_m, light.attenuation_quadratic_per_m2);
}

void tell_light(Teller& to) {
  if (!to.has_hit()) return;
  if (to.setup.sensor.pulse) return tell_lidar_equation(to, *to.setup.sensor.pulse);
  tell_paper_light(to);
}

std::string_view object_name(const Teller& to, std::uint32_t instance) {
  return instance == kInvalidId ? std::string_view("air") : to.setup.scene.instances[instance].name;
}

std::string met_on(const Teller& to, const WaveformTrace::LightPath& way) {
  std::string text(object_name(to, way.instance));
  if (way.reflected != kInvalidId)
    text = fmt::format("{} in {}", object_name(to, way.reflected), text);
  return text;
}

void tell_ways(Teller& to, const WaveformTrace& pulse) {
  constexpr std::size_t kMax = 40;
  to.line("paths", "{}, by {} sub-rays and the air", pulse.light_paths.size(), pulse.sub_rays);
  for (std::size_t k = 0; k < std::min(kMax, pulse.light_paths.size()); ++k) {
    const WaveformTrace::LightPath& way = pulse.light_paths[k];
    const std::string ray = way.path.source == kInvalidId
                                ? std::string("-")
                                : fmt::format("{} ({:.1f} %)", way.path.source, 100.0 * way.share);
    to.line("", "{:>12}  {:>12.6f} m  signal {:<10.4g} {} of {}", ray, way.path.range_m,
            way.path.signal, name(way.path.return_source), met_on(to, way));
  }
  if (pulse.light_paths.size() > kMax)
    to.line("", "... and {} more", pulse.light_paths.size() - kMax);
}

/// The returns of the receiver that report an echo: " -> return 1".
std::string returns_of(const WaveformTrace& pulse, std::size_t echo) {
  std::string text;
  for (std::size_t r = 0; r < pulse.returns.size(); ++r) {
    if (pulse.returns[r] == static_cast<int>(echo)) text += fmt::format(" -> return {}", r + 1);
  }
  return text;
}

void tell_echoes(Teller& to, const WaveformTrace& pulse) {
  const auto cause = [&](const PulseEcho& echo) {
    return name(pulse.light_paths.at(echo.strongest).path.return_source);
  };
  to.line("echoes", "{} before the receiver's noise", pulse.echoes.size());
  for (std::size_t k = 0; k < pulse.echoes.size(); ++k) {
    const PulseEcho& echo = pulse.echoes[k];
    const std::vector<double>& noise = to.story.receiver_noise;
    to.line("", "{:.6f} m, signal {:.6g}, width {:.3g} m, {}{}{}", echo.range_m, echo.signal,
            echo.sigma_m, cause(echo), echo.is_mixed ? ", mixed" : "",
            noise.empty() ? "" : fmt::format("; drew normal {:.6f}", noise[k]));
  }
  to.line("received", "{} with noise of sigma {:.3g}, threshold 1", pulse.received.size(),
          to.setup.sensor.pulse->noise_sigma);
  for (std::size_t k = 0; k < pulse.received.size(); ++k) {
    const PulseEcho& echo = pulse.received[k];
    to.line("", "{:.6f} m, signal {:.6g}, {}{}", echo.range_m, echo.signal, cause(echo),
            returns_of(pulse, k));
  }
}

void tell_noise(Teller& to) {
  const std::vector<NoiseStep>& noise = to.setup.sensor.noise;
  for (std::size_t k = 0; k < noise.size(); ++k) {
    const PointTrace::Step& step = to.story.noise[k];
    const Measurement& before = k == 0 ? to.story.measured : to.story.noise[k - 1].after;
    to.line(fmt::format("noise {}", k + 1), "{}", noise_text(noise[k]));
    if (before.status != Status::hit && step.after.status == before.status) {
      to.line("", "still {}", name(before.status));
      continue;
    }
    for (const RandomSample& drawn : step.draws) {
      to.line("", "drew {} {:.6f}: {}{}",
              drawn.law == RandomSample::Law::normal ? "normal" : "uniform", drawn.value, drawn.use,
              drawn.against ? fmt::format(" {:.6g}", *drawn.against) : "");
    }
    to.line("", "now {}", reading_text(step.after));
  }
}

Measurement final_reading(const PointTrace& story) {
  return story.noise.empty() ? story.measured : story.noise.back().after;
}

void tell_end(Teller& to) {
  const Measurement reading = final_reading(to.story);
  to.line("reported", "{}", reading_text(reading));
  const double offset_m = to.setup.beams.range_offset_m;
  if (reading.status == Status::hit && offset_m != 0.0) {
    to.line("", "range counts from elsewhere: {:.6f} m in the cloud's column",
            reading.range_m + offset_m);
  }
  if (reading.status == Status::hit && to.has_hit()) {
    to.line("error", "{:+.6f} m against the truth",
            reading.range_m - to.frame.ground_truth.range_m[to.story.entry]);
  }
}

}  // namespace

std::string format_trace(const PointTrace& story, const Setup& setup, const Frame& frame) {
  Teller to{story, setup, frame};
  tell_beam(to);
  tell_ray(to);
  tell_hit(to);
  tell_light(to);
  if (story.pulse) {
    tell_ways(to, *story.pulse);
    tell_echoes(to, *story.pulse);
  }
  to.line("measured", "{}", reading_text(story.measured));
  tell_noise(to);
  tell_end(to);
  return to.text;
}

}  // namespace glidar
