// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::app {

/// Prints the surface presets and their reflectances.
void list_surfaces(bool as_json);

}  // namespace glidar::app
