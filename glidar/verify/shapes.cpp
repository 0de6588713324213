// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/shapes.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace glidar {
namespace {

using Face = std::vector<std::uint32_t>;

/// The mesh of the faces, as triangle fans.
Shape make_shape(std::string name, const std::vector<Eigen::Vector3d>& vertices,
                 std::vector<Face> faces, bool solid) {
  Shape shape{.name = std::move(name), .mesh = {}, .faces = std::move(faces), .solid = solid};
  shape.mesh.name = shape.name;
  for (const Eigen::Vector3d& v : vertices) shape.mesh.positions_m.emplace_back(v.cast<float>());
  for (const Face& face : shape.faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      shape.mesh.triangles.push_back({face[0], face[i - 1], face[i]});
    }
  }
  return shape;
}

Shape make_box() {
  std::vector<Eigen::Vector3d> v;
  for (int i = 0; i < 8; ++i) {
    v.emplace_back((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.625 : -0.625,
                   (i & 4) != 0 ? 0.375 : -0.375);
  }
  return make_shape(
      "box", v,
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}, true);
}

Shape make_plane() {
  return make_shape(
      "tilted plane",
      {{-0.75, -0.625, 0.0}, {0.75, -0.625, 0.0}, {0.75, 0.625, 0.0}, {-0.75, 0.625, 0.0}},
      {{0, 1, 2, 3}}, false);
}

Shape make_tetrahedron() {
  return make_shape("tetrahedron",
                    {{-0.7, -0.5, -0.3}, {0.8, -0.4, -0.35}, {0.1, 0.9, -0.2}, {-0.05, 0.1, 0.95}},
                    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, true);
}

Shape make_cylinder() {
  constexpr std::uint32_t kFacets = 24;
  constexpr double kRadius = 0.6;
  constexpr double kHalfHeight = 0.75;
  std::vector<Eigen::Vector3d> v;
  std::vector<Face> faces;
  Face bottom;
  Face top;
  for (std::uint32_t i = 0; i < kFacets; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kFacets;
    v.emplace_back(kRadius * portable_cos(angle), kRadius * portable_sin(angle), -kHalfHeight);
    v.emplace_back(kRadius * portable_cos(angle), kRadius * portable_sin(angle), kHalfHeight);
    const std::uint32_t next = (i + 1) % kFacets;
    faces.push_back({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    top.push_back(2 * i + 1);
    bottom.push_back(2 * (kFacets - 1 - i));
  }
  faces.push_back(bottom);
  faces.push_back(top);
  return make_shape("cylinder facets", v, std::move(faces), true);
}

std::vector<Eigen::Vector3d> icosahedron_vertices() {
  const double g = std::numbers::phi;
  std::vector<Eigen::Vector3d> v = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Eigen::Vector3d& p : v) p.normalize();
  return v;
}

/// An icosahedron with each face divided into four.
Shape make_sphere() {
  constexpr std::array<std::array<std::uint32_t, 3>, 20> kFaces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  std::vector<Eigen::Vector3d> v = icosahedron_vertices();
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, fresh] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(v.size()));
    if (fresh) v.push_back((v[a] + v[b]).normalized());
    return entry->second;
  };
  std::vector<Face> faces;
  for (const auto& [a, b, c] : kFaces) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    faces.insert(faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return make_shape("sphere facets", v, std::move(faces), true);
}

HalfSpace through(const RealVector& normal, const RealVector& point) {
  const RealVector unit = normal.normalized();
  return {unit, unit.dot(point)};
}

/// The distance of the ray from the intersection line of two sides; `point` is on the first side
/// and `slack` inside the second.
Real distance_to_edge(const HalfSpace& on, const HalfSpace& other, Real slack,
                      const RealVector& direction) {
  const RealVector edge = on.normal.cross(other.normal);
  const Real sine = edge.norm();
  if (sine == 0.0L) return std::numeric_limits<Real>::infinity();  // parallel
  const RealVector away =
      on.normal.cross(edge / sine);  // in the first side, perpendicular to the edge
  const RealVector common = direction.cross(edge / sine);
  const Real length = common.norm();
  const Real along_side = slack / sine;
  return length == 0.0L ? std::abs(along_side) : std::abs(along_side * away.dot(common)) / length;
}

