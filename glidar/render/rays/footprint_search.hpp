// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>
#include <glidar/render/rays/beam_search.hpp>

#include <cstdint>
#include <span>

namespace glidar::rays {

/// How the hits of a footprint were found.
enum class FootprintWay : std::uint8_t {
  nothing,       ///< all sub-rays certainly miss
  one_triangle,  ///< all certainly hit it first
  candidates,    ///< every sub-ray was tested with a few triangles
  single,        ///< every sub-ray was traced
};

/// Finds the first hits of the sub-rays of footprints: beams that run
/// close together (CastRequest::footprints). A footprint is searched at once, as a cone: mostly,
/// all of its sub-rays certainly miss everything or first hit the same triangle. The hits are those
/// of BeamSearch.
class FootprintSearch {
 public:
  /// That of the sub-rays alone, which must outlive this one.
  explicit FootprintSearch(const BeamSearch& beams) : beams_(beams) {}

  /// True if the cast describes footprints, in scenes where a cone can be certain.
  [[nodiscard]] bool is_useful() const;

  /// Sets instance and primitive of all sub-rays of these footprints. Fastest for multiples of
  /// kLanes footprints. `ways`, if not empty, has one entry per footprint.
  void find(BeamRange footprints, Hits& hits, std::span<FootprintWay> ways = {}) const;

 private:
  const BeamSearch& beams_;
};

}  // namespace glidar::rays
