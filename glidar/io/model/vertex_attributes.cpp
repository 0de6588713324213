// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/vertex_attributes.hpp>

#include <glidar/math/portable.hpp>
#include <glidar/math/simd.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Hashes three words (multipliers of splitmix64, Steele et al. 2014).
std::uint64_t position_hash(const Eigen::Vector3f& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9E37'79B9'7F4A'7C15U;
    h ^= h >> 32U;
  }
  return h * 0xBF58'476D'1CE4'E5B9U;
}

template <class T>
bool same_bits(const std::vector<T>& values, std::size_t a, std::size_t b) {
  return values.empty() || std::memcmp(values[a].data(), values[b].data(), sizeof(T)) == 0;
}

bool same_vertex(const Mesh& m, std::size_t a, std::size_t b) {
  return same_bits(m.positions_m, a, b) && same_bits(m.normals, a, b) &&
         same_bits(m.uvs[0], a, b) && same_bits(m.uvs[1], a, b) && same_bits(m.tangents, a, b) &&
         same_bits(m.colours, a, b);
}

/// For every vertex the first one that is equal by `same`; equal ones must have the same position.
template <class Same>
std::vector<std::uint32_t> first_equal(const std::vector<Eigen::Vector3f>& positions, Same same) {
  const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
  std::vector<std::uint32_t> table(slots, kNoVertex);
  std::vector<std::uint32_t> first(positions.size());
  const int shift = 64 - std::countr_zero(slots);
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    std::size_t slot = shift < 64 ? position_hash(positions[v]) >> static_cast<unsigned>(shift) : 0;
    while (table[slot] != kNoVertex && !same(table[slot], v)) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kNoVertex) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  std::vector<T> result(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) result[i] = values[kept[i]];
  values = std::move(result);
}

}  // namespace

std::vector<std::uint32_t> first_at_position(const std::vector<Eigen::Vector3f>& positions) {
  return first_equal(positions,
                     [&](std::uint32_t a, std::uint32_t b) { return same_bits(positions, a, b); });
}

void keep_vertices(Mesh& mesh, const std::vector<std::uint32_t>& kept,
                   const std::vector<std::uint32_t>& renumbered) {
  keep(mesh.positions_m, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs[0], kept);
  keep(mesh.uvs[1], kept);
  keep(mesh.tangents, kept);
  keep(mesh.colours, kept);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = renumbered[corner];
  }
}

void weld_vertices(Mesh& mesh) {
  const std::vector<std::uint32_t> first =
      first_equal(mesh.positions_m,
                  [&mesh](std::uint32_t a, std::uint32_t b) { return same_vertex(mesh, a, b); });
  std::vector<bool> used(first.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) used[first[corner]] = true;
  }
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> renumbered(first.size(), 0);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (used[v]) {
      renumbered[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(v);
    }
    renumbered[v] = renumbered[first[v]];
  }
  if (kept.size() != first.size()) keep_vertices(mesh, kept, renumbered);
}

namespace {

constexpr std::size_t kManyFaces = 512;  // the pairwise comparison is quadratic

struct Faces {
  std::vector<Eigen::Vector3f> normals;  ///< unit, zero for degenerate faces
  std::vector<float> angles;             ///< of corner 3 * face + k
};

/// The first two angles of some triangles, as in angle_between_rad().
struct CornerAngles {
  static constexpr std::size_t kMost = 512;  ///< triangles
  std::array<double, 2 * kMost> sines;       ///< times any lengths
  std::array<double, 2 * kMost> cosines;
  std::array<float, 2 * kMost> rad;
};

GLIDAR_SIMD void compute(CornerAngles& angles, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double turns = atan2_turns(angles.sines[i], angles.cosines[i]);
    angles.rad[i] = static_cast<float>(2.0 * std::numbers::pi * turns);
  }
}

/// Returns the normal of a triangle, and stores what its first two angles follow from.
Eigen::Vector3f measure(const Mesh& mesh, const Triangle& t, std::size_t i, CornerAngles& angles) {
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
  const Eigen::Vector3f bc = ac - ab;
  const float area = cross.norm();
  angles.sines[2 * i] = area;
  angles.cosines[2 * i] = ab.dot(ac);
  angles.sines[2 * i + 1] = (-ab).cross(bc).norm();
  angles.cosines[2 * i + 1] = (-ab).dot(bc);
  return area > 0.0F ? Eigen::Vector3f(cross / area) : Eigen::Vector3f::Zero();
}

