// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/kernel.hpp>

#include <string_view>

namespace glidar::scan_raster {

/// The kernel with the instruction set of the ray caster's kernel of this name. Throws Error for an
/// unknown name.
const Kernel& find_kernel(std::string_view name);

}  // namespace glidar::scan_raster
