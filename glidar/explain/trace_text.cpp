// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/explain/trace_text.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/config/sensor_options.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>

namespace glidar {
namespace {

constexpr std::size_t kMaxLine_bytes = 1000;

/// The inputs of the text, and the text written so far.
struct TraceWriter {
  const PointTrace& trace;
  const Scene& scene;
  const Sensor& sensor;
  const Beams& beams;
  const Frame& frame;
  std::string text = {};

  template <class... Values>
  void line(std::string_view head, fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text), "{:<10}", head);
    // names of models may contain control sequences of terminals
    text += excerpt(fmt::format(form, std::forward<Values>(values)...), kMaxLine_bytes);
    text += '\n';
  }
  /// Lines of another trace; the first has the head.
  void lines(std::string_view head, const std::string& trace_lines) {
    std::istringstream stream(trace_lines);
    for (std::string one; std::getline(stream, one); head = "") line(head, "{}", one);
  }
  [[nodiscard]] bool has_hit() const {
    return frame.ground_truth.instance[trace.entry] != kInvalidId;
  }
};

std::string triple(const Eigen::Vector3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
}

std::string measurement_text(const Measurement& measurement) {
  if (measurement.status != Status::hit) return std::string(name(measurement.status));
  std::string text =
      fmt::format("{:.6f} m, intensity {:.6g}", measurement.range_m, measurement.intensity);
  if (measurement.sigma_m > 0.0F) text += fmt::format(", sigma {:.3g} m", measurement.sigma_m);
  if (!std::isnan(measurement.radial_velocity_m_s))
    text += fmt::format(", {:+.6f} m/s", measurement.radial_velocity_m_s);
  if (measurement.return_source != ReturnSource::surface)
    text += fmt::format(", {}", name(measurement.return_source));
  return text;
}

void write_beam(TraceWriter& out) {
  const Beams& beams = out.beams;
  const std::size_t entry = out.trace.entry;
  const std::size_t pulse = entry % beams.firings();
  out.line("beam", "{} of {}: row {}, col {}, ring {}", pulse, beams.firings(), pulse / beams.cols,
           pulse % beams.cols, ring_of(beams, entry));
  if (beams.returns > 1) {
    out.line("", "return {} of {}", entry / beams.firings(), beams.returns);
  }
  const std::uint32_t time_ns = beams.times_ns.empty() ? 0U : beams.times_ns[entry];
  out.line("fired", "{} ns after the start of frame {} at {} ns; seed {}", time_ns,
           out.frame.number, out.frame.stamp_ns, out.frame.seed);
  const Eigen::Vector3d& nominal = beams.directions[entry];
  if (std::isnan(nominal.x())) return;
  const SensorAxes axes = axes_of(beams);
  out.line("nominal", "azimuth {:.6f} deg, elevation {:.6f} deg, {} in '{}'",
           kDegreesPerRadian * azimuth_rad(axes, nominal),
           kDegreesPerRadian * elevation_rad(axes, nominal), triple(nominal), beams.frame_id);
  if (out.trace.direction != nominal) {
    out.line("actual", "azimuth {:.6f} deg, elevation {:.6f} deg, with pointing noise",
             kDegreesPerRadian * azimuth_rad(axes, out.trace.direction),
             kDegreesPerRadian * elevation_rad(axes, out.trace.direction));
  }
}

/// The sensor's pose at the firing time of the beam.
Pose sensor_pose(const TraceWriter& out) {
  const PoseVector& v = out.frame.beam_poses.world_from_sensor[out.trace.entry];
  Pose pose = Pose::Identity();
  pose.translation() = v.head<3>();
  pose.linear() = Eigen::Quaterniond(v[3], v[4], v[5], v[6]).toRotationMatrix();
  return pose;
}

void write_ray(TraceWriter& out) {
  if (std::isnan(out.trace.direction.x())) return;
  const Pose pose = sensor_pose(out);
  const std::vector<Eigen::Vector3d>& origins = out.beams.origins_m;
  const Eigen::Vector3d from =
      origins.empty() ? Eigen::Vector3d(pose.translation()) : pose * origins[out.trace.entry];
  out.line("ray", "from {} along {} in the world", triple(from),
           triple(pose.linear() * out.trace.direction));
}

