// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/block_kernel.hpp>

namespace glidar {

/// The kernel with the instruction set of the ray caster's (rays::select_kernel()).
const BlockKernel& select_block_kernel();

}  // namespace glidar
