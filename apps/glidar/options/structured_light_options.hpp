// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <string>
#include <vector>

namespace glidar::app {

/// The command line of `glidar structured-light`.
struct StructuredLightFlags {
  std::string setup;
  std::vector<std::string> images;
  std::vector<std::string> outputs;
  std::string pattern_folder;  ///< empty: no patterns are written
  double depth_unit_mm = 0.1;
  unsigned threads = 0;
  bool quiet = false;
};

/// Declares all arguments.
void add_structured_light_options(CLI::App& command, StructuredLightFlags& flags);

}  // namespace glidar::app
