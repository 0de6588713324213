// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/render/renderer.hpp>

#include <string>

namespace glidar::app {

class OptionGroup;

/// --renderer --threads --graphics-device.
void add_run_options(CLI::App& command, RendererOptions& options, const std::string& heading);

void add_threads_option(const OptionGroup& group, RendererOptions& options);

}  // namespace glidar::app
