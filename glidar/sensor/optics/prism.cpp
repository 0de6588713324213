// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/prism.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/sensor/optics/steered_beams.hpp>

#include <cmath>
#include <numbers>

namespace glidar {
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

}  // namespace glidar
