// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_models.hpp>

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

namespace glidar {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<const char*, 4> kClosed = {"asteroid", "sphere", "box", "torus"};

/// Made once: an unoptimised build takes seconds for the asteroid.
const Mesh& mesh_of(const std::string& name) {
  static std::map<std::string, Mesh> meshes;
  if (!meshes.contains(name)) meshes[name] = make_builtin_model(name).mesh;
  return meshes.at(name);
}

using Point = std::tuple<float, float, float>;

Point key(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

Eigen::Vector3d corner(const Mesh& mesh, const Triangle& triangle, std::size_t i) {
  return mesh.positions_m[triangle[i]].cast<double>();
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    sum += corner(mesh, t, 0).dot(corner(mesh, t, 1).cross(corner(mesh, t, 2))) / 6.0;
  }
  return sum;
}

// FNV-1a, 64 bit.
template <class T>
void hash_into(std::uint64_t& hash, const std::vector<T>& values) {
  std::vector<unsigned char> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3U;
}

std::uint64_t hash(const Mesh& mesh) {
  std::uint64_t value = 0xcbf29ce484222325U;
  hash_into(value, mesh.positions_m);
  hash_into(value, mesh.normals);
  hash_into(value, mesh.uvs[0]);
  hash_into(value, mesh.triangles);
  return value;
}

TEST(BuiltinModels, EveryEdgeHasTwoTrianglesWithOppositeDirections) {
  for (const char* name : kClosed) {
    const Mesh& mesh = mesh_of(name);
    std::map<std::pair<Point, Point>, int> edges;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        ++edges[{key(mesh.positions_m[t[i]]), key(mesh.positions_m[t[(i + 1) % 3]])}];
      }
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << name;
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << name;
    }
  }
}

TEST(BuiltinModels, SmoothMeshesShareEveryVertex) {
  for (const char* name : {"asteroid", "sphere", "torus"}) {
    const Mesh& mesh = mesh_of(name);
    std::set<Point> points;
    for (const Eigen::Vector3f& p : mesh.positions_m) points.insert(key(p));
    EXPECT_EQ(points.size(), mesh.positions_m.size()) << name;
  }
}

TEST(BuiltinModels, HaveTheDocumentedNumberOfTriangles) {
  const std::map<std::string, std::size_t> counts = {
      {"asteroid", 81920}, {"sphere", 5120}, {"box", 12}, {"torus", 16384}, {"plane", 2}};
  for (const std::string& name : builtin_model_names()) {
    const Model model = make_builtin_model(name);
    EXPECT_EQ(model.mesh.triangles.size(), counts.at(name)) << name;
    ASSERT_EQ(model.parts.size(), 1U);
    EXPECT_EQ(model.parts[0].triangle_count, counts.at(name)) << name;
    EXPECT_EQ(model.source, "builtin:" + name);
    EXPECT_EQ(model.materials.size(), 1U);
    EXPECT_NO_THROW(validate(model.mesh)) << name;
  }
}

TEST(BuiltinModels, NormalsAreUnitAndOnTheFrontOfEveryTriangle) {
  for (const std::string& name : builtin_model_names()) {
    const Mesh& mesh = mesh_of(name);
    ASSERT_EQ(mesh.normals.size(), mesh.positions_m.size());
    for (const Eigen::Vector3f& n : mesh.normals) ASSERT_NEAR(n.norm(), 1.0F, 2e-7F) << name;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3d a = corner(mesh, t, 0);
      const Eigen::Vector3d front = (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a);
      ASSERT_GT(front.norm(), 0.0) << name;
      for (const std::uint32_t v : t) {
        ASSERT_GT(front.dot(mesh.normals[v].cast<double>()), 0.0) << name;
      }
    }
  }
}

// The corners lie on the unit sphere, so the volume is below the ball's. No edge is longer than e,
// so no plane of a triangle is nearer to the centre than sqrt(1 - e^2 / 3), and the ball of that
// radius is within.
TEST(BuiltinModels, SphereHasTheVolumeOfItsPolyhedron) {
  const Mesh& mesh = mesh_of("sphere");
  double longest = 0.0;
  for (const Triangle& t : mesh.triangles) {
    longest = std::max(longest, (corner(mesh, t, 0) - corner(mesh, t, 1)).norm());
  }
  for (const Eigen::Vector3f& p : mesh.positions_m) ASSERT_NEAR(p.norm(), 1.0F, 2e-7F);
  EXPECT_LT(longest, 0.09);
  const double ball = 4.0 / 3.0 * kPi;
  EXPECT_LT(volume(mesh), ball);
  EXPECT_GT(volume(mesh), ball * std::pow(1.0 - longest * longest / 3.0, 1.5));
}

TEST(BuiltinModels, BoxHasExactCornersAndVolumeEight) {
  const Mesh& mesh = mesh_of("box");
  EXPECT_EQ(volume(mesh), 8.0);
  EXPECT_EQ(mesh.positions_m.size(), 24U);
  for (const Eigen::Vector3f& p : mesh.positions_m) {
    EXPECT_EQ(p.cwiseAbs(), Eigen::Vector3f::Ones());
  }
}

// Each of the n slices is a polygon of area A = m/2 r^2 sin(2 pi/m) swept straight between two
// planes 2 pi/n apart: volume n sin(2 pi/n) R A. Rounding to float moves each point by at most
// 6e-8 of its size.
TEST(BuiltinModels, TorusHasTheVolumeOfItsPolyhedron) {
  constexpr double kAround = 128.0;
  constexpr double kAcross = 64.0;
  const double polygon = kAcross / 2.0 * 0.4 * 0.4 * std::sin(2.0 * kPi / kAcross);
  const double exact = kAround * std::sin(2.0 * kPi / kAround) * polygon;
  EXPECT_NEAR(volume(mesh_of("torus")), exact, 1e-6);
}

