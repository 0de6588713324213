// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

#include <cstddef>
#include <cstdint>
#include <tuple>

namespace glidar {

/// A triangle of an instance; instance kInvalidId: none.
struct PrimitiveRef {
  std::uint32_t instance = kInvalidId;
  std::uint32_t primitive = kInvalidId;

  bool operator==(const PrimitiveRef&) const = default;
};

/// Lower instances come first, then lower triangles.
inline bool is_lower(const PrimitiveRef& a, const PrimitiveRef& b) {
  return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
}

/// False where a triangle lets a beam pass: it is a culled back face, or its alpha mask is
/// transparent there.
bool blocks_beam(const Resolver& resolver, const Beams& beams, std::size_t beam,
                 bool cull_back_faces, const PrimitiveRef& candidate);

}  // namespace glidar
