// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Compiles a loop kernel for several instruction sets; the best one is selected when the program
// starts. All of them round identically, because the project is built with -ffp-contract=off.
// Sanitizers and compilers other than GCC do not support the mechanism (ifunc).
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GLIDAR_SIMD __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define GLIDAR_SIMD
#endif
