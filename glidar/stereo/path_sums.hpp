// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/function_ref.hpp>
#include <glidar/core/progress_counter.hpp>
#include <glidar/stereo/cost_volume.hpp>
#include <glidar/stereo/kernel.hpp>
#include <glidar/stereo/stereo_match.hpp>

#include <cstddef>
#include <cstdint>

namespace glidar::stereo {

/// Receives a row whose sums over all paths are complete. Calls of one worker, a number below that
/// of threads, never overlap.
using RowSumsFunction =
    FunctionRef<void(std::size_t worker, std::size_t y, const std::int16_t* sums)>;

/// Rows that count as finished in the progress of sum_paths().
std::size_t progress_rows(const CostVolume& volume);

/// Computes the costs of all pixels and their sums over all paths: first the costs, the paths along
/// rows and those from the row above, then the paths from the row below. With `keeps_sums`, the
/// sums are in the volume afterwards.
void sum_paths(const CostSource& source, const StereoRun& run, CostVolume& volume,
               RowSumsFunction on_row, ProgressCounter& progress);

}  // namespace glidar::stereo
