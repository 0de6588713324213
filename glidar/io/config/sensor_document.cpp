// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/sensor_document.hpp>

#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_keys.hpp>

namespace glidar {

std::string sensor_document(const Sensor& sensor) {
  return write_struct(FieldVisitor::Mode::document, sensor_keys(sensor)).dump();
}

}  // namespace glidar
