// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/hits.hpp>
#include <glidar/core/scene.hpp>

#include <cstdint>
#include <span>

namespace glidar {

/// True if a material of an instance reflects beams. Instances as in CastRequest::instance_enabled.
bool has_mirrors(const Scene& scene, std::span<const std::uint8_t> instance_enabled = {});

/// The material of the surface that a beam hit.
const Material& material_hit(const Scene& scene, const Hits& hits, std::size_t beam);

/// Appends to `beams` the reflection of a beam at the surface that it hit: direction d - 2 (d . n)
/// n with the shading normal n (law of reflection). It starts just before the surface, so that it
/// does not hit the same surface again.
void add_reflected_beam(const Beams& from, const Hits& hits, std::size_t ray, Beams& beams);

}  // namespace glidar
