// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::link {

/// Throws Error when a socket at ipc://PATH would take the place of something else: ZeroMQ would
/// remove whatever file has this name, and the socket of a program that still listens there.
void require_free_place(const std::string& path);

}  // namespace glidar::link
