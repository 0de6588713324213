// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/io/model/model.hpp>

#include <string>

namespace glidar::app {

/// --unit --up --centre --no-cache --cache-folder.
struct ModelFlags {
  std::string unit;  ///< empty: not given, what the file declares, else metres
  std::string up;    ///< empty: what the file declares, else axes as in the file
  bool centre = false;
  bool no_cache = false;
  std::string cache_folder;
};

void add_model_flags(CLI::App& command, ModelFlags& flags);

ModelOptions model_options(const ModelFlags& flags);

}  // namespace glidar::app