/// True if a ray that enters through side `entry` at `point` is not near an edge of that side.
bool clear_of_edges(const ClosedForm& form, std::size_t entry, const RealVector& point,
                    const RealVector& direction, Real tolerance) {
  const HalfSpace& on = form.sides[entry];
  const Real cosine = std::abs(on.normal.dot(direction));
  if (cosine < kGrazingCosine) return false;
  for (std::size_t i = 0; i < form.sides.size(); ++i) {
    if (i == entry) continue;
    const HalfSpace& other = form.sides[i];
    const Real slack = other.offset - other.normal.dot(point);
    // The distance to the edge is at least slack x cosine, which avoids most of the work.
    if (slack * cosine > tolerance) continue;
    if (distance_to_edge(on, other, slack, direction) < tolerance) return false;
  }
  return true;
}

/// The interval of a ray inside all half spaces, and the sides through which it enters and leaves.
struct Clip {
  Real enter = -std::numeric_limits<Real>::infinity();
  Real leave = std::numeric_limits<Real>::infinity();
  std::size_t entry = 0;
  std::size_t exit = 0;
  Real outside = -1.0L;  ///< distance of the whole ray outside a side parallel to it
};

Clip clip(const ClosedForm& form, const RealVector& origin, const RealVector& direction) {
  Clip c;
  for (std::size_t i = 0; i < form.sides.size(); ++i) {
    const Real slope = form.sides[i].normal.dot(direction);
    const Real inside = form.sides[i].offset - form.sides[i].normal.dot(origin);
    if (slope == 0.0L) {
      c.outside = std::max(c.outside, -inside);
      continue;
    }
    // Divisions take most of the time, and few sides need them: t = inside / slope.
    if (slope < 0.0L && inside < c.enter * slope) {
      c.enter = inside / slope;
      c.entry = i;
    } else if (slope > 0.0L && inside < c.leave * slope) {
      c.leave = inside / slope;
      c.exit = i;
    }
  }
  return c;
}

ExactHit intersect_solid(const ClosedForm& form, const RealVector& origin,
                         const RealVector& direction, Real tolerance) {
  const Clip c = clip(form, origin, direction);
  ExactHit result;
  const Real in = std::abs(form.sides[c.entry].normal.dot(direction));
  const Real out = std::abs(form.sides[c.exit].normal.dot(direction));
  // Between the two parameters the ray is outside (miss) or inside (hit) both sides by at most this
  // distance: for a miss, no point of the body is nearer to the ray.
  const Real margin = std::abs(c.leave - c.enter) * in * out / (in + out);
  result.hit = c.outside <= 0.0L && c.enter <= c.leave && c.enter > 0.0L;
  if (!result.hit) {
    const bool behind = c.leave < 0.0L;
    const bool apart = c.enter > c.leave && margin > tolerance;
    result.clear = c.outside > tolerance || behind || apart;
    return result;
  }
  result.range_m = c.enter;
  result.normal = form.sides[c.entry].normal;
  result.clear = margin > tolerance &&
                 clear_of_edges(form, c.entry, origin + c.enter * direction, direction, tolerance);
  return result;
}