TEST(BuiltinModels, PlaneIsASquareFacingUpWithUvs) {
  const Mesh& mesh = mesh_of("plane");
  ASSERT_EQ(mesh.uvs[0].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(mesh.normals[i], Eigen::Vector3f::UnitZ());
    EXPECT_EQ(mesh.positions_m[i].head<2>(), 2.0F * mesh.uvs[0][i] - Eigen::Vector2f::Ones());
    EXPECT_EQ(mesh.positions_m[i].z(), 0.0F);
  }
}

TEST(BuiltinModels, AsteroidIsAnElongatedRockAroundItsCentreOfVolume) {
  const Mesh& mesh = mesh_of("asteroid");
  const Eigen::Vector3d sides = bounds(mesh).sizes();
  EXPECT_NEAR(sides.x(), 2.0, 1e-6);
  EXPECT_LT(sides.y(), 0.85 * sides.x());
  EXPECT_LT(sides.z(), 0.85 * sides.x());
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = corner(mesh, t, 0);
    const Eigen::Vector3d b = corner(mesh, t, 1);
    const Eigen::Vector3d c = corner(mesh, t, 2);
    moment += a.dot(b.cross(c)) / 6.0 * (a + b + c) / 4.0;
  }
  EXPECT_LT((moment / volume(mesh)).norm(), 1e-6);
}

// Golden values: models are the same bytes with every compiler, build type and machine.
TEST(BuiltinModels, HaveTheSameBytesOnEveryMachine) {
  const std::map<std::string, std::uint64_t> golden = {{"asteroid", 0x345d0cbe2f2885c8U},
                                                       {"sphere", 0x9ac788fb862b5171U},
                                                       {"box", 0xb639d035e8732525U},
                                                       {"torus", 0xb0c44da2db3b196dU},
                                                       {"plane", 0xf22c6318a6264fc7U}};
  for (const std::string& name : builtin_model_names()) {
    EXPECT_EQ(hash(mesh_of(name)), golden.at(name)) << name;
  }
}

TEST(BuiltinModels, HaveTheSizesAfterTheirNames) {
  const auto sizes = [](const std::string& name) -> Eigen::Vector3d {
    return bounds(make_builtin_model(name).mesh).sizes();
  };
  EXPECT_EQ(sizes("box:size=2.5,1,0.25"), Eigen::Vector3d(2.5, 1.0, 0.25));
  EXPECT_EQ(sizes("box:size=3"), Eigen::Vector3d(3.0, 3.0, 3.0));
  EXPECT_EQ(sizes("plane:size=4,0.5"), Eigen::Vector3d(4.0, 0.5, 0.0));
  EXPECT_LT((sizes("torus:radius=3:tube_radius=0.5") - Eigen::Vector3d(7.0, 7.0, 1.0)).norm(),
            1e-6);
  const Model ball = make_builtin_model("sphere:radius=0.125");
  EXPECT_EQ(ball.source, "builtin:sphere:radius=0.125");
  EXPECT_EQ(ball.mesh.name, "sphere");
  for (std::size_t v = 0; v < ball.mesh.positions_m.size(); ++v) {
    EXPECT_NEAR(ball.mesh.positions_m[v].norm(), 0.125F, 1e-7F);
    EXPECT_NEAR(ball.mesh.normals[v].norm(), 1.0F, 1e-6F);
  }
}

TEST(BuiltinModels, DefaultSizesGiveTheSameBytes) {
  EXPECT_EQ(hash(make_builtin_model("box:size=2").mesh), hash(mesh_of("box")));
  EXPECT_EQ(hash(make_builtin_model("sphere:radius=1").mesh), hash(mesh_of("sphere")));
  EXPECT_EQ(hash(make_builtin_model("torus:radius=1:tube_radius=0.4").mesh),
            hash(mesh_of("torus")));
}

TEST(BuiltinModels, WrongSizesAreErrors) {
  const std::map<std::string, std::string> errors = {
      {"box:sise=2",
       "builtin:box:sise=2: 'sise' is not a size of this model; allowed: size; did you "
       "mean 'size'?"},
      {"asteroid:size=2",
       "builtin:asteroid:size=2: 'size' is not a size of this model; allowed: no "
       "sizes; 'scale' applies to any model"},
      {"box:size=1,2", "builtin:box:size=1,2: 2 numbers; allowed: one number, or 3"},
      {"box:size=1,0,1",
       "builtin:box:size=1,0,1: a size of '0'; allowed: metres above 0, up to "
       "1e15"},
      {"sphere:radius=nan",
       "builtin:sphere:radius=nan: a size of 'nan'; allowed: metres above 0, "
       "up to 1e15"},
      {"box:size=1:size=2",
       "builtin:box:size=1:size=2: 'size' is given twice; allowed: each size once"},
      {"sphere:radius",
       "builtin:sphere:radius: 'radius' without a number; allowed: "
       "radius=NUMBER, in metres"},
      {"torus:tube_radius=1",
       "builtin:torus:tube_radius=1: a tube of radius 1; allowed: a "
       "tube_radius below the radius, 1"}};
  for (const auto& error : errors) {
    EXPECT_EQ(error_text([&] { make_builtin_model(error.first); }), error.second);
  }
}

TEST(BuiltinModels, AnUnknownNameIsReportedWithTheNearestOne) {
  EXPECT_EQ(error_text([&] { make_builtin_model("astroid"); }),
            "builtin:astroid: no built-in model of this name; allowed: asteroid, sphere, box, "
            "torus, plane; did you mean 'builtin:asteroid'?");
  EXPECT_THROW(make_builtin_model(""), Error);
}

}  // namespace
}  // namespace glidar
