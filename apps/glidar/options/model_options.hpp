// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/io/model/model.hpp>

namespace glidar::app {

/// --unit --up --centre --texture-folder --no-cache --cache-folder.
void add_model_options(CLI::App& command, ModelOptions& options);

}  // namespace glidar::app
