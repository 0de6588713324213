// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/viewer.hpp>

#include <string>

namespace glidar::app {

/// Rounds to so many decimals, half away from zero; never returns -0. Keeps non-finite values.
double rounded(double value, int decimals);

/// Removes the minus sign of every zero number: "-0.00" becomes "0.00". All numbers in the window
/// use this or rounded().
std::string without_negative_zeros(const std::string& text);

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