ExactHit intersect_face(const ClosedForm& form, const RealVector& origin,
                        const RealVector& direction, Real tolerance) {
  const HalfSpace& face = form.sides[0];
  const Real slope = face.normal.dot(direction);
  ExactHit result;
  if (std::abs(slope) < kGrazingCosine) {
    result.clear = false;
    return result;
  }
  result.range_m = (face.offset - face.normal.dot(origin)) / slope;
  result.normal = slope < 0.0L ? face.normal : RealVector(-face.normal);
  result.hit = result.range_m > 0.0L;
  if (!result.hit) return result;
  const RealVector point = origin + result.range_m * direction;
  Real beyond = 0.0L;  // distance of the ray from the most distant edge that it misses
  for (std::size_t i = 1; i < form.sides.size(); ++i) {
    const Real slack = form.sides[i].offset - form.sides[i].normal.dot(point);
    if (slack >= 0.0L) continue;
    result.hit = false;
    beyond = std::max(beyond, distance_to_edge(face, form.sides[i], slack, direction));
  }
  result.clear =
      result.hit ? clear_of_edges(form, 0, point, direction, tolerance) : beyond > tolerance;
  return result;
}

}  // namespace

std::vector<Shape> make_shapes() {
  return {make_box(), make_plane(), make_tetrahedron(), make_cylinder(), make_sphere()};
}

void add_shape(Scene& scene, Mesh mesh, double scale, const Pose& world_from_object) {
  Instance instance;
  instance.name = mesh.name;
  instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  instance.scale = scale;
  instance.materials = {0};
  instance.world_from_object = world_from_object;
  scene.meshes.push_back(std::move(mesh));
  scene.sources.emplace_back();
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.instances.push_back(std::move(instance));
}

ExactPose relative_pose(const Pose& world_from_object, const Eigen::Vector3d& viewpoint) {
  return {.rotation = world_from_object.linear().cast<Real>(),
          .shift = world_from_object.translation().cast<Real>() - viewpoint.cast<Real>()};
}

RealVector exact_vertex(const Mesh& mesh, std::uint32_t vertex, double scale,
                        const ExactPose& pose) {
  const RealVector in_object = mesh.origin_m.cast<Real>() + mesh.positions_m[vertex].cast<Real>();
  return pose.rotation * (static_cast<Real>(scale) * in_object) + pose.shift;
}

ClosedForm make_closed_form(const Shape& shape, double scale, const Pose& world_from_object,
                            const Eigen::Vector3d& viewpoint) {
  return make_closed_form(shape, scale, relative_pose(world_from_object, viewpoint));
}

ClosedForm make_closed_form(const Shape& shape, double scale, const ExactPose& at) {
  const auto vertex = [&](std::uint32_t i) { return exact_vertex(shape.mesh, i, scale, at); };
  ClosedForm form{.sides = {}, .solid = shape.solid};
  for (const Face& face : shape.faces) {
    const RealVector a = vertex(face[0]);
    form.sides.push_back(through((vertex(face[1]) - a).cross(vertex(face[2]) - a), a));
  }
  if (shape.solid) return form;
  const Face& face = shape.faces.front();
  for (std::size_t i = 0; i < face.size(); ++i) {
    const RealVector a = vertex(face[i]);
    const RealVector along = vertex(face[(i + 1) % face.size()]) - a;
    form.sides.push_back(through(along.cross(form.sides.front().normal), a));
  }
  return form;
}

ExactHit intersect(const ClosedForm& form, const RealVector& origin, const RealVector& direction,
                   Real edge_tolerance_m) {
  return form.solid ? intersect_solid(form, origin, direction, edge_tolerance_m)
                    : intersect_face(form, origin, direction, edge_tolerance_m);
}

ExactHit intersect_from_inside(const ClosedForm& form, const RealVector& origin,
                               const RealVector& direction, Real edge_tolerance_m) {
  const Clip c = clip(form, origin, direction);
  ExactHit result;
  const HalfSpace& exit = form.sides[c.exit];
  const Real slope = exit.normal.dot(direction);
  result.hit = c.leave * slope > edge_tolerance_m;
  if (!result.hit) {
    // The ray starts on the side through which it leaves, and must clearly point away from it.
    result.clear = slope > kGrazingCosine;
    return result;
  }
  result.range_m = c.leave;
  result.normal = -exit.normal;
  result.clear =
      clear_of_edges(form, c.exit, origin + c.leave * direction, direction, edge_tolerance_m);
  return result;
}

}  // namespace glidar
