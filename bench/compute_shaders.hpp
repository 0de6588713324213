// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace glidar::bench {

/// Beams of a tile, along each side. A group of threads casts one tile.
inline constexpr unsigned kTileSide = 8;

/// Size of a beam's stack of nodes and leaves; a beam that needs more is re-tested. Even.
inline constexpr unsigned kDeviceStack = 16;

/// Maximum number of triangles of a leaf: neighbouring threads are mostly at different ones.
inline constexpr unsigned kDeviceLeaf = 2;

/// A leaf in a child's index: bit 31, then the number of triangles less one in 6 bits, then the
/// first triangle.
inline constexpr unsigned kLeafCountShift = 25;

/// Special ids: the beam hits nothing; the host must re-test it.
inline constexpr unsigned kMissed = 0xffffffffU;
inline constexpr unsigned kUndecided = 0xfffffffeU;

/// The compute shader that casts tiles of beams, view by view.
std::string caster_shader();

/// The compute shader that repeats Resolver's arithmetic for given numbers.
std::string arithmetic_shader();

}  // namespace glidar::bench
