// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/setup.hpp>

namespace glidar {

/// Draws the paper's picture into the frame and reads range, intensity and status of all beams from
/// it. Throws Error when the sensor measures otherwise than such a picture can tell.
void measure_woods2016(const Setup& setup, const Woods2016Target& paper, Frame& frame);

}  // namespace glidar
