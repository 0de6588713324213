// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

#include <cstdint>

namespace glidar {

/// A bit for every hit lane whose beam may pass beside its triangle or start behind it. A
/// rasterizer moves corners to a grid of 1/256 of a pixel (or coarser), so it may show a beam so
/// near a border the triangle on its other side.
std::uint32_t uncertain_lanes(const Resolver& resolver, const HitBlock& block,
                              const ExactHits& exact);

}  // namespace glidar
