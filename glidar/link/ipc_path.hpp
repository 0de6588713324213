// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::link {

/// Throws Error if another file, or the socket of a running program, has this path: ZeroMQ would
/// remove it.
void require_free_ipc_path(const std::string& path);

}  // namespace glidar::link
