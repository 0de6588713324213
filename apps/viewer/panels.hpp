// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/viewer.hpp>

namespace glidar::app {

/// The rate of drawing.
struct FrameRate {
  double frames_per_s = 0.0;  ///< frames drawn, without idle time
};

/// The widgets beside the views; called between Window::begin() and end(), within an open window of
/// Dear ImGui. Each applies the user's input at once.
void show_controls(Viewer& viewer);
void show_status(const Viewer& viewer, const FrameRate& rate);
void show_errors(Viewer& viewer);
void show_trace(Viewer& viewer);

/// The scale or legend below the sensor's image.
void show_legend(const Viewer& viewer);

}  // namespace glidar::app
