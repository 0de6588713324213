// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/model_options.hpp>

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
  command.add_option("--unit", flags.unit, "Unit of the model file's numbers: mm cm m in [m]")
      ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
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
  if (!flags.unit.empty()) options.metres_per_unit = metres_per_unit().at(flags.unit);
  if (flags.up == "x") options.up = Axis::x;
  if (flags.up == "y") options.up = Axis::y;
  if (flags.up == "z") options.up = Axis::z;
  options.use_cache = !flags.no_cache;
  options.cache_folder = flags.cache_folder;
  return options;
}

}  // namespace glidar::app