void write_hit(TraceWriter& out) {
  const Hits& hits = out.frame.ground_truth;
  const std::size_t i = out.trace.entry;
  if (!out.has_hit()) {
    out.line("hit", "none");
    return;
  }
  const Instance& instance = out.scene.instances[hits.instance[i]];
  const Material& material = material_of(out.scene, instance, hits.primitive[i]);
  out.line("hit", "object '{}' (id {}, class {}), triangle {}, material '{}'", instance.name,
           instance.id, out.scene.class_names.at(instance.class_id), hits.primitive[i],
           material.name);
  if (out.trace.waveform && out.trace.waveform->is_in_closed_form) {
    out.line("", "of the central ray of the footprint");
  } else if (out.trace.waveform && out.trace.waveform->sub_rays > 1) {
    out.line("", "of the sub-ray with the strongest contribution");
  }
  out.line("", "range {:.9g} m, depth {:.9g} m, incidence {:.4f} deg", hits.range_m[i],
           hits.depth_m[i],
           kDegreesPerRadian * portable_acos(std::min(1.0F, hits.cos_incidence[i])));
  out.line("", "at {} of the object, normal {} in the sensor's frame",
           triple(hits.object_point_m[i]), triple(hits.normal[i].cast<double>()));
  if (out.sensor.doppler) {
    out.line("", "radial velocity {:+.9g} m/s, positive away from the sensor",
             out.frame.true_radial_velocity_m_s[i]);
  }
}

/// Names of the alternatives of Brdf, in their order.
constexpr std::array<const char*, std::variant_size_v<Brdf>> kBrdfNames = {
    "diffuse", "Phong-like", "Oren-Nayar", "retro-reflecting", "glossy"};

void write_lidar_equation(TraceWriter& out, const LidarEquation& light) {
  const Hits& hits = out.frame.ground_truth;
  const std::size_t i = out.trace.entry;
  const Scene& scene = out.scene;
  const Material& material =
      material_of(scene, scene.instances[hits.instance[i]], hits.primitive[i]);
  const double backscatter = backscatter_at(scene, out.sensor.wavelength_m, hits, i);
  out.line("light",
           "{} surface, cosine {:.4f}: {:.4g} times a white diffuse one at normal incidence",
           kBrdfNames.at(material.backscatter.index()), hits.cos_shading[i], backscatter);
  out.line("", "reference {:.4g} at {:.4g} m, detected with 50 %: signal {:.6g} in clear air",
           light.reference_reflectance, light.reference_range_m,
           received_signal(light, backscatter, hits.range_m[i]));
  if (const auto& weather = out.sensor.weather) {
    const double per_m = extinction_per_m(*weather, out.sensor.wavelength_m);
    out.line("", "weather: extinction {:.4g} per m, transmission of both ways {:.4g}", per_m,
             portable_exp(-2.0 * per_m * hits.range_m[i]));
  }
  if (!out.trace.waveform && !out.trace.receiver_noise.empty()) {
    out.line("", "noise of sigma {:.3g}, standard normal {:.6f}; threshold 1", light.noise_sigma,
             out.trace.receiver_noise.front());
  }
}

void write_phong(TraceWriter& out) {
  const Hits& hits = out.frame.ground_truth;
  const PhongHeadlight& light = out.sensor.light;
  const Reflectance& r = hits.reflectance[out.trace.entry];
  out.line("light", "diffuse {:.4g}, specular {:.4g} (shininess {:.4g}), ambient {:.4g} x {:.4g}",
           r.diffuse, r.specular, r.shininess, r.ambient, light.ambient);
  out.line("", "at cosine {:.4f}; attenuation {:.4g}, {:.4g} per m, {:.4g} per m2",
           hits.cos_shading[out.trace.entry], light.attenuation_constant,
           light.attenuation_linear_per_m, light.attenuation_quadratic_per_m2);
}

void write_exposure(TraceWriter& out, const Exposure& exposure) {
  out.line("exposed", "{:.4g} ms, gain {:.4g}", 1e3 * exposure.time_s, exposure.gain);
}

/// The photons of a pixel, and how it was matched.
void write_depth(TraceWriter& out, const StereoPixelTrace& stereo) {
  const PixelReading& reading = stereo.reading;
  write_exposure(out, stereo.exposure);
  out.line("photons", "{:.1f} electrons from the projector, {:.1f} from other light, on average",
           stereo.light.projector_e, stereo.light.ambient_e);
  out.line("", "speckle {:.4f}, {:.0f} electrons after shot noise, read noise {:+.1f}: grey {}",
           reading.speckle, reading.electrons, reading.read_noise_e, reading.level);
  out.line("", "the same surface in the right image: {:.1f} and {:.1f} electrons",
           stereo.right_light.projector_e, stereo.right_light.ambient_e);
  out.line("match", "true disparity {:.4f} px", stereo.true_disparity_px);
  out.lines("", format_stereo_trace(stereo.match));
}

