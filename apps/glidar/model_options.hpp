// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/cli_fwd.hpp>
#include <glidar/io/model.hpp>

#include <string>

namespace glidar::app {

/// --unit --up --no-cache --cache-folder.
struct ModelFlags {
  std::string unit;  ///< empty: not given, metres
  std::string up;    ///< empty: axes as in the file
  bool no_cache = false;
  std::string cache_folder;
};

void add_model_flags(CLI::App& command, ModelFlags& flags);

ModelOptions model_options(const ModelFlags& flags);

}  // namespace glidar::app
