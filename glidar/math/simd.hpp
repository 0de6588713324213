// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Marks a loop kernel to be compiled for several instruction sets, the best one being chosen when
// the program starts. All of them round alike, since the project is built with -ffp-contract=off.
// Sanitizers do not go with the mechanism (ifunc), nor do compilers other than GCC.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GLIDAR_SIMD __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define GLIDAR_SIMD
#endif
