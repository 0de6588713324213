// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

#include <cstdint>

namespace glidar {

/// A bit for every hit lane whose beam may miss its triangle or start behind it. Rasterizers snap
/// vertices to a grid of 1/256 of a pixel (or coarser), so a pixel near an edge may show the
/// neighbouring triangle.
std::uint32_t uncertain_lanes(const Resolver& resolver, const HitBlock& block, ExactHits& exact);

/// Whether the hit rule accepts every hit of a block, for assertions: single precision may accept
/// no other.
bool are_hits_of_rule(const Resolver& resolver, const HitBlock& block, const ExactHits& exact);

}  // namespace glidar
