// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/setup.hpp>

namespace glidar {

/// Measures the scene once: frame.stamp_ns and frame.seed say when and with which random numbers,
/// `fields` what truth to keep beside the range. The frame's memory is reused.
void simulate(const Setup& setup, const HitFields& fields, Frame& frame);

/// All of it before the sensor's noise but for errors of pointing: what apply_noise is applied to.
void measure(const Setup& setup, const HitFields& fields, Frame& frame);

}  // namespace glidar
