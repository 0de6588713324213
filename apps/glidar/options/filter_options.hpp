// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/run/depth_images.hpp>
#include <glidar/depth/depth_filter.hpp>

#include <vector>

namespace glidar::app {

/// The command line of `glidar filter`.
struct FilterFlags {
  DepthImageFiles files;
  std::vector<DepthFilter> filters;  ///< empty: the recommended ones
  double focal_length_px = 0.0;      ///< 0: not given
  double baseline_mm = 0.0;          ///< 0: not given
  bool quiet = false;
};

/// Declares all arguments.
void add_filter_options(CLI::App& command, FilterFlags& flags);

}  // namespace glidar::app
