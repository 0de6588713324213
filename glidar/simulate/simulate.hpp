// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/setup.hpp>

#include <span>

namespace glidar {

/// Measures the scene once: frame.stamp_ns and frame.seed say when and with which random numbers,
/// `fields` what truth to keep beside the range. The frame's memory is reused.
void simulate(const Setup& setup, const HitFieldMask& fields, Frame& frame);

/// The same for many at once, as for Monte Carlo: frames[i] comes out as simulate(setups[i], ...)
/// makes it, to the bit. The setups have one renderer in common, and may differ in all else: poses
/// are their motion's, seeds their frames'. A renderer that draws takes less time for many small
/// frames together than one by one. Throws Error unless there is a setup per frame.
void simulate_batch(std::span<const Setup> setups, const HitFieldMask& fields,
                    std::span<Frame> frames);

/// All of it before the sensor's noise but for errors of pointing: what apply_noise is applied to.
void measure(const Setup& setup, const HitFieldMask& fields, Frame& frame);

}  // namespace glidar