Faces faces_of(const Mesh& mesh) {
  Faces faces;
  const std::size_t count = mesh.triangles.size();
  faces.normals.resize(count);
  faces.angles.resize(count * 3);
  CornerAngles angles;
  for (std::size_t begin = 0; begin < count; begin += CornerAngles::kMost) {
    const std::size_t some = std::min(CornerAngles::kMost, count - begin);
    for (std::size_t i = 0; i < some; ++i) {
      faces.normals[begin + i] = measure(mesh, mesh.triangles[begin + i], i, angles);
    }
    compute(angles, 2 * some);
    for (std::size_t i = 0; i < some; ++i) {
      const float at_a = angles.rad[2 * i];
      const float at_b = angles.rad[2 * i + 1];
      float* const of_face = &faces.angles[3 * (begin + i)];
      of_face[0] = at_a;
      of_face[1] = at_b;
      of_face[2] = std::max(0.0F, std::numbers::pi_v<float> - at_a - at_b);
    }
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

void make_normals(Mesh& mesh, double crease_angle_rad, bool are_distinct) {
  std::vector<std::uint32_t> position_of(are_distinct ? mesh.positions_m.size() : 0);
  std::iota(position_of.begin(), position_of.end(), 0U);
  if (!are_distinct) position_of = first_at_position(mesh.positions_m);
  const Fans fans = fans_of(mesh, position_of);
  Smoother smoother(mesh, crease_angle_rad);
  for (std::size_t p = 0; p + 1 < fans.first.size(); ++p) {
    const std::uint32_t begin = fans.first[p];
    const std::uint32_t end = fans.first[p + 1];
    if (end > begin) smoother.smooth({fans.corners.data() + begin, end - begin});
  }
}

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct FaceTangent {
  Eigen::Vector3f along_u = Eigen::Vector3f::Zero();  ///< unit, zero without a uv area
  bool mirrored = false;
};

FaceTangent face_tangent(const Mesh& mesh, const Triangle& t, std::size_t uv_set) {
  const auto& uv = mesh.uvs[uv_set];
  const Eigen::Vector3d p1 = (mesh.positions_m[t[1]] - mesh.positions_m[t[0]]).cast<double>();
  const Eigen::Vector3d p2 = (mesh.positions_m[t[2]] - mesh.positions_m[t[0]]).cast<double>();
  const Eigen::Vector2d d1 = (uv[t[1]] - uv[t[0]]).cast<double>();
  const Eigen::Vector2d d2 = (uv[t[2]] - uv[t[0]]).cast<double>();
  const double area = d1.x() * d2.y() - d2.x() * d1.y();
  const Eigen::Vector3d u = (p1 * d2.y() - p2 * d1.y()) * (area < 0.0 ? -1.0 : 1.0);
  const double length = u.norm();
  FaceTangent result;
  result.mirrored = area < 0.0;
  if (area != 0.0 && length > 0.0 && std::isfinite(length)) {
    result.along_u = (u / length).cast<float>();
  }
  return result;
}

float corner_angle(const Mesh& mesh, const Triangle& t, std::size_t k) {
  const Eigen::Vector3f& at = mesh.positions_m[t[k]];
  return angle_between_rad(mesh.positions_m[t[(k + 1) % 3]] - at,
                           mesh.positions_m[t[(k + 2) % 3]] - at);
}

Eigen::Vector3f in_plane(const Eigen::Vector3f& v, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f flat = v - v.dot(normal) * normal;
  const float length = flat.norm();
  return length > 1e-6F ? Eigen::Vector3f(flat / length) : Eigen::Vector3f::Zero();
}

template <class T>
void repeat(std::vector<T>& values, std::uint32_t vertex) {
  if (!values.empty()) values.push_back(T(values[vertex]));
}

std::uint32_t repeat_vertex(Mesh& mesh, std::uint32_t vertex) {
  repeat(mesh.positions_m, vertex);
  repeat(mesh.normals, vertex);
  repeat(mesh.uvs[0], vertex);
  repeat(mesh.uvs[1], vertex);
  repeat(mesh.colours, vertex);
  return static_cast<std::uint32_t>(mesh.positions_m.size() - 1);
}

/// Vertices that unmirrored faces use.
std::vector<bool> used_plainly(const Mesh& mesh, const std::vector<FaceTangent>& faces) {
  std::vector<bool> plain(mesh.positions_m.size(), false);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].mirrored) continue;
    for (const std::uint32_t v : mesh.triangles[f]) plain[v] = true;
  }
  return plain;
}

/// Splits vertices that mirrored and unmirrored faces share.
/// Returns for every vertex whether its uvs are mirrored.
std::vector<bool> split_mirrored(Mesh& mesh, const std::vector<FaceTangent>& faces) {
  const std::vector<bool> plain = used_plainly(mesh, faces);
  std::vector<std::uint32_t> repeated(plain.size(), kNone);
  std::vector<bool> mirrored(plain.size(), false);
  const auto repeat_of = [&](std::uint32_t v) {
    if (plain[v] && repeated[v] == kNone) {
      repeated[v] = repeat_vertex(mesh, v);
      mirrored.push_back(true);
    }
    if (!plain[v]) mirrored[v] = true;
    return plain[v] ? repeated[v] : v;
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].mirrored) continue;
    for (std::uint32_t& v : mesh.triangles[f]) v = repeat_of(v);
  }
  return mirrored;
}

}  // namespace

void make_tangents(Mesh& mesh, std::size_t uv_set) {
  std::vector<FaceTangent> faces;
  faces.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) faces.push_back(face_tangent(mesh, t, uv_set));
  const std::vector<bool> mirrored = split_mirrored(mesh, faces);
  std::vector<Eigen::Vector3f> sums(mesh.positions_m.size(), Eigen::Vector3f::Zero());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      sums[t[k]] += corner_angle(mesh, t, k) * in_plane(faces[f].along_u, mesh.normals[t[k]]);
    }
  }
  mesh.tangents.resize(mesh.positions_m.size());
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Eigen::Vector3f flat = in_plane(sums[v], mesh.normals[v]);
    const Eigen::Vector3f u =
        flat.isZero(0.0F) ? Eigen::Vector3f(mesh.normals[v].unitOrthogonal()) : flat;
    mesh.tangents[v] = {u.x(), u.y(), u.z(), mirrored[v] ? -1.0F : 1.0F};
  }
}

}  // namespace glidar
