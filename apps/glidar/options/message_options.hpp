// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/cli_fwd.hpp>
#include <glidar/output/output.hpp>

#include <string>

namespace glidar::app {

/// Adds the options of messages.
void add_message_options(CLI::App& command, MessageOptions& flags);

/// Removes them from a command that writes no messages.
void remove_message_options(CLI::App& command);

/// The first of these options that is given and has no effect without messages; empty: none.
std::string given_message_option(const MessageOptions& flags);

/// The drivers, for the end of --help.
std::string driver_names_text();

}  // namespace glidar::app
