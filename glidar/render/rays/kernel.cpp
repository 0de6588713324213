// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Compiled once for every instruction set (glidar/CMakeLists.txt). It must not use functions that
// other files could share, such as those of the standard library: the linker keeps one instance of
// them, for an arbitrary instruction set.
#include <glidar/render/rays/kernel.hpp>

// The vectors come before the inner loops.
#include <glidar/render/rays/kernel_simd.hpp>

#include <glidar/render/rays/cone_trace.hpp>

namespace glidar::rays::GLIDAR_KERNEL {

extern const Kernel kKernel;
const Kernel kKernel = {GLIDAR_KERNEL_NAME, start,        test_leaf,   trace,
                        trace_single,       visit_leaves, trace_cones, visit_cone_leaves};

}  // namespace glidar::rays::GLIDAR_KERNEL
