// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/scene_file.hpp>

#include <glidar/io/scene_builder.hpp>

namespace glidar {

SceneFile load_scene_file(const std::filesystem::path& path, const ModelOptions& defaults,
                          const Report& report) {
  const ScenePlan plan = read_scene_plan(path, defaults);
  const auto load = [&](const std::string& source, const ModelOptions& options) {
    return load_model(source, options, report);
  };
  return {build_scene(plan, load), plan.sensor, plan.world_from_sensor, plan.looks_at};
}

}  // namespace glidar
