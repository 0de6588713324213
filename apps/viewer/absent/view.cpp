// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view.hpp>

#include <glidar/core/error.hpp>

#include <CLI/CLI.hpp>

namespace glidar::app {

/// The command in builds without the viewer.
Command add_view(CLI::App& program) {
  CLI::App& command = *program.add_subcommand("view", "Not there: built without the window");
  command.allow_extras();
  return []() -> int {
    throw Error({.where = "glidar view",
                 .found = "this program was built without its window",
                 .remedy =
                     "build it with -DGLIDAR_BUILD_VIEWER=ON, or write a picture: glidar render "
                     "MODEL -o picture.png"});
  };
}

bool has_viewer() {
  return false;
}

}  // namespace glidar::app
