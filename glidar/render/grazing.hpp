// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

namespace glidar {

/// Replaces the distances of a block's hits by those of the hit rule where the plane is not
/// accurate enough: at grazing incidence, and close to the beam's start. The rule's distance is
/// always between those of the triangle's corners. A triangle without area, which a beam hits only
/// by rounding, gets a plane that faces the beam.
void intersect_grazing(const Resolver& resolver, const HitBlock& block, ExactHits& exact);

}  // namespace glidar
