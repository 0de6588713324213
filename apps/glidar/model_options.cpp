// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/model_options.hpp>

#include <glidar/io/length_unit.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

void add_model_flags(CLI::App& command, ModelFlags& flags) {
  command.add_option("--unit", flags.unit, "Unit of the model file's numbers: mm cm m in [m]")
      ->check(CLI::IsMember(length_unit_names()))
      ->type_name("UNIT")
      ->group("Model");
  command.add_option("--up", flags.up, "Axis of the file that points up: x y z; it becomes +z")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->type_name("AXIS")
      ->group("Model");
  command
      .add_flag("--no-cache", flags.no_cache, "Neither read nor write the cache of loaded models")
      ->group("Model");
  command.add_option("--cache-folder", flags.cache_folder, "Where that cache is [~/.cache/glidar]")
      ->type_name("DIR")
      ->group("Model");
}

ModelOptions model_options(const ModelFlags& flags) {
  ModelOptions options;
  for (const LengthUnit& unit : kLengthUnits) {
    if (flags.unit == unit.name) options.metres_per_unit = unit.metres;
  }
  if (flags.up == "x") options.up = Axis::x;
  if (flags.up == "y") options.up = Axis::y;
  if (flags.up == "z") options.up = Axis::z;
  options.use_cache = !flags.no_cache;
  options.cache_folder = flags.cache_folder;
  return options;
}

}  // namespace glidar::app
