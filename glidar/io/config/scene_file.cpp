// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_file.hpp>

#include <glidar/io/config/scene_builder.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <string_view>

namespace glidar {
namespace {

std::vector<Trajectory> trajectories(const ScenePlan& plan) {
  const auto moves = [](const PlannedInstance& planned) { return planned.motion.has_value(); };
  if (std::none_of(plan.instances.begin(), plan.instances.end(), moves)) return {};
  std::vector<Trajectory> all;
  for (const PlannedInstance& planned : plan.instances) {
    all.push_back(planned.motion.value_or(ConstantPose{planned.world_from_object}));
  }
  return all;
}

/// The same without repetitions: what is wrong with the model cache concerns every model.
Report each_once(const Report& report) {
  if (!report.log) return report;
  const auto reported = std::make_shared<std::set<std::string, std::less<>>>();
  const auto log = [reported, log = report.log](Severity severity, std::string_view message) {
    if (reported->emplace(message).second) log(severity, message);
  };
  return {log, report.progress};
}

/// The scene as planned, with its models.
SceneFile load_plan(const ScenePlan& plan, const Report& report) {
  const Report once = each_once(report);
  const auto load = [&](const std::string& source, const ModelOptions& options) {
    return load_model(source, options, once);
  };
  return {.scene = build_scene(plan, load),
          .sensors = plan.sensors,
          .world_from_rig = plan.world_from_rig,
          .looks_at = plan.looks_at,
          .files = plan.files,
          .world_from_instance = trajectories(plan),
          .rig_motion = plan.rig_motion,
          .imus = plan.imus,
          .gravity_m_s2 = plan.gravity_m_s2};
}

}  // namespace

SceneFile load_scene_file(const std::filesystem::path& path, const ModelOptions& defaults,
                          const Report& report) {
  return load_plan(read_scene_plan(path, defaults), report);
}

SceneFile parse_scene(const std::string& text, const Report& report,
                      const std::filesystem::path& folder) {
  return load_plan(read_scene_plan(read_yaml_text((folder / "scene").string(), text), {}), report);
}

}  // namespace glidar
