// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for every instruction set (glidar/CMakeLists.txt). It must not use functions that
// other files could share, such as those of the standard library: the linker keeps one instance of
// them, for an arbitrary instruction set.
#include <glidar/render/rays/kernel.hpp>

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
#include <glidar/render/rays/tree_traversal.hpp>

#define GLIDAR_NAME_OF(word) #word
#define GLIDAR_NAME(word) GLIDAR_NAME_OF(word)

namespace glidar::rays::GLIDAR_KERNEL {

extern const Kernel kKernel;
const Kernel kKernel = {
    GLIDAR_NAME(GLIDAR_KERNEL), start, test_leaf, trace, trace_single, visit_leaves};

}  // namespace glidar::rays::GLIDAR_KERNEL
