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

/// The order of triangles in a scene: by instance, then by their index in its mesh.
inline bool is_lower(const PrimitiveRef& a, const PrimitiveRef& b) {
  return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
}

/// False where a triangle lets a beam through: by its side when back faces are culled, or by a hole
/// of its alpha mask.
bool blocks_beam(const Resolver& resolver, const Beams& beams, std::size_t beam,
                 bool cull_back_faces, const PrimitiveRef& candidate);

}  // namespace glidar
