// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/console.hpp>
#include <glidar/link/socket.hpp>

#include <string>

namespace glidar::app {

/// The keys in a file of two lines, "public KEY" and "secret KEY". If the file does not exist, it
/// is created with new keys, readable by its owner only, and the public key is printed. Throws
/// Error.
link::CurveKeys curve_keys(const std::string& path, Console& console);

}  // namespace glidar::app