/// The photons of each phase step, and how they were decoded.
void write_depth(TraceWriter& out, const TofPixelTrace& tof) {
  const std::size_t taps = tof.light.size() / tof.decoded.frequencies_hz.size();
  for (std::size_t f = 0; f < tof.decoded.frequencies_hz.size(); ++f) {
    std::string correlated;
    for (std::size_t k = 0; k < taps; ++k) {
      correlated += fmt::format("{}{:.1f}", k == 0 ? "" : ", ", tof.light[f * taps + k].correlated);
    }
    const TofLight& light = tof.light[f * taps];
    out.line(f == 0 ? "photons" : "",
             "{:.0f} MHz: {:.1f} electrons of the illuminator in each phase step, {:.1f} of other "
             "light, on average; correlated {}",
             tof.decoded.frequencies_hz[f] * 1e-6, light.signal, light.background, correlated);
  }
  out.line("", "{:.2f} % of the illuminator's light came over diffuse bounces",
           100.0 * tof.bounced_share);
  out.lines("decoded", format_tof_trace(tof.decoded));
}

/// The electrons of each image of a pixel, and how they were decoded.
void write_depth(TraceWriter& out, const StructuredLightPixelTrace& pixel) {
  write_exposure(out, pixel.exposure);
  std::string electrons;
  for (const double one : pixel.electrons) {
    electrons += fmt::format("{}{:.1f}", electrons.empty() ? "" : ", ", one);
  }
  out.line("photons", "electrons of each image, on average: {}", electrons);
  if (!out.has_hit()) {
    out.line("projector", "there is no surface for it to light");
  } else if (std::isnan(pixel.true_projector_px)) {
    out.line("projector", "no pixel of its image lights the surface");
  } else {
    out.line("projector", "true coordinate {:.4f} px", pixel.true_projector_px);
  }
  out.lines("decoded", format_fringe_trace(pixel.decoded));
}

void write_light(TraceWriter& out) {
  if (out.trace.depth) {
    return std::visit([&](const auto& pixel) { write_depth(out, pixel); }, *out.trace.depth);
  }
  if (!out.has_hit()) return;
  if (out.sensor.lidar_equation) return write_lidar_equation(out, *out.sensor.lidar_equation);
  write_phong(out);
}

std::string_view object_name(const TraceWriter& out, std::uint32_t instance) {
  return out.scene.instances[instance].name;
}

/// The origin of a contribution: "surface of car", "ghost of wall in mirror", "fog".
std::string origin_text(const TraceWriter& out, const WaveformTrace::LightPath& light_path) {
  const std::string_view source = name(light_path.path.return_source);
  if (light_path.instance == kInvalidId) return std::string(source);
  std::string text(object_name(out, light_path.instance));
  if (light_path.reflected != kInvalidId)
    text = fmt::format("{} in {}", object_name(out, light_path.reflected), text);
  return fmt::format("{} of {}", source, text);
}

void write_paths(TraceWriter& out, const WaveformTrace& pulse) {
  constexpr std::size_t kMax = 40;
  if (pulse.is_in_closed_form) {
    out.line("paths", "1: the footprint is on one flat surface, integrated in closed form");
  } else {
    out.line("paths", "{}, of {} sub-rays and weather", pulse.light_paths.size(), pulse.sub_rays);
  }
  for (std::size_t k = 0; k < std::min(kMax, pulse.light_paths.size()); ++k) {
    const WaveformTrace::LightPath& light_path = pulse.light_paths[k];
    const std::string ray =
        light_path.path.source == kInvalidId
            ? std::string("-")
            : fmt::format("{} ({:.1f} %)", light_path.path.source, 100.0 * light_path.share);
    const std::string velocity =
        out.sensor.doppler ? fmt::format("{:+.6f} m/s  ", light_path.velocity_m_s) : "";
    out.line("", "{:>12}  {:>12.6f} m  signal {:<10.4g} {}{}", ray, light_path.path.range_m,
             light_path.path.signal, velocity, origin_text(out, light_path));
  }
  if (pulse.light_paths.size() > kMax)
    out.line("", "... and {} more", pulse.light_paths.size() - kMax);
}

/// The returns of the receiver that report an echo: " -> return 0".
std::string returns_of(const WaveformTrace& pulse, std::size_t echo) {
  std::string text;
  for (std::size_t r = 0; r < pulse.returns.size(); ++r) {
    if (pulse.returns[r] == static_cast<int>(echo)) text += fmt::format(" -> return {}", r);
  }
  return text;
}

