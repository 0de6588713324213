// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/model_options.hpp>

#include <apps/glidar/options/option_kinds.hpp>
#include <glidar/io/config/length_unit.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_model_flags(CLI::App& command, ModelFlags& flags) {
  const std::string group = "Model";
  add_choice(
      command,
      {"--unit", "UNIT", "Unit of the file: mm, cm, m or in [as the file declares, or m]", group},
      {"mm", "cm", "m", "in"}, flags.unit);
  add_choice(command,
             {"--up", "AXIS", "Axis that points up: x, y or z [as the file declares, or z]", group},
             {"x", "y", "z"}, flags.up);
  command.add_flag("--centre", flags.centre, "Move the middle of the model's box to its origin")
      ->group(group);
  command.add_flag("--no-cache", flags.no_cache, "Neither read nor write the cache of models")
      ->group(group);
  add_text(command, {"--cache-folder", "DIR", "Folder of that cache [~/.cache/glidar]", group},
           flags.cache_folder);
}

ModelOptions model_options(const ModelFlags& flags) {
  ModelOptions options;
  for (const LengthUnit& unit : kLengthUnits) {
    if (flags.unit == unit.name) options.metres_per_unit = unit.metres;
  }
  if (flags.up == "x") options.up = Axis::x;
  if (flags.up == "y") options.up = Axis::y;
  if (flags.up == "z") options.up = Axis::z;
  options.centre = flags.centre;
  options.use_cache = !flags.no_cache;
  options.cache_folder = flags.cache_folder;
  return options;
}

}  // namespace glidar::app
