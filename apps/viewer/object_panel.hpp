// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/viewer.hpp>

namespace glidar::app {

/// A list of the scene's objects for selection, and the pose of the selected one.
void show_objects(Viewer& viewer);

}  // namespace glidar::app
