// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/echo.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidar {

/// How the returns of one pulse came to be.
struct WaveformTrace {
  /// A path by which light returned.
  struct LightPath {
    EchoContribution path;                 ///< its source is the sub-ray of the pulse
    double share = 0.0;                    ///< of the pulse's energy on the sub-ray; of the air: 0
    std::uint32_t instance = kInvalidId;   ///< what the sub-ray hit, in Scene::instances
    std::uint32_t reflected = kInvalidId;  ///< of a ghost: what was hit by way of that mirror
    double velocity_m_s = 0.0;             ///< radial velocity; 0 if it is not measured
  };
  std::size_t pulse = 0;  ///< which pulse to trace
  std::size_t sub_rays = 0;
  bool is_in_closed_form = false;  ///< all sub-rays are one path, see FlatFootprints
  std::vector<LightPath>
      light_paths;                  ///< PulseEcho::strongest counts in them; wide apart: by range
  std::vector<PulseEcho> echoes;    ///< peaks of the waveform, in order of range
  std::vector<PulseEcho> received;  ///< those left with the receiver's noise and separation
  std::vector<int> returns;         ///< per return of the receiver: which of `received`, or -1
  /// Per return of the receiver: radial velocity before errors, NaN for none. Empty: not measured.
  std::vector<double> velocities_m_s;
};

}  // namespace glidar
