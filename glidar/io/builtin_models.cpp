// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/builtin_models.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/mesh_making.hpp>

#include <array>
#include <vector>

namespace glidar {
namespace {

Material neutral_grey() {
  Material material;
  material.name = "neutral grey";
  material.specular = Eigen::Vector3f::Constant(0.3F);
  material.shininess = 24.0F;
  return material;
}

/// Regolith: a warm grey that hardly shines.
Material rock() {
  Material material;
  material.name = "rock";
  material.diffuse = {0.50F, 0.46F, 0.41F};
  material.ambient = material.diffuse;
  material.specular = Eigen::Vector3f::Constant(0.03F);
  material.shininess = 6.0F;
  return material;
}

Mesh to_mesh(const PointMesh& points, const std::vector<Eigen::Vector3d>& normals) {
  Mesh mesh;
  mesh.triangles = points.triangles;
  for (const Eigen::Vector3d& p : points.points_m) mesh.positions_m.push_back(p.cast<float>());
  for (const Eigen::Vector3d& n : normals) mesh.normals.push_back(n.cast<float>());
  return mesh;
}

Mesh sphere() {
  const PointMesh ball = icosphere(4);
  return to_mesh(ball, ball.points_m);  // on the unit sphere a point is its own normal
}

Mesh asteroid() {
  const PointMesh body = make_asteroid();
  return to_mesh(body, smooth_normals(body));
}

/// Appends the square `centre` +- `u` +- `v` of a side of 2 m, front to u x v, with uvs.
void append_square(Mesh& mesh, const Eigen::Vector3f& centre, const Eigen::Vector3f& u,
                   const Eigen::Vector3f& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
  constexpr std::array<std::array<float, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (const auto& [s, t] : kCorners) {
    mesh.positions_m.emplace_back(centre + s * u + t * v);
    mesh.normals.emplace_back(u.cross(v));
    mesh.uvs[0].emplace_back((s + 1.0F) / 2.0F, (t + 1.0F) / 2.0F);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

Mesh plane() {
  Mesh mesh;
  append_square(mesh, Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY());
  return mesh;
}

Mesh box() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f out = Eigen::Vector3f::Unit(axis);
    const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3);
    const Eigen::Vector3f v = Eigen::Vector3f::Unit((axis + 2) % 3);
    append_square(mesh, out, u, v);
    append_square(mesh, -out, v, u);
  }
  return mesh;
}

/// `count` directions evenly around the circle, from +x towards +y; count = 4 * 2^n. Halving
/// arcs needs only square roots: sines and cosines differ between maths libraries.
std::vector<Eigen::Vector2d> circle(std::size_t count) {
  std::vector<Eigen::Vector2d> points = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (points.size() < count) {
    std::vector<Eigen::Vector2d> finer;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d sum = points[i] + points[(i + 1) % points.size()];
      finer.push_back(points[i]);
      finer.emplace_back(sum / std::sqrt(sum.x() * sum.x() + sum.y() * sum.y()));
    }
    points = std::move(finer);
  }
  return points;
}

Mesh torus() {
  constexpr double kRing_m = 1.0;
  constexpr double kTube_m = 0.4;
  constexpr std::uint32_t kAround = 128;
  constexpr std::uint32_t kAcross = 64;
  PointMesh points;
  std::vector<Eigen::Vector3d> normals;
  const std::vector<Eigen::Vector2d> tube = circle(kAcross);
  for (const Eigen::Vector2d& ring : circle(kAround)) {
    for (const Eigen::Vector2d& t : tube) {
      const double radius = kRing_m + kTube_m * t.x();
      points.points_m.emplace_back(radius * ring.x(), radius * ring.y(), kTube_m * t.y());
      normals.emplace_back(t.x() * ring.x(), t.x() * ring.y(), t.y());
    }
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const std::uint32_t here = i * kAcross;
      const std::uint32_t next = (i + 1) % kAround * kAcross;
      const std::uint32_t up = (j + 1) % kAcross;
      points.triangles.push_back({here + j, next + j, next + up});
      points.triangles.push_back({here + j, next + up, here + up});
    }
  }
  return to_mesh(points, normals);
}

struct Builtin {
  Mesh (*make)();
  Material (*material)();
};
// In the order of builtin_model_names().
constexpr std::array<Builtin, 5> kBuiltins = {{{asteroid, rock},
                                               {sphere, neutral_grey},
                                               {box, neutral_grey},
                                               {torus, neutral_grey},
                                               {plane, neutral_grey}}};

}  // namespace

std::span<const std::string> builtin_model_names() {
  static const std::array<std::string, kBuiltins.size()> kNames = {"asteroid", "sphere", "box",
                                                                   "torus", "plane"};
  return kNames;
}

Model make_builtin_model(std::string_view name) {
  const std::span<const std::string> names = builtin_model_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != name) continue;
    Model model;
    model.source = "builtin:" + names[i];
    model.format = "built-in";
    model.mesh = kBuiltins[i].make();
    model.mesh.name = names[i];
    model.materials = {kBuiltins[i].material()};
    model.parts = {{.name = names[i],
                    .first_triangle = 0,
                    .triangle_count = static_cast<std::uint32_t>(model.mesh.triangles.size())}};
    return model;
  }
  std::string allowed;
  for (const std::string& known : names) allowed += (allowed.empty() ? "" : ", ") + known;
  const std::string nearest = nearest_word(name, names);
  throw Error({.where = "builtin:" + std::string(name),
               .found = "no built-in model of this name",
               .allowed = allowed,
               .remedy = nearest.empty() ? "" : "did you mean 'builtin:" + nearest + "'?"});
}

}  // namespace glidar
