// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar::gpu {

/// Throws Error unless the device of the current context can cast: it has compute shaders and
/// memory that the processor reads, and its 64-bit arithmetic gives the bits of the processor.
void check_device();

}  // namespace glidar::gpu