void write_echoes(TraceWriter& out, const WaveformTrace& pulse) {
  const auto source = [&](const PulseEcho& echo) {
    return name(pulse.light_paths.at(echo.strongest).path.return_source);
  };
  out.line("echoes", "{} before the receiver's noise", pulse.echoes.size());
  for (std::size_t k = 0; k < pulse.echoes.size(); ++k) {
    const PulseEcho& echo = pulse.echoes[k];
    const std::vector<double>& noise = out.trace.receiver_noise;
    out.line("", "{:.6f} m, signal {:.6g}, sigma {:.3g} m, {}{}{}", echo.range_m, echo.signal,
             echo.sigma_m, source(echo), echo.is_mixed ? ", mixed" : "",
             noise.empty() ? "" : fmt::format("; standard normal {:.6f}", noise[k]));
  }
  out.line("received", "{} after noise of sigma {:.3g}, threshold 1", pulse.received.size(),
           out.sensor.lidar_equation->noise_sigma);
  for (std::size_t k = 0; k < pulse.received.size(); ++k) {
    const PulseEcho& echo = pulse.received[k];
    out.line("", "{:.6f} m, signal {:.6g}, {}{}", echo.range_m, echo.signal, source(echo),
             returns_of(pulse, k));
  }
}

void write_velocity(TraceWriter& out) {
  if (!out.trace.velocity) return;
  const VelocityTrace& velocity = *out.trace.velocity;
  const Doppler& doppler = *out.sensor.doppler;
  out.line("doppler", "{:+.6f} m/s received, sigma {:.3g} m/s, standard normal {:.6f}",
           velocity.received_m_s, velocity.sigma_m_s, velocity.normal);
  if (doppler.step_m_s > 0.0) out.line("", "in steps of {:.6g} m/s", doppler.step_m_s);
  if (std::isfinite(doppler.max_m_s)) {
    out.line("", "folded into -{0:.6g} to {0:.6g} m/s", doppler.max_m_s);
  }
  out.line("", "result {:+.6f} m/s", out.trace.measured.radial_velocity_m_s);
}

void write_noise(TraceWriter& out) {
  const std::vector<NoiseStep>& noise = out.sensor.noise;
  for (std::size_t k = 0; k < out.trace.noise.size(); ++k) {
    const PointTrace::Step& step = out.trace.noise[k];
    const Measurement& before = k == 0 ? out.trace.measured : out.trace.noise[k - 1].after;
    out.line(fmt::format("noise {}", k + 1), "{}", noise_text(noise[k]));
    if (before.status != Status::hit && step.after.status == before.status) {
      out.line("", "unchanged: {}", name(before.status));
      continue;
    }
    for (const RandomSample& sample : step.samples) {
      out.line(
          "", "{} {:.6f}: {}{}",
          sample.distribution == RandomSample::Distribution::normal ? "standard normal" : "uniform",
          sample.value, sample.use,
          sample.probability ? fmt::format(" {:.6g}", *sample.probability) : "");
    }
    out.line("", "result {}", measurement_text(step.after));
  }
}

/// What the limits remove after noise.
void write_limits(TraceWriter& out) {
  const Measurement& after =
      out.trace.noise.empty() ? out.trace.measured : out.trace.noise.back().after;
  const Status status = out.trace.reported.status;
  if (after.status == status) return;
  const Limits& limits = out.sensor.limits;
  const bool is_near = status == Status::too_near;
  out.line("limits", "{} m, the {} limit of the {}: {}", is_near ? limits.near_m : limits.far_m,
           is_near ? "near" : "far", limits.along == Limits::Along::depth ? "depth" : "range",
           name(status));
}

void write_result(TraceWriter& out) {
  const Measurement& measurement = out.trace.reported;
  Measurement reported = measurement;
  const double offset_m = out.beams.range_offset_m;
  if (measurement.status == Status::hit && offset_m != 0.0) {
    out.line("offset", "{:+.6f} m, added to the range in the cloud", offset_m);
    reported.range_m += offset_m;
  }
  out.line("reported", "{}", measurement_text(reported));
  if (measurement.status == Status::hit && out.has_hit()) {
    out.line("error", "{:+.6f} m relative to the ground truth",
             measurement.range_m - out.frame.ground_truth.range_m[out.trace.entry]);
    if (out.sensor.doppler) {
      out.line(
          "", "{:+.6f} m/s relative to its radial velocity",
          measurement.radial_velocity_m_s - out.frame.true_radial_velocity_m_s[out.trace.entry]);
    }
  }
}

}  // namespace

std::string format_trace(const PointTrace& trace, const Simulator& simulator, const Frame& frame) {
  const std::shared_ptr<const Beams> beams = simulator.beams(frame.number);
  TraceWriter out{trace, simulator.scene(), simulator.sensor(), *beams, frame};
  write_beam(out);
  write_ray(out);
  write_hit(out);
  write_light(out);
  if (trace.waveform) {
    write_paths(out, *trace.waveform);
    write_echoes(out, *trace.waveform);
  }
  write_velocity(out);
  out.line("measured", "{}", measurement_text(trace.measured));
  write_noise(out);
  write_limits(out);
  write_result(out);
  return out.text;
}

}  // namespace glidar
