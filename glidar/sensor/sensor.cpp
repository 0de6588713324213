// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/sensor.hpp>

namespace glidar {

Beams make_beams(const Sensor& sensor) {
  return std::visit([](const auto& optics) { return make_beams(optics); }, sensor.optics);
}

}  // namespace glidar
