// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

#include <span>

namespace glidar {

/// The method: pointing noise; cast; limits and received signal of every tile; occlusion; radial
/// velocities; noise.
/// Each frame states its stamp_ns, seed, sensor_id and number. Frames for which takes_one_cast() is
/// true may be simulated together, others one at a time.
void simulate(std::span<Simulation> frames);

/// Range, intensity and status of a tile of beams (or pulses) from their hits: checks limits and
/// computes the received signal, by the paper's Phong model, the lidar equation or a waveform.
/// Called once for every tile: on the renderer's threads, or for pulses after their sub-rays are
/// cast.
void measure_tile(const Simulation& s, BeamRange tile);

/// True when the renderer casts the beams of the frame once, as they are.
bool takes_one_cast(const Simulation& s);

}  // namespace glidar
