// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/scan_raster/sector.hpp>

namespace glidar::scan_raster {

/// The inner loops, compiled for one instruction set as those of the ray caster.
struct Kernel {
  const char* name;  ///< as rays::Kernel::name
  /// Draws an instance into a sector's buffer.
  void (*draw)(const GridView& grid, const SectorView& sector, const Placement& placement,
               const SectorBuffer& buffer);
};

}  // namespace glidar::scan_raster
