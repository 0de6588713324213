// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// Range, intensity, status, source and ground truth of all returns of a tile of pulses, whose
/// sub-rays' hits are in the workspace. What returns along the sub-rays, from mirrors and from the
/// air adds up to a waveform; its peaks are echoes, of which the receiver reports some.
/// Each return has the ground truth of the strongest of its paths or, where no surface made it, of
/// the strongest path of the beam. Samples with Purpose::detection and weather.
void measure_waveforms(const Simulation& s, BeamRange tile);

/// Repeats the measurement of a pulse, and of the few around it, of a frame that was simulated. The
/// frame is a copy, which is overwritten.
WaveformTrace trace_waveform(const Simulation& s, std::size_t pulse, Frame frame);

}  // namespace glidar
