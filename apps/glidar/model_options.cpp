// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/model_options.hpp>

#include <apps/glidar/option_kinds.hpp>

#include <CLI/CLI.hpp>

#include <map>

namespace glidar::app {
namespace {

const std::map<std::string, double>& metres_per_unit() {
  static const std::map<std::string, double> kUnits = {
      {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}};
  return kUnits;
}

}  // namespace

void add_model_flags(CLI::App& command, ModelFlags& flags) {
  const std::string group = "Model";
  add_choice(command, {"--unit", "UNIT", "Unit of the model file: mm, cm, m or in [m]", group},
             {"mm", "cm", "m", "in"}, flags.unit);
  add_choice(command,
             {"--up", "AXIS", "Axis of the model file that points up: x, y or z [z]", group},
             {"x", "y", "z"}, flags.up);
  command.add_flag("--no-cache", flags.no_cache, "Neither read nor write the cache of models")
      ->group(group);
  add_text(command, {"--cache-folder", "DIR", "Folder of that cache [~/.cache/glidar]", group},
           flags.cache_folder);
}

ModelOptions model_options(const ModelFlags& flags) {
  ModelOptions options;
  if (!flags.unit.empty()) options.metres_per_unit = metres_per_unit().at(flags.unit);
  if (flags.up == "x") options.up = Axis::x;
  if (flags.up == "y") options.up = Axis::y;
  if (flags.up == "z") options.up = Axis::z;
  options.use_cache = !flags.no_cache;
  options.cache_folder = flags.cache_folder;
  return options;
}

}  // namespace glidar::app
