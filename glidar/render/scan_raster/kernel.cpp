// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for every instruction set, under the rules of rays/kernel.cpp.
#include <glidar/render/scan_raster/kernel.hpp>

#include <glidar/render/rays/kernel_simd.hpp>
#include <glidar/render/scan_raster/sector_traversal.hpp>

namespace glidar::rays::GLIDAR_KERNEL {

extern const scan_raster::Kernel kScanKernel;
const scan_raster::Kernel kScanKernel = {GLIDAR_KERNEL_NAME, draw_instance};

}  // namespace glidar::rays::GLIDAR_KERNEL
