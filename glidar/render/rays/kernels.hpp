// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/rays/kernel.hpp>

#include <string_view>
#include <vector>

namespace glidar::rays {

/// The kernels that this processor can run, the fastest last.
std::vector<const Kernel*> usable_kernels();

/// The fastest kernel that this processor can run, or the one named by the environment variable
/// GLIDAR_ISA. All give the same bits. Throws Error if the processor cannot run that one.
const Kernel& select_kernel();

/// The same for a name; empty: the fastest.
const Kernel& find_kernel(std::string_view name);

}  // namespace glidar::rays
