// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/motion_document.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <utility>

namespace glidar {

std::string motion_document(const Trajectory& trajectory) {
  MotionKeys keys;
  keys.trajectory = trajectory;
  const nlohmann::ordered_json document = write_struct(FieldVisitor::Mode::document, keys);
  if (!document.empty()) return document.dump();
  throw Error({.where = "motion",
               .found = "a trajectory that has no such keys",
               .allowed = "a spin, a twist or a torque-free rotation",
               .remedy = ""});
}

Trajectory parse_motion(const std::string& text, const Pose& start, std::int64_t t0_ns) {
  MotionKeys keys;
  keys.start = start;
  keys.t0_ns = t0_ns;
  read_struct(read_yaml_text("motion", text), keys);
  return *std::move(keys.trajectory);
}

}  // namespace glidar
