// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_file.hpp>

#include <glidar/io/config/scene_plan.hpp>

#include <functional>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

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
SceneFile load_plan(const ScenePlan& plan, const Report& report, Scene into = {}) {
  const Report once = each_once(report);
  const auto load = [&](const std::string& source, const ModelOptions& options) {
    return load_model(source, options, once);
  };
  return build_scene(plan, load, std::move(into));
}

}  // namespace

SceneFile load_scene_file(const std::filesystem::path& path, const ModelOptions& defaults,
                          const Report& report) {
  return load_plan(read_scene_plan(path, defaults), report);
}

SceneFile load_scene_content(const std::filesystem::path& path, const std::string& content,
                             const ModelOptions& defaults, const Report& report) {
  ScenePlan plan = read_scene_plan(read_yaml_content(path, content), defaults);
  plan.files.insert(plan.files.begin(), path.string());
  return load_plan(plan, report);
}

SceneFile parse_scene(const std::string& text, const Report& report,
                      const std::filesystem::path& folder) {
  return load_plan(read_scene_plan(read_yaml_text((folder / "scene").string(), text), {}), report);
}

void add_models(Scene& scene, const std::string& text, const ModelOptions& defaults,
                const std::vector<std::string>& sensors, const Report& report,
                const std::filesystem::path& folder) {
  ScenePlan plan = read_scene_plan(read_yaml_text((folder / "scene").string(), text), defaults);
  plan.sensors.clear();
  for (const std::string& name : sensors) plan.sensors.emplace_back().name = name;
  scene = load_plan(plan, report, scene).scene;
}

}  // namespace glidar
