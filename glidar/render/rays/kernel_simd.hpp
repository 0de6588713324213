// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Vectors of the instruction set that a kernel.cpp is compiled for, in namespace
// glidar::rays::GLIDAR_KERNEL. Include it before the inner loops.
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

/// The kernel's name as a string.
#define GLIDAR_STRING_OF(word) #word
#define GLIDAR_STRING(word) GLIDAR_STRING_OF(word)
#define GLIDAR_KERNEL_NAME GLIDAR_STRING(GLIDAR_KERNEL)
