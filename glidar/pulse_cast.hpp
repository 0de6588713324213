// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/setup.hpp>

namespace glidar {

/// True when a beam of this sensor is more than one ray with one return: it has a footprint, tells
/// several returns or another than the strongest, walks, or meets mirrors or weather.
bool has_echoes(const Sensor& sensor, const Scene& scene);

/// Casts the beams of a sensor of pulses as they really are: every one spreads into sub-rays, which
/// go on from mirrors once; what comes back makes a waveform, its peaks are echoes, and the
/// receiver tells some of them. Fills range, intensity, status and cause, and the truth of every
/// return: that of the strongest of its paths, or when there is no return, of the strongest that
/// came back.
///
/// `aimed` are the beams as they really go. Draws with Purpose::detection and weather.
void measure_pulses(const Setup& setup, const HitFields& fields, const Beams& aimed, Frame& frame);

}  // namespace glidar
