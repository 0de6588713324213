// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>

#include <string>
#include <vector>

namespace glidar {

/// What a kind of surface sends back, and where its numbers come from.
struct SurfacePreset {
  std::string name;
  std::string about;
  LookupTable spectrum;   ///< (wavelength in m, reflectance)
  Brdf backscatter = {};  ///< Lambert by default
  std::string source;
  bool verified = true;
};

/// Keys of one entry of materials/surfaces.yaml.
void describe(SurfacePreset& surface, FieldVisitor& visitor);

/// The surfaces that come with GLIDAR, in the order of the file: materials/surfaces.yaml of the
/// source, in share/glidar where it is installed, or in the folder that GLIDAR_MATERIALS names.
std::vector<SurfacePreset> load_surfaces();

/// The surface of this name. Throws Error with the nearest name; `where` is what asks for it.
SurfacePreset find_surface(const std::string& name, const std::string& where);

/// Gives the material the surface's spectrum and backscatter.
void apply_surface(const SurfacePreset& surface, Material& material);

}  // namespace glidar
