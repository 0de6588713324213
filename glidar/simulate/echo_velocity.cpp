// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/echo_velocity.hpp>

#include <glidar/simulate/pulse_cast.hpp>

namespace glidar {
namespace {

/// Of the path over a mirror, whose legs have the directions d1 and d2. Its length is stationary
/// where the light meets the mirror (Fermat's principle), so that point may be taken as fixed to
/// the mirror: d1 . (v_M - v_O) + d2 . (v_P - v_M).
double ghost_velocity_m_s(const Simulation& s, std::uint32_t sub_ray,
                          RadialVelocities& velocities) {
  const SubRayWorkspace& memory = s.workspace.sub_rays;
  const std::size_t mirrored = mirrored_beam(memory, sub_ray);
  const double range_m = memory.mirrored_hits.range_m[mirrored];
  const BeamPoint seen = beam_point(memory.mirrored, mirrored, s.frame.stamp_ns, range_m);
  const BeamPoint mirror = beam_point(memory.mirrored, mirrored, s.frame.stamp_ns, 0.0);
  return memory.velocities_m_s[sub_ray] +
         velocities.at(seen, memory.mirrored_hits.instance[mirrored]) -
         velocities.at(mirror, memory.hits.instance[sub_ray]);
}

}  // namespace

double path_velocity_m_s(const Simulation& s, std::size_t pulse, const EchoContribution& path,
                         RadialVelocities& velocities) {
  if (path.source == kInvalidId) {
    return velocities.at(beam_point(*s.fired, pulse, s.frame.stamp_ns, 0.0), kInvalidId);
  }
  if (path.return_source == ReturnSource::ghost) {
    return ghost_velocity_m_s(s, path.source, velocities);
  }
  return s.workspace.sub_rays.velocities_m_s[path.source];
}

double echo_velocity_m_s(const Simulation& s, std::size_t pulse, const WaveformBuffer& waveform,
                         const PulseEcho& echo) {
  RadialVelocities velocities(s.motion);
  const auto velocity_of = [&](std::size_t i) {
    return path_velocity_m_s(s, pulse, waveform.path[i], velocities);
  };
  const double first_m_s = velocity_of(echo.begin);
  double sum = 0.0;
  double moment_m_s = 0.0;  // about the first one, so that equal velocities have exactly their mean
  for (std::size_t i = echo.begin; i < echo.end; ++i) {
    sum += waveform.path[i].signal;
    moment_m_s += waveform.path[i].signal * (velocity_of(i) - first_m_s);
  }
  return first_m_s + (sum > 0.0 ? moment_m_s / sum : 0.0);
}

}  // namespace glidar
