// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Parts of a model that are far from each other keep the precision of parts near zero.
#include <glidar/core/mesh.hpp>
#include <glidar/io/model/mesh_check.hpp>
#include <glidar/io/model/model.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "model_test_support.hpp"

namespace glidar {
namespace {

using testing::gltf;
using testing::load;
using testing::TestFolder;

/// What the nodes' mesh, (0,0,0) (1,0,0) (0,1,0), may be rounded by: vertices and transforms are
/// exact in double, so only the step of single precision near 1 counts.
constexpr double kTolerance_m = 1e-7;

struct Node {
  Eigen::Vector3d translation;
  double scale;
};

std::string nodes_of(const std::vector<Node>& nodes) {
  std::string text = R"([{"children":[)";
  for (std::size_t i = 0; i < nodes.size(); ++i) text += (i > 0 ? "," : "") + std::to_string(i + 1);
  text += "]}";
  for (const Node& node : nodes) {
    const auto number = [](double value) {
      std::ostringstream digits;
      digits.precision(17);
      digits << value;
      return digits.str();
    };
    const std::string s = number(node.scale);
    text += R"(,{"mesh":0,"translation":[)" + number(node.translation.x()) + "," +
            number(node.translation.y()) + "," + number(node.translation.z()) + R"(],"scale":[)" +
            s + "," + s + "," + s + "]}";
  }
  return text + "]";
}

double largest_error(const Mesh& mesh, const std::vector<Node>& nodes) {
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  double largest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d expected = nodes[i].translation + nodes[i].scale * corners[k];
      const Eigen::Vector3d found = vertex_m(mesh, mesh.triangles.at(i)[k]);
      largest = std::max(largest, (found - expected).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

const std::vector<Node>& far_nodes() {
  static const std::vector<Node> nodes = {{{100.1, -3.3, 7.7}, 0.7},
                                          {{-100.3, 50.9, 0.1}, 0.3},
                                          {{10000.7, -20.1, 0.3}, 0.9},
                                          {{-10000.9, 0.7, -80.3}, 0.1},
                                          {{0.1, 0.2, 0.3}, 0.7}};
  return nodes;
}

TEST(ModelOrigins, NodesFarFromEachOtherAreExactToAFractionOfAMicrometre) {
  const TestFolder temp;
  const Model model = load(temp.write("a.gltf", gltf(nodes_of(far_nodes()))));
  ASSERT_EQ(model.mesh.triangles.size(), far_nodes().size());
  EXPECT_GT(model.mesh.origins.size(), 1U);
  EXPECT_LT(largest_error(model.mesh, far_nodes()), kTolerance_m);
  EXPECT_NO_THROW(validate(model.mesh));
}

TEST(ModelOrigins, PartsBeyondSinglePrecisionAreOmitted) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.gltf", gltf(R"([{"children":[1,2]},{"mesh":0,"translation":[1,0,0]},)"
                                     R"({"translation":[3e38,0,0],"children":[3]},)"
                                     R"({"mesh":0,"translation":[3e38,0,0]}])")));
  ASSERT_EQ(model.mesh.triangles.size(), 1U);
  EXPECT_EQ(vertex_m(model.mesh, model.mesh.triangles[0][0]), Eigen::Vector3d(1, 0, 0));
  EXPECT_THAT(model.notes, ::testing::Contains(::testing::HasSubstr(
                               "1 triangles touch coordinates that are not finite: left out")));
  EXPECT_NO_THROW(validate(model.mesh));
}

TEST(ModelOrigins, PartsStayInTheOrderOfTheFile) {
  const TestFolder temp;
  const Model model = load(temp.write("a.gltf", gltf(nodes_of(far_nodes()))));
  ASSERT_EQ(model.parts.size(), far_nodes().size());
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    EXPECT_EQ(model.parts[i].first_triangle, i);
    EXPECT_EQ(model.parts[i].triangle_count, 1U);
  }
}

TEST(ModelOrigins, UnitUpAxisAndCentreApplyToEveryOrigin) {
  const TestFolder temp;
  const auto file = temp.write("a.gltf", gltf(nodes_of(far_nodes())));
  ModelOptions options = testing::without_cache();
  options.metres_per_unit = 0.5;
  options.up = Axis::y;
  const Mesh plain = load(file).mesh;
  const Mesh placed = load(file, options).mesh;
  options.centre = true;
  const Mesh centred = load(file, options).mesh;
  for (std::uint32_t v = 0; v < plain.positions_m.size(); ++v) {
    const Eigen::Vector3d p = vertex_m(plain, v);
    EXPECT_LT((vertex_m(placed, v) - 0.5 * Eigen::Vector3d(p.x(), -p.z(), p.y())).norm(), 1e-7);
    EXPECT_LT((vertex_m(centred, v) - (vertex_m(placed, v) - bounds(placed).center())).norm(),
              1e-9);
  }
  EXPECT_LT(bounds(centred).center().norm(), 1e-9);
}

