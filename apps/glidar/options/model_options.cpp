// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/model_options.hpp>

#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <glidar/io/config/length_unit.hpp>

namespace glidar::app {

void add_model_options(CLI::App& command, ModelOptions& options) {
  const OptionGroup group(command, "Model");
  std::vector<std::pair<std::string, double>> units;
  for (const Named<double>& unit : kLengthUnits) units.emplace_back(unit.name, unit.value);
  group.add("--unit", "UNIT", "Unit: mm, cm, m, in or ft [as the file declares, or m]",
            options.metres_per_unit, one_of(units));
  group.add("--up", "AXIS", "Axis that points up: x, y or z [as the file declares, or z]",
            options.up, one_of<Axis>({{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}));
  group.add_flag("--centre", "Move the centre of the model's bounding box to its origin",
                 options.centre);
  group.add_repeatable(
      "--texture-folder", "DIR", "Folder of textures outside the model's folder [none]; repeatable",
      [&options](const std::string& text) { options.texture_folders.emplace_back(text); });
  group.add_flag("--no-cache", "Neither read nor write the model cache", options.use_cache, false);
  group.add("--cache-folder", "DIR", "Folder of the model cache [~/.cache/glidar]",
            [&options](const std::string& text) { options.cache_folder = text; });
}

}  // namespace glidar::app
