// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/stereo/stereo_depth.hpp>
#include <glidar/stereo/stereo_options.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The command line of `glidar stereo`.
struct StereoFlags {
  std::string left;
  std::string right;
  std::vector<std::string> outputs;
  StereoOptions options;
  double focal_length_px = 0.0;  ///< 0: not given
  double baseline_mm = 0.0;      ///< 0: not given
  double column_offset_px = 0.0;
  double depth_unit_mm = 1.0;
  std::optional<std::array<std::uint32_t, 2>> explained;  ///< column and row
  unsigned threads = 0;
  bool quiet = false;
};

/// Declares all options but LEFT and RIGHT.
void add_stereo_options(CLI::App& command, StereoFlags& flags);

}  // namespace glidar::app
