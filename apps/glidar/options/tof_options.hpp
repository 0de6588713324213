// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glidar::app {

/// The command line of `glidar tof`.
struct TofFlags {
  std::string raw;
  std::string sensor;  ///< empty: not given
  std::vector<std::string> outputs;
  double depth_unit_mm = 1.0;
  std::optional<std::array<std::uint32_t, 2>> explained;  ///< column and row
  unsigned threads = 0;
  bool quiet = false;
};

/// Declares all options but RAW.
void add_tof_options(CLI::App& command, TofFlags& flags);

}  // namespace glidar::app
