// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/mesh.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Which triangles of a mesh meet at its vertices. Vertices at one position count as one, so that a
/// mesh whose faces share no vertices hangs together too.
class Neighbours {
 public:
  explicit Neighbours(const Mesh& mesh);

  /// The number of a vertex's position; equal numbers, same position.
  [[nodiscard]] std::uint32_t place(std::uint32_t vertex) const { return place_[vertex]; }

  /// The triangles around a vertex, each once per corner that it has there.
  [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    const std::uint32_t place = place_[vertex];
    return {triangles_.data() + first_[place], first_[place + 1] - first_[place]};
  }

 private:
  std::vector<std::uint32_t> place_;      ///< per vertex, number of its position
  std::vector<std::uint32_t> first_;      ///< per place and one more, into triangles_
  std::vector<std::uint32_t> triangles_;  ///< three times as many as the mesh has
};

}  // namespace glidar
