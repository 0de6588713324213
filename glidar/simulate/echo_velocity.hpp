// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/radial_velocity.hpp>
#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/simulate/simulation.hpp>

#include <cstddef>

namespace glidar {

/// The radial velocity of a contribution to the waveform of a pulse: the rate at which the length
/// of its path grows. The air is at rest. Reads the sub-rays in Simulation::workspace.
double path_velocity_m_s(const Simulation& s, std::size_t pulse, const EchoContribution& path,
                         RadialVelocities& velocities);

/// The radial velocity of an echo: like its range, the mean of its contributions, weighted by their
/// signals.
double echo_velocity_m_s(const Simulation& s, std::size_t pulse, const WaveformBuffer& waveform,
                         const PulseEcho& echo);

}  // namespace glidar
