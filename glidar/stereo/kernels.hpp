// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/instruction_set.hpp>
#include <glidar/stereo/kernel.hpp>

namespace glidar::stereo {

/// The inner loops for an instruction set, which the processor must have.
const Kernel& kernel_for(InstructionSet set);

}  // namespace glidar::stereo