TEST(ModelOrigins, PartsThatTouchShareTheirOrigin) {
  // triangles of a strip 200 m long that share corners from node to node: a gap would let beams
  // through
  std::vector<Node> strip;
  for (int i = 0; i < 8; ++i) strip.push_back({{100.1 + 25.0 * i, 0.0, 0.0}, 25.0});
  const TestFolder temp;
  const Model model = load(temp.write("a.gltf", gltf(nodes_of(strip))));
  std::set<std::tuple<double, double, double>> places;
  for (std::uint32_t v = 0; v < model.mesh.positions_m.size(); ++v) {
    const Eigen::Vector3d p = vertex_m(model.mesh, v);
    places.insert({p.x(), p.y(), p.z()});
  }
  EXPECT_EQ(places.size(), 9U + 8U);  // 9 along the strip, and a tip of each
  EXPECT_TRUE(model.mesh.origins.empty());
}

TEST(ModelOrigins, AreLimitedForManyParts) {
  std::vector<Node> many;
  for (int i = 0; i < 500; ++i) many.push_back({{13.1 * i, -7.3 * i, 0.1 * i}, 0.7});
  const TestFolder temp;
  const Model model = load(temp.write("a.gltf", gltf(nodes_of(many))));
  EXPECT_LE(cut_at_origins(model.mesh).size(), 65U);  // 64 and the common one
  EXPECT_GT(cut_at_origins(model.mesh).size(), 8U);
  EXPECT_LT(largest_error(model.mesh, many), 1e-5);  // single precision of the whole has 2.4e-4
}

TEST(ModelOrigins, OneOriginIsUsedWhenSinglePrecisionSuffices) {
  const TestFolder temp;
  EXPECT_TRUE(load(temp.write("a.gltf", gltf(nodes_of({{{2.1, 0, 0}, 0.7}, {{-2.3, 0, 0}, 0.3}}))))
                  .mesh.origins.empty());
  const std::vector<Node> exact = {{{1000.0, 0, 0}, 1.0}, {{-1000.0, 0, 0}, 0.5}};
  EXPECT_TRUE(load(temp.write("a.gltf", gltf(nodes_of(exact)))).mesh.origins.empty());
  EXPECT_TRUE(load(temp.write("a.obj",
                              "v 0 0 0\nv 1 0 0\nv 0 1 0\no b\nv 1e4 0.1 0\nv 1e4 1.1 0\n"
                              "v 1e4 0.1 1.7\nf 1 2 3\nf 4 5 6\n"))
                  .mesh.origins.empty());
}

TEST(ModelOrigins, MeshChecksAreSumsOverThePieces) {
  const TestFolder temp;
  const Mesh mesh = load(temp.write("a.gltf", gltf(nodes_of(far_nodes())))).mesh;
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.open_edges, 3 * far_nodes().size());
  double area_m2 = 0.0;
  for (const Node& node : far_nodes()) area_m2 += 0.5 * node.scale * node.scale;
  EXPECT_NEAR(check.area_m2, area_m2, 1e-6);
}

TEST(ModelOrigins, NodeTransformsAreReadInDouble) {
  // turned by a third of a half turn about z, far away: single precision of the rotation alone is
  // 1e-4 m off
  const std::string nodes =
      R"([{"children":[1],"rotation":[0,0,0.49999999999999994,0.8660254037844387]},)"
      R"({"mesh":0,"translation":[5000.123456,0,0]}])";
  const TestFolder temp;
  const Mesh mesh = load(temp.write("a.gltf", gltf(nodes))).mesh;
  const Eigen::Vector3d expected(5000.123456 * 0.5, 5000.123456 * 0.8660254037844387, 0.0);
  EXPECT_LT((vertex_m(mesh, mesh.triangles.at(0)[0]) - expected).norm(), kTolerance_m);
}

TEST(ModelOrigins, MatricesOfNodesAreReadInDouble) {
  const std::string nodes =
      R"([{"mesh":0,"matrix":[0,0.3,0,0, -0.3,0,0,0, 0,0,0.3,0, 4000.123456,1,2,1]}])";
  const TestFolder temp;
  const Mesh mesh = load(temp.write("a.gltf", gltf(nodes))).mesh;
  EXPECT_LT(
      (vertex_m(mesh, mesh.triangles.at(0)[1]) - Eigen::Vector3d(4000.123456, 1.3, 2.0)).norm(),
      kTolerance_m);
}

}  // namespace
}  // namespace glidar
