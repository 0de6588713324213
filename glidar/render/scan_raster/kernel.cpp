// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for every instruction set, under the rules of rays/kernel.cpp.
#include <glidar/render/scan_raster/kernel.hpp>

#ifndef GLIDAR_KERNEL
#define GLIDAR_KERNEL baseline
#endif
#if defined(__AVX512F__)
#include <glidar/render/rays/simd_avx512.hpp>
#elif defined(__AVX2__)
#include <glidar/render/rays/simd_avx2.hpp>
#else
#include <glidar/render/rays/simd_portable.hpp>
#endif
#include <glidar/render/scan_raster/sector_traversal.hpp>

#define GLIDAR_NAME_OF(word) #word
#define GLIDAR_NAME(word) GLIDAR_NAME_OF(word)

namespace glidar::rays::GLIDAR_KERNEL {

extern const scan_raster::Kernel kScanKernel;
const scan_raster::Kernel kScanKernel = {GLIDAR_NAME(GLIDAR_KERNEL), draw_instance};

}  // namespace glidar::rays::GLIDAR_KERNEL
