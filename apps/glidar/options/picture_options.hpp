// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <apps/glidar/options/output_options.hpp>
#include <glidar/io/formats/file_sink.hpp>

#include <string>

namespace glidar::app {

/// How .bev.png and .view.png are drawn. Throws Error when a flag is malformed.
CloudPictureOptions picture_options(const OutputFlags& flags);

/// Adds the options of .bev.png and .view.png.
void add_picture_flags(CLI::App& command, OutputFlags& flags, const std::string& group);

}  // namespace glidar::app
