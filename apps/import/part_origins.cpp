// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/part_origins.hpp>

#include <import/mesh_part.hpp>

#include <glidar/math/single_precision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>

namespace glidar::import {
namespace {

/// Parts with a common origin.
struct Group {
  Eigen::AlignedBox3d box;
  double rounding = 0.0;   ///< largest, of a coordinate relative to the common origin
  bool is_coarse = false;  ///< it is rounded too much there
};

const SourceMesh& mesh_of(const SourceModel& source, const Placed& placed) {
  return source.meshes.at(placed.mesh);
}

/// Near the middle of coordinates that differ from it by up to `half`: of single precision, so that
/// subtracting it is exact for coordinates of single precision, unless that is far from the middle.
double origin_near(double middle, double half) {
  constexpr double kNear = 0.125;
  const double rounded = rounded_to_float(middle);
  if (std::abs(rounded - middle) <= kNear * half || half <= 0.0) {
    return half > 0.0 ? rounded : middle;
  }
  const double step = std::ldexp(1.0, std::ilogb(kNear * half));
  return std::round(middle / step) * step;
}

Eigen::Vector3d origin_for(const Eigen::AlignedBox3d& box) {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (box.isEmpty()) return origin;
  for (int axis = 0; axis < 3; ++axis) {
    // Middle and half width of finite floats cannot overflow in double.
    const double middle = 0.5 * (box.min()[axis] + box.max()[axis]);
    const double half = 0.5 * (box.max()[axis] - box.min()[axis]);
    if (std::abs(middle) >= 2.0 * half) origin[axis] = origin_near(middle, half);
  }
  return origin;
}

double rounding_of(const Eigen::Vector3d& relative) {
  return (relative.unaryExpr(&rounded_to_float) - relative).cwiseAbs().maxCoeff();
}

double size_of(const Eigen::AlignedBox3d& box) {
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

void set_coarse(std::vector<Group>& groups) {
  Eigen::AlignedBox3d whole;
  for (const Group& group : groups) {
    if (!group.box.isEmpty()) whole.extend(group.box);
  }
  const double any = std::min(kMaxRounding, kMaxShare * size_of(whole));
  for (Group& group : groups) {
    group.is_coarse = group.rounding > std::max(any, kMaxShare * size_of(group.box));
  }
}

/// The box of each part and its rounding.
std::vector<Group> measure(const SourceModel& source, const Eigen::Vector3d& common) {
  std::vector<Group> parts(source.placed.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for_used_vertices(mesh_of(source, source.placed[i]), source.placed[i],
                      [&](const Eigen::Vector3d& p) {
                        parts[i].box.extend(p);
                        parts[i].rounding = std::max(parts[i].rounding, rounding_of(p - common));
                      });
  }
  set_coarse(parts);
  return parts;
}

/// Sets of parts, by a representative (Tarjan's disjoint sets, with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(b)] = find(a); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Joins parts that would share a vertex if all had the common origin.
void join_neighbours(const SourceModel& source, const Eigen::Vector3d& common, DisjointSets& sets) {
  using Place = std::tuple<float, float, float, std::uint32_t>;
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < source.placed.size(); ++i) {
    for_used_vertices(mesh_of(source, source.placed[i]), source.placed[i],
                      [&](const Eigen::Vector3d& p) {
                        const Eigen::Vector3f v = (p - common).cast<float>();
                        places.emplace_back(v.x(), v.y(), v.z(), i);
                      });
  }
  std::sort(places.begin(), places.end());
  for (std::size_t k = 1; k < places.size(); ++k) {
    const auto& [x, y, z, part] = places[k];
    const auto& [before_x, before_y, before_z, before] = places[k - 1];
    if (x == before_x && y == before_y && z == before_z) sets.join(before, part);
  }
}

std::vector<Group> merged(const std::vector<Group>& parts,
                          const std::vector<std::uint32_t>& group_of) {
  std::vector<Group> groups(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Group& group = groups[group_of[i]];
    if (!parts[i].box.isEmpty()) group.box.extend(parts[i].box);
    group.rounding = std::max(group.rounding, parts[i].rounding);
    group.is_coarse = group.is_coarse || parts[i].is_coarse;
  }
  return groups;
}

using Cell = std::array<double, 3>;

Cell cell_of(const Group& group, double size) {
  const Eigen::Vector3d middle = group.box.center() / size;
  return {std::floor(middle.x()), std::floor(middle.y()), std::floor(middle.z())};
}

/// Merges groups by the cells of a grid, as fine as the number of origins allows.
void gather_in_cells(const std::vector<Group>& parts, std::vector<std::uint32_t>& group_of) {
  const std::vector<Group> groups = merged(parts, group_of);
  constexpr double kFinest = 2.0;  // half of it is rounded by at most 2^-25 = 3e-8
  std::map<Cell, std::uint32_t> cells;
  double size = kFinest;
  for (;; size *= 2.0) {
    cells.clear();
    for (std::uint32_t i = 0; i < groups.size(); ++i) {
      if (groups[i].is_coarse) cells.try_emplace(cell_of(groups[i], size), i);
    }
    if (cells.size() <= kMaxOrigins) break;
  }
  for (std::uint32_t& group : group_of) {
    if (groups[group].is_coarse) group = cells.at(cell_of(groups[group], size));
  }
}

/// Uses a separate origin if it is much closer than the common one.
Eigen::Vector3d origin_of_group(const Group& group, const Eigen::Vector3d& common) {
  if (!group.is_coarse) return common;
  constexpr double kNearer = 0.25;
  const double from_common = (group.box.min() - common)
                                 .cwiseAbs()
                                 .cwiseMax((group.box.max() - common).cwiseAbs())
                                 .maxCoeff();
  const double half = 0.5 * group.box.sizes().maxCoeff();
  if (half > kNearer * from_common) return common;
  Eigen::Vector3d origin;
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = origin_near(group.box.center()[axis], 0.5 * group.box.sizes()[axis]);
  }
  return origin;
}

}  // namespace

Eigen::AlignedBox3d box_of(const SourceModel& source) {
  Eigen::AlignedBox3d box;
  for (const Placed& placed : source.placed) {
    for_used_vertices(mesh_of(source, placed), placed,
                      [&](const Eigen::Vector3d& p) { box.extend(p); });
  }
  return box;
}

std::vector<Eigen::Vector3d> part_origins(const SourceModel& source,
                                          const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d common = origin_for(box);
  std::vector<Eigen::Vector3d> origins(source.placed.size(), common);
  const std::vector<Group> parts = measure(source, common);
  const bool is_rounded =
      std::any_of(parts.begin(), parts.end(), [](const Group& part) { return part.is_coarse; });
  if (parts.size() < 2 || !is_rounded) return origins;
  DisjointSets sets(parts.size());
  join_neighbours(source, common, sets);
  std::vector<std::uint32_t> group_of(parts.size());
  for (std::uint32_t i = 0; i < parts.size(); ++i) group_of[i] = sets.find(i);
  gather_in_cells(parts, group_of);
  const std::vector<Group> groups = merged(parts, group_of);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    origins[i] = origin_of_group(groups[group_of[i]], common);
  }
  return origins;
}

}  // namespace glidar::import
