// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/stereo/kernel.hpp>

#include <glidar/stereo/cost_loops.hpp>
#include <glidar/stereo/path_loops.hpp>
#include <glidar/stereo/winner_loops.hpp>

#define GLIDAR_STEREO_STRING_OF(word) #word
#define GLIDAR_STEREO_STRING(word) GLIDAR_STEREO_STRING_OF(word)

namespace glidar::stereo::GLIDAR_KERNEL {

extern const Kernel kKernel;
const Kernel kKernel = {
    .name = GLIDAR_STEREO_STRING(GLIDAR_KERNEL),
    .census = census_row,
    .hamming = hamming_row,
    .add = add_row,
    .slide = slide_rows,
    .box = box_row,
    .sweep = sweep_row,
    .down = down_row,
    .win = win_row,
};

}  // namespace glidar::stereo::GLIDAR_KERNEL
