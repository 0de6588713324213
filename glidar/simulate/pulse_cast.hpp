// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/math/distributions.hpp>
#include <glidar/simulate/simulation.hpp>

namespace glidar {

/// Pulses that one task measures; tiles of pulses begin at multiples of it.
inline constexpr std::size_t kPulsesPerTask = kSampleBatch;

/// The columns that a sub-ray's signal depends on.
inline constexpr HitColumnMask kSignalFields = {.shading = true, .diffuse = true};

/// Casts pulses as they are: every one spreads into sub-rays, which mirrors reflect once. Calls
/// on_tile_done for every pulse once, on the renderer's threads, while Simulation::workspace holds
/// the hits of its sub-rays. `pulses` begins at a multiple of kPulsesPerTask.
void cast_pulses(const Simulation& s, BeamRange pulses, FunctionRef<void(BeamRange)> on_tile_done);

/// Index of a pulse's first sub-ray in the workspace.
std::size_t first_sub_ray(const Simulation& s, std::size_t pulse);

/// Index of the first mirrored beam in the workspace that comes from this sub-ray or a later one.
std::size_t mirrored_beam(const SubRayWorkspace& memory, std::size_t sub_ray);

}  // namespace glidar
