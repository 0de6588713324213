// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/optics/prism.hpp>

#include <cmath>
#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <limits>
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
  const std::size_t beams = prism.incidence_tangent.size();
  require_number(beams >= 1 && beams <= kMaxParts, "optics, number of incident beams",
                 static_cast<double>(beams), "1 to 64");
  for (const double right : prism.incidence_tangent) {
    require_number(std::abs(right) < 1.0, "optics, incident beam", right, "above -1 and below 1");
  }
  require_number(prism.pulse_hz > 0.0 && prism.pulse_hz <= kSecond_ns, "optics, pulses per second",
                 prism.pulse_hz, "above 0, up to 1e9");
  for (const RisleyPrism& p : prism.prisms) validate(p);
}

/// Snell's law for vectors: the unit direction behind a face whose unit normal is opposed to the
/// light; `ratio` is the refractive index before over that behind. NaN for total reflection.
Eigen::Vector3d refract(const Eigen::Vector3d& b, const Eigen::Vector3d& normal, double ratio) {
  const double cosine = -b.dot(normal);
  const double root = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (!(root >= 0.0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return (ratio * b + (ratio * cosine - std::sqrt(root)) * normal).normalized();
}

/// The normal of the oblique face at this phase, opposed to the light. Axes: x along the boresight,
/// y left, z up; the prism deflects downwards at phase 0, then to the right, up and left.
Eigen::Vector3d slope_normal(const RisleyPrism& p, double phase_rad) {
  const double side = p.slope == RisleyPrism::Slope::entry ? 1.0 : -1.0;
  const double s = side * std::sin(p.apex_rad);
  return {-std::cos(p.apex_rad), -s * std::sin(phase_rad), s * std::cos(phase_rad)};
}

Eigen::Vector3d pass(const RisleyPrism& p, double phase_rad, const Eigen::Vector3d& incident) {
  const Eigen::Vector3d square = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d slope = slope_normal(p, phase_rad);
  const bool slope_first = p.slope == RisleyPrism::Slope::entry;
  const Eigen::Vector3d inside =
      refract(incident, slope_first ? slope : square, 1.0 / p.refractive_index);
  return refract(inside, slope_first ? square : slope, p.refractive_index);
}

/// Phases of all prisms at firing k; whole turns are left out, so that they stay exact for long.
void set_phases(const Prism& prism, std::int64_t k, std::vector<double>& phases_rad) {
  for (std::size_t i = 0; i < prism.prisms.size(); ++i) {
    const RisleyPrism& p = prism.prisms[i];
    const double turns = std::fmod(static_cast<double>(k) * (p.rotation_hz / prism.pulse_hz), 1.0);
    phases_rad[i] = p.phase_rad + 2.0 * std::numbers::pi * turns;
  }
}

Eigen::Vector3d pass_all(const Prism& prism, const std::vector<double>& phases_rad, double right) {
  Eigen::Vector3d beam(std::sqrt(1.0 - right * right), -right, 0.0);
  for (std::size_t i = 0; i < prism.prisms.size(); ++i) {
    beam = pass(prism.prisms[i], phases_rad[i], beam);
  }
  return beam;
}

}  // namespace

Beams make_beams(const Prism& prism, const FrameInterval& interval) {
  validate(prism);
  const std::size_t rows = prism.incidence_tangent.size();
  const FiringSchedule pulses = {0.0, kSecond_ns / prism.pulse_hz};
  const FiringRange range = firings_in(pulses, interval, kMaxBeams / rows);
  Beams beams;
  beams.rows = static_cast<std::uint32_t>(rows);
  beams.cols = static_cast<std::uint32_t>(range.size());
  beams.frame_id = "lidar_frame";
  beams.boresight = Eigen::Vector3d::UnitX();
  beams.directions.resize(rows * range.size());
  beams.times_ns.resize(rows * range.size());
  beams.rings.resize(rows * range.size());
  std::vector<double> phases_rad(prism.prisms.size());
  for (std::size_t col = 0; col < range.size(); ++col) {
    const std::int64_t k = range.begin + static_cast<std::int64_t>(col);
    set_phases(prism, k, phases_rad);
    const auto time_ns = static_cast<std::uint32_t>(firing_time_ns(pulses, k) - interval.start_ns);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t i = row * range.size() + col;
      beams.directions[i] = pass_all(prism, phases_rad, prism.incidence_tangent[row]);
      beams.times_ns[i] = time_ns;
      beams.rings[i] = static_cast<std::uint16_t>(row);
    }
  }
  return beams;
}

void describe(RisleyPrism& prism, FieldVisitor& visitor) {
  using Slope = RisleyPrism::Slope;
  constexpr std::array<Named<Slope>, 2> kNames = {{{"entry", Slope::entry}, {"exit", Slope::exit}}};
  visitor.number(
      {"rotation_hz", "turns per second; negative: the other direction", kUnitHertz, kRequired},
      kFinite, prism.rotation_hz);
  visitor.number({"apex_deg", "angle between the faces", kUnitDegree, kRequired},
                 {0.0, 89.0, false, "degrees from 0 to 89"}, prism.apex_rad);
  visitor.number({"phase_deg", "angle at time 0", kUnitDegree},
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
  constexpr NumberRule kSine = {-1.0, 1.0, true, "a number above -1 and below 1"};
  visitor.number({"pulse_hz", "pulses per second of each beam", kUnitHertz, kRequired}, kPulses,
                 prism.pulse_hz);
  visit_list(visitor,
             {"prisms", "prisms in the order in which the light passes them", kNoUnit, kRequired},
             {1, kMaxParts}, "a list of 1 to 64 prisms", prism.prisms);
  visitor.numbers({"incidence_tangent",
                   "one beam for each number: sine of the angle to the right at which it enters "
                   "the first prism"},
                  {.number = kSine, .max_size = kMaxParts}, prism.incidence_tangent);
}

}  // namespace glidar
