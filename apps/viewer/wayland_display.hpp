// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::app {

/// The value of an environment variable; empty: none.
std::string variable(const char* name);

/// A variable and its value, or that it is not set, as in messages.
std::string variable_text(const char* name);

/// Why no window can open on the Wayland display of WAYLAND_DISPLAY; empty: one can. Without a
/// runtime folder or a socket libwayland prints messages, and without a seat, as of a compositor
/// without a screen, GLFW 3.4 crashes.
std::string missing_wayland();

}  // namespace glidar::app
