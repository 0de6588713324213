// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Included first by every source on 64-bit ARM. Where the macro is defined, Eigen multiplies and adds in one rounding,
// whatever -ffp-contract says, and results differ from those of other processors in their last bits. The compiler's
// header defines the macro again, so it comes before.
#include <arm_neon.h>
#undef __ARM_FEATURE_FMA
