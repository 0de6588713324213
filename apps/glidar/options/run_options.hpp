// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/render/renderer.hpp>

#include <string>

namespace glidar::app {

/// --renderer --threads --graphics-device.
void add_run_flags(CLI::App& command, RendererOptions& options, const std::string& group);

}  // namespace glidar::app
