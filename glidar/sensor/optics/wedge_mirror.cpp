// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/wedge_mirror.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/optics/steered_beams.hpp>

#include <cmath>
#include <numbers>
#include <string>

namespace glidar {
namespace {

constexpr std::size_t kMaxIncidentBeams = 64;
constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;

void validate(const RotatingFace& face, const std::string& name) {
  const auto check = [&](bool valid, const char* what, double value, const char* allowed) {
    require_number(valid, ("optics, " + name + ", " + what).c_str(), value, allowed);
  };
  check(std::isfinite(face.rotation_hz), "rotation", face.rotation_hz, "a finite number");
  check(std::isfinite(face.phase_rad), "phase", face.phase_rad, "a finite angle");
  check(face.tilt_rad >= 0.0 && face.tilt_rad < kRightAngle_rad, "tilt", face.tilt_rad,
        "from 0 to below pi/2");
  check(face.refractive_index >= 1.0 && face.refractive_index <= 10.0, "refractive index",
        face.refractive_index, "1 to 10");
  check(std::isfinite(face.modulation_rad), "modulation", face.modulation_rad, "a finite angle");
  check(std::isfinite(face.modulation_hz), "modulation rate", face.modulation_hz,
        "a finite number");
}

void validate(const WedgeMirror& optics) {
  const std::size_t beams = optics.incidence_rad.size();
  require_number(beams >= 1 && beams <= kMaxIncidentBeams, "optics, number of incident beams",
                 static_cast<double>(beams), "1 to 64");
  for (const double angle : optics.incidence_rad) {
    require_number(std::abs(angle) < kRightAngle_rad, "optics, incident beam", angle,
                   "above -pi/2 and below pi/2");
  }
  require_number(optics.pulse_hz > 0.0 && optics.pulse_hz <= kSecond_ns,
                 "optics, pulses per second", optics.pulse_hz, "above 0, up to 1e9");
  require_number(std::abs(optics.first_pulse_ns) <= kSecond_ns, "optics, time of the first pulse",
                 optics.first_pulse_ns, "nanoseconds from -1e9 to 1e9");
  validate(optics.wedge, "wedge");
  validate(optics.mirror, "mirror");
}

/// Sine and cosine of the azimuth of the face at firing k.
SineCosine azimuth_at(const RotatingFace& face, const WedgeMirror& optics, std::int64_t k) {
  const double first_s = optics.first_pulse_ns / kSecond_ns;
  const auto turns_at = [&](double rate_hz) {
    return phase_turns(rate_hz * first_s, rate_hz / optics.pulse_hz, k);
  };
  const double deviation_rad =
      face.modulation_rad * sincos_turns(turns_at(face.modulation_hz)).sine;
  return sincos_turns(turns_at(face.rotation_hz) + (face.phase_rad + deviation_rad) / kTwoPi);
}

/// The parts at one moment, with unit normals. Axes: x forward, y left, z up.
struct OpticalTrain {
  Eigen::Vector3d wedge_exit;  ///< opposed to the light
  Eigen::Vector3d mirror;      ///< along the light
  Eigen::Vector3d prism_exit;  ///< opposed to the light
  double wedge_index = 1.0;
  double prism_index = 1.0;
};

OpticalTrain train_at(const WedgeMirror& optics, std::int64_t k) {
  const SineCosine wedge = azimuth_at(optics.wedge, optics, k);
  const SineCosine mirror = azimuth_at(optics.mirror, optics, k);
  const SineCosine wedge_tilt = sincos_turns(optics.wedge.tilt_rad / kTwoPi);
  const SineCosine mirror_tilt = sincos_turns(optics.mirror.tilt_rad / kTwoPi);
  return {{wedge_tilt.sine * wedge.cosine, wedge_tilt.sine * wedge.sine, -wedge_tilt.cosine},
          {mirror_tilt.sine * mirror.cosine, mirror_tilt.sine * mirror.sine, mirror_tilt.cosine},
          {mirror.cosine, mirror.sine, 0.0},
          optics.wedge.refractive_index,
          optics.mirror.refractive_index};
}

Eigen::Vector3d pass(const OpticalTrain& train, const Eigen::Vector3d& incident) {
  const Eigen::Vector3d horizontal = -Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d in_wedge = refract(incident, horizontal, 1.0 / train.wedge_index);
  const Eigen::Vector3d above_wedge = refract(in_wedge, train.wedge_exit, train.wedge_index);
  const Eigen::Vector3d in_prism = refract(above_wedge, horizontal, 1.0 / train.prism_index);
  const Eigen::Vector3d reflected = in_prism - 2.0 * in_prism.dot(train.mirror) * train.mirror;
  return refract(reflected, train.prism_exit, train.prism_index);
}

}  // namespace

Beams make_beams(const WedgeMirror& optics, const FrameInterval& interval) {
  validate(optics);
  std::vector<Eigen::Vector3d> incident;
  for (const double angle : optics.incidence_rad) {
    const SineCosine sincos = sincos_turns(angle / kTwoPi);
    incident.emplace_back(0.0, sincos.sine, sincos.cosine);
  }
  const FiringSchedule pulses = {optics.first_pulse_ns, kSecond_ns / optics.pulse_hz};
  return make_steered_beams(pulses, interval, incident.size(),
                            [&](std::int64_t k, std::span<Eigen::Vector3d> directions) {
                              const OpticalTrain train = train_at(optics, k);
                              for (std::size_t row = 0; row < incident.size(); ++row)
                                directions[row] = pass(train, incident[row]);
                            });
}

void describe(RotatingFace& face, FieldVisitor& visitor) {
  constexpr NumberRule kTilt = {0.0, 89.0, false, "degrees from 0 to 89"};
  constexpr NumberRule kAngle = {-360.0, 360.0, false, "degrees from -360 to 360"};
  visitor.number(
      {"rotation_hz", "turns per second; negative: clockwise from above", kUnitHertz, kRequired},
      kFinite, face.rotation_hz);
  visitor.number({"phase_deg", "azimuth of the inclined face at time 0, to the left", kUnitDegree},
                 kAngle, face.phase_rad);
  visitor.number({"tilt_deg", "angle between the inclined face and the horizontal plane",
                  kUnitDegree, kRequired},
                 kTilt, face.tilt_rad);
  visitor.number({"refractive_index", "of the glass", kNoUnit, kRequired},
                 {1.0, 10.0, false, "a number from 1 to 10"}, face.refractive_index);
  visitor.number({"modulation_deg", "amplitude of a sinusoidal deviation from the uniform rotation",
                  kUnitDegree},
                 kAngle, face.modulation_rad);
  visitor.number({"modulation_hz", "periods of the deviation per second", kUnitHertz}, kFinite,
                 face.modulation_hz);
}

void describe(WedgeMirror& optics, FieldVisitor& visitor) {
  constexpr NumberRule kPulses = {0.0, 1e9, true, "a number above 0, below 1e9"};
  constexpr NumberRule kIncidence = {-90.0, 90.0, true, "degrees above -90 and below 90"};
  visitor.number({"pulse_hz", "pulses per second of each beam", kUnitHertz, kRequired}, kPulses,
                 optics.pulse_hz);
  visitor.number({"first_pulse_us", "time of the first pulse", kUnitMicrosecond_ns},
                 {-1e6, 1e6, false, "microseconds from -1e6 to 1e6"}, optics.first_pulse_ns);
  visitor.numbers({"incidence_deg",
                   "one beam for each number: angle from the vertical axis towards the left at "
                   "which it enters the wedge",
                   kUnitDegree},
                  {.number = kIncidence, .max_size = kMaxIncidentBeams}, optics.incidence_rad);
  visit_object(visitor, {"wedge", "the wedge, whose upper face is inclined", kNoUnit, kRequired},
               optics.wedge);
  visit_object(visitor, {"mirror", "the prism, whose inclined face reflects", kNoUnit, kRequired},
               optics.mirror);
}

}  // namespace glidar
