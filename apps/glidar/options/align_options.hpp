// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/run/depth_images.hpp>

#include <string>

namespace glidar::app {

/// The command line of `glidar align`.
struct AlignFlags {
  DepthImageFiles files;
  std::string cameras;
  bool keeps_depth = false;
  bool quiet = false;
};

/// Declares all arguments.
void add_align_options(CLI::App& command, AlignFlags& flags);

}  // namespace glidar::app
