// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/rotating_optics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace glidar {

Eigen::Vector3d refract(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                        double ratio) {
  const double cosine = -direction.dot(normal);
  const double root = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (!(root >= 0.0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return (ratio * direction + (ratio * cosine - std::sqrt(root)) * normal).normalized();
}

double phase_turns(double at_zero_turns, double turns_per_firing, std::int64_t k) {
  return at_zero_turns + std::fmod(static_cast<double>(k) * turns_per_firing, 1.0);
}

Beams make_steered_beams(const FiringSchedule& pulses, const FrameInterval& interval,
                         std::size_t rows, const FiringDirections& directions_at) {
  const FiringRange range = firings_in(pulses, interval, kMaxBeams / rows);
  Beams beams;
  beams.rows = static_cast<std::uint32_t>(rows);
  beams.cols = static_cast<std::uint32_t>(range.size());
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions.resize(rows * range.size());
  beams.times_ns.resize(rows * range.size());
  beams.rings.resize(rows * range.size());
  std::vector<Eigen::Vector3d> column(rows);
  for (std::size_t col = 0; col < range.size(); ++col) {
    const std::int64_t k = range.begin + static_cast<std::int64_t>(col);
    directions_at(k, column);
    const auto time_ns = static_cast<std::uint32_t>(firing_time_ns(pulses, k) - interval.start_ns);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t i = row * range.size() + col;
      beams.directions[i] = column[row];
      beams.times_ns[i] = time_ns;
      beams.rings[i] = static_cast<std::uint16_t>(row);
    }
  }
  return beams;
}

namespace {

constexpr std::size_t kMaxParts = 64;

void validate(const RisleyPrism& p) {
  require_number(std::isfinite(p.rotation_hz), "optics, prism, rotation", p.rotation_hz,
                 "a finite number");
  require_number(p.apex_rad >= 0.0 && p.apex_rad < 0.5 * std::numbers::pi,
                 "optics, prism, apex angle", p.apex_rad, "from 0 to below pi/2");
  require_number(std::isfinite(p.phase_rad), "optics, prism, phase", p.phase_rad, "a finite angle");
  require_number(p.refractive_index >= 1.0 && p.refractive_index <= 10.0,
                 "optics, prism, refractive index", p.refractive_index, "1 to 10");
}

void validate(const Prism& prism) {
  require_number(!prism.prisms.empty() && prism.prisms.size() <= kMaxParts,
                 "optics, number of prisms", static_cast<double>(prism.prisms.size()), "1 to 64");
  const std::size_t beams = prism.incidence_rad.size();
  require_number(beams >= 1 && beams <= kMaxParts, "optics, number of incident beams",
                 static_cast<double>(beams), "1 to 64");
  for (const double angle : prism.incidence_rad) {
    require_number(std::abs(angle) < 0.5 * std::numbers::pi, "optics, incident beam", angle,
                   "above -pi/2 and below pi/2");
  }
  require_number(std::isfinite(prism.incidence_roll_rad), "optics, roll of the incident beams",
                 prism.incidence_roll_rad, "a finite angle");
  require_number(prism.pulse_hz > 0.0 && prism.pulse_hz <= kSecond_ns, "optics, pulses per second",
                 prism.pulse_hz, "above 0, up to 1e9");
  for (const RisleyPrism& p : prism.prisms) validate(p);
}

/// The normal of the oblique face at this phase, opposed to the light. Axes: x along the boresight,
/// y left, z up; the prism deflects downwards at phase 0, then to the left, up and to the right.
Eigen::Vector3d slope_normal(const RisleyPrism& p, double turns) {
  const double side = p.slope == RisleyPrism::Slope::entry ? 1.0 : -1.0;
  const SineCosine apex = sincos_turns(p.apex_rad / kTwoPi);
  const SineCosine phase = sincos_turns(turns);
  return {-apex.cosine, -side * apex.sine * phase.sine, side * apex.sine * phase.cosine};
}

Eigen::Vector3d pass(const RisleyPrism& p, double turns, const Eigen::Vector3d& incident) {
  const Eigen::Vector3d square = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d slope = slope_normal(p, turns);
  const bool slope_first = p.slope == RisleyPrism::Slope::entry;
  const Eigen::Vector3d inside =
      refract(incident, slope_first ? slope : square, 1.0 / p.refractive_index);
  return refract(inside, slope_first ? square : slope, p.refractive_index);
}

/// Phases of all prisms at firing k, in turns.
void find_phases(const Prism& prism, std::int64_t k, std::vector<double>& turns) {
  turns.clear();
  for (const RisleyPrism& p : prism.prisms)
    turns.push_back(phase_turns(p.phase_rad / kTwoPi, p.rotation_hz / prism.pulse_hz, k));
}

Eigen::Vector3d incident_beam(const Prism& prism, std::size_t row) {
  const SineCosine angle = sincos_turns(prism.incidence_rad[row] / kTwoPi);
  const SineCosine roll = sincos_turns(prism.incidence_roll_rad / kTwoPi);
  return {angle.cosine, -angle.sine * roll.cosine, angle.sine * roll.sine};
}

Eigen::Vector3d pass_all(const Prism& prism, const std::vector<double>& turns,
                         const Eigen::Vector3d& incident) {
  Eigen::Vector3d beam = incident;
  for (std::size_t i = 0; i < prism.prisms.size(); ++i)
    beam = pass(prism.prisms[i], turns[i], beam);
  return beam;
}

}  // namespace

Beams make_beams(const Prism& prism, const FrameInterval& interval) {
  validate(prism);
  const FiringSchedule pulses = {0.0, kSecond_ns / prism.pulse_hz};
  std::vector<Eigen::Vector3d> incident;
  for (std::size_t row = 0; row < prism.incidence_rad.size(); ++row)
    incident.push_back(incident_beam(prism, row));
  std::vector<double> turns;
  return make_steered_beams(pulses, interval, incident.size(),
                            [&](std::int64_t k, std::span<Eigen::Vector3d> directions) {
                              find_phases(prism, k, turns);
                              for (std::size_t row = 0; row < directions.size(); ++row)
                                directions[row] = pass_all(prism, turns, incident[row]);
                            });
}

void describe(RisleyPrism& prism, FieldVisitor& visitor) {
  using Slope = RisleyPrism::Slope;
  constexpr std::array<Named<Slope>, 2> kNames = {{{"entry", Slope::entry}, {"exit", Slope::exit}}};
  visitor.number({"rotation_hz", "turns per second, from down to the left; negative: to the right",
                  kUnitHertz, kRequired},
                 kFinite, prism.rotation_hz);
  visitor.number({"apex_deg", "angle between the faces", kUnitDegree, kRequired},
                 {0.0, 89.0, false, "degrees from 0 to 89"}, prism.apex_rad);
  visitor.number({"phase_deg", "angle at time 0; at 0 the prism deflects downwards", kUnitDegree},
                 {-360.0, 360.0, false, "degrees from -360 to 360"}, prism.phase_rad);
  visitor.number({"refractive_index", "of the glass", kNoUnit, kRequired},
                 {1.0, 10.0, false, "a number from 1 to 10"}, prism.refractive_index);
  visit_choice(visitor,
               {"slope", "the inclined face; the other one is perpendicular to the boresight"},
               kNames, prism.slope);
}

void describe(Prism& prism, FieldVisitor& visitor) {
  constexpr std::uint32_t kMaxParts = 64;
  constexpr NumberRule kPulses = {0.0, 1e9, true, "a number above 0, below 1e9"};
  constexpr NumberRule kIncidence = {-89.0, 89.0, false, "degrees from -89 to 89"};
  visitor.number({"pulse_hz", "pulses per second of each beam", kUnitHertz, kRequired}, kPulses,
                 prism.pulse_hz);
  visit_list(visitor,
             {"prisms", "prisms in the order in which the light passes them", kNoUnit, kRequired},
             {1, kMaxParts}, "a list of 1 to 64 prisms", prism.prisms);
  visitor.numbers({"incidence_deg",
                   "one beam for each number: angle to the boresight at which it enters the first "
                   "prism",
                   kUnitDegree},
                  {.number = kIncidence, .max_size = kMaxParts}, prism.incidence_rad);
  visitor.number({"incidence_roll_deg",
                  "direction of positive `incidence_deg`: 0 to the right, 90 up", kUnitDegree},
                 {-360.0, 360.0, false, "degrees from -360 to 360"}, prism.incidence_roll_rad);
}

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
