// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/console.hpp>
#include <glidar/link/socket.hpp>

#include <string>

namespace glidar::app {

/// The keys of a file of two lines, "public KEY" and "secret KEY". Without such a file they are
/// made, written to it, for its owner only, and the public one is told. Throws Error.
link::CurveKeys curve_keys(const std::string& path, Console& console);

}  // namespace glidar::app
