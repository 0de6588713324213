// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/simulate/setup.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

/// True when a beam of this sensor is more than one ray with one return: it has a footprint, tells
/// several returns or another than the strongest, walks, or meets mirrors or weather.
bool needs_waveform(const Sensor& sensor, const Scene& scene);

/// How the returns of one pulse came to be.
struct WaveformTrace {
  /// A way by which light came back.
  struct LightPath {
    EchoContribution path;                 ///< its source is the sub-ray of the pulse
    double share = 0.0;                    ///< of the pulse's energy on the sub-ray; of the air: 0
    std::uint32_t instance = kInvalidId;   ///< what the sub-ray hit, in Scene::instances
    std::uint32_t reflected = kInvalidId;  ///< of a ghost: what was hit by way of that mirror
  };
  std::size_t pulse = 0;  ///< which pulse to trace
  std::size_t sub_rays = 0;
  std::vector<LightPath>
      light_paths;                  ///< PulseEcho::strongest counts in them; wide apart: by range
  std::vector<PulseEcho> echoes;    ///< peaks of what came back, in order of range
  std::vector<PulseEcho> received;  ///< those left with the receiver's noise and separation
  std::vector<int> returns;         ///< per return of the receiver: which of `received`, or -1
};

/// Casts the beams of a sensor of pulses as they really are: every one spreads into sub-rays, which
/// go on from mirrors once; what comes back makes a waveform, its peaks are echoes, and the
/// receiver tells some of them. Fills range, intensity, status and return_source, and the truth of
/// every return: that of the strongest of its paths, or where no surface made it, of the strongest
/// that the beam met.
///
/// `aimed` are the beams as they really go. Draws with Purpose::detection and weather.
void simulate_waveforms(const Setup& setup, const HitFieldMask& fields, const Beams& aimed,
                        Frame& frame);

/// How a pulse of a frame that was measured came out as it did: the few pulses around it are
/// measured again, in the copy of the frame that is given.
WaveformTrace trace_waveform(const Setup& setup, const Beams& aimed, std::size_t pulse,
                             Frame frame);

}  // namespace glidar
