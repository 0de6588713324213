// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/crease_normals.hpp>

#include <glidar/io/model/corner_angle.hpp>
#include <glidar/io/model/vertex_weld.hpp>
#include <glidar/math/portable.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kManyFaces = 512;  // the pairwise comparison is quadratic

struct Faces {
  std::vector<Eigen::Vector3f> normals;  ///< unit, zero for degenerate faces
  std::vector<float> angles;             ///< of corner 3 * face + k
};

Faces faces_of(const Mesh& mesh) {
  Faces faces;
  faces.normals.resize(mesh.triangles.size());
  faces.angles.resize(mesh.triangles.size() * 3);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const Eigen::Vector3f& a = mesh.positions_m[t[0]];
    // Products of lengths must not overflow or underflow.
    Eigen::Vector3f ab = mesh.positions_m[t[1]] - a;
    Eigen::Vector3f ac = mesh.positions_m[t[2]] - a;
    const float size = std::max(ab.lpNorm<Eigen::Infinity>(), ac.lpNorm<Eigen::Infinity>());
    if (size > 0.0F) {
      ab = (ab.cast<double>() / double{size}).cast<float>();
      ac = (ac.cast<double>() / double{size}).cast<float>();
    }
    const Eigen::Vector3f cross = ab.cross(ac);
    const float area = cross.norm();
    faces.normals[f] = area > 0.0F ? Eigen::Vector3f(cross / area) : Eigen::Vector3f::Zero();
    const float at_a = angle_between_rad(ab, ac);
    const float at_b = angle_between_rad(-ab, ac - ab);
    faces.angles[3 * f] = at_a;
    faces.angles[3 * f + 1] = at_b;
    faces.angles[3 * f + 2] = std::max(0.0F, std::numbers::pi_v<float> - at_a - at_b);
  }
  return faces;
}

/// Corners (3 * face + k) around each position, in the order of the faces.
struct Fans {
  std::vector<std::uint32_t> first;  ///< positions + 1 offsets
  std::vector<std::uint32_t> corners;
};

Fans fans_of(const Mesh& mesh, const std::vector<std::uint32_t>& position_of) {
  Fans fans;
  fans.first.assign(mesh.positions_m.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++fans.first[position_of[v] + 1];
  }
  for (std::size_t i = 1; i < fans.first.size(); ++i) fans.first[i] += fans.first[i - 1];
  fans.corners.resize(mesh.triangles.size() * 3);
  std::vector<std::uint32_t> next(fans.first.begin(), fans.first.end() - 1);
  std::uint32_t corner = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) fans.corners[next[position_of[v]]++] = corner++;
  }
  return fans;
}

Eigen::Vector3f unit_or_up(const Eigen::Vector3f& v) {
  const float length = v.norm();
  return length > 0.0F ? Eigen::Vector3f(v / length) : Eigen::Vector3f::UnitZ();
}

/// Assigns normals to corners and splits vertices that have several.
class Smoother {
 public:
  Smoother(Mesh& mesh, double crease_angle_rad)
      : mesh_(mesh),
        faces_(faces_of(mesh)),
        cos_crease_(static_cast<float>(portable_cos(crease_angle_rad))),
        cos_half_(static_cast<float>(portable_cos(0.5 * crease_angle_rad))),
        assigned_(mesh.positions_m.size(), false) {
    mesh.normals.assign(mesh.positions_m.size(), Eigen::Vector3f::UnitZ());
  }

  void smooth(std::span<const std::uint32_t> fan) {
    const Eigen::Vector3f mean = sum_of(fan);
    if (all_near(fan, mean)) {
      for (const std::uint32_t corner : fan) mesh_.normals[vertex(corner)] = mean;
      return;
    }
    made_.clear();
    for (const std::uint32_t corner : fan) give(corner, creased(corner, fan));
    for (const Made& made : made_) assigned_[made.from] = false;
  }

 private:
  struct Made {
    std::uint32_t from;  ///< vertex of the file
    std::uint32_t to;    ///< vertex with this normal
  };

  std::uint32_t& vertex(std::uint32_t corner) { return mesh_.triangles[corner / 3][corner % 3]; }

  Eigen::Vector3f sum_of(std::span<const std::uint32_t> fan) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const std::uint32_t c : fan) sum += faces_.angles[c] * faces_.normals[c / 3];
    return unit_or_up(sum);
  }

  /// All within half the crease angle of one direction: then no two differ by more than the crease
  /// angle.
  bool all_near(std::span<const std::uint32_t> fan, const Eigen::Vector3f& mean) const {
    return std::all_of(fan.begin(), fan.end(), [&](std::uint32_t c) {
      const Eigen::Vector3f& n = faces_.normals[c / 3];
      return n.isZero(0.0F) || n.dot(mean) >= cos_half_;
    });
  }

  Eigen::Vector3f creased(std::uint32_t corner, std::span<const std::uint32_t> fan) const {
    const Eigen::Vector3f& own = faces_.normals[corner / 3];
    if (own.isZero(0.0F)) return sum_of(fan);
    if (fan.size() > kManyFaces) return own;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const std::uint32_t c : fan) {
      const Eigen::Vector3f& n = faces_.normals[c / 3];
      if (c == corner || n.dot(own) >= cos_crease_) sum += faces_.angles[c] * n;
    }
    return sum.isZero(0.0F) ? own : unit_or_up(sum);
  }

  void give(std::uint32_t corner, const Eigen::Vector3f& normal) {
    const std::uint32_t from = vertex(corner);
    if (!assigned_[from]) {
      assigned_[from] = true;
      mesh_.normals[from] = normal;
      made_.push_back({from, from});
      return;
    }
    // Only the first of very many are searched for an equal one, because the search is quadratic.
    const auto searched =
        made_.begin() + static_cast<std::ptrdiff_t>(std::min(made_.size(), kManyFaces));
    const auto same = std::find_if(made_.begin(), searched, [&](const Made& made) {
      return made.from == from && mesh_.normals[made.to] == normal;
    });
    if (same != searched) {
      vertex(corner) = same->to;
      return;
    }
    vertex(corner) = copy_of(from, normal);
    made_.push_back({from, vertex(corner)});
  }

  std::uint32_t copy_of(std::uint32_t v, const Eigen::Vector3f& normal) {
    const auto again = [v](auto& values) {
      if (!values.empty())
        values.push_back(typename std::decay_t<decltype(values)>::value_type(values[v]));
    };
    const auto added = static_cast<std::uint32_t>(mesh_.positions_m.size());
    again(mesh_.positions_m);
    again(mesh_.uvs[0]);
    again(mesh_.uvs[1]);
    again(mesh_.tangents);
    again(mesh_.colours);
    mesh_.normals.push_back(normal);
    return added;
  }

  Mesh& mesh_;
  Faces faces_;
  float cos_crease_;
  float cos_half_;
  std::vector<bool> assigned_;
  std::vector<Made> made_;
};

}  // namespace

void make_normals(Mesh& mesh, double crease_angle_rad) {
  const std::vector<std::uint32_t> position_of = first_at_position(mesh.positions_m);
  const Fans fans = fans_of(mesh, position_of);
  Smoother smoother(mesh, crease_angle_rad);
  for (std::size_t p = 0; p + 1 < fans.first.size(); ++p) {
    const std::uint32_t begin = fans.first[p];
    const std::uint32_t end = fans.first[p + 1];
    if (end > begin) smoother.smooth({fans.corners.data() + begin, end - begin});
  }
}

}  // namespace glidar
