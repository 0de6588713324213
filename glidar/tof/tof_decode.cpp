// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/tof_decode.hpp>

#include <glidar/tof/decoding.hpp>

#include <array>

namespace glidar {

const char* to_string(TofStatus status) {
  static constexpr std::array<const char*, kTofStatusCount> kNames = {
      "valid",     "not_illuminated", "saturated", "low_signal",
      "ambiguous", "too_near",        "too_far",   "edge"};
  return kNames[static_cast<std::size_t>(status)];
}

TofMeasurement decode_tof(const TofImages& images, const TofOptions& options,
                          const TofCalibration& calibration, const TofRun& run) {
  return tof::decode(images, options, calibration, run.pool).measurement;
}

}  // namespace glidar
