// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

namespace glidar {

/// Sets the distances of a block's hits to those of the hit rule where the plane does not do: where
/// it is met almost edge-on, or right before the beam's start, rounding decides where it is met.
/// The rule's distance is always between those of the triangle's corners. A triangle without area,
/// which a beam meets where rounding gives it some, gets a plane across the beam.
void intersect_grazing(const Resolver& resolver, const HitBlock& block, ExactHits& exact);

}  // namespace glidar
