// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model_report.hpp>

#include <glidar/io/model/builtin_models.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::HasSubstr;

TEST(ModelReport, ABoxHasItsSizes) {
  const ModelReport report = inspect(make_builtin_model("box"));
  EXPECT_EQ(report.triangles, 12U);
  EXPECT_EQ(report.size_m, Eigen::Vector3d(2.0, 2.0, 2.0));
  EXPECT_DOUBLE_EQ(report.check.area_m2, 24.0);
  EXPECT_DOUBLE_EQ(report.check.signed_volume_m3, 8.0);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.winding, Winding::outward);
  EXPECT_EQ(report.check.degenerate_triangles, 0U);
  EXPECT_EQ(report.check.duplicate_triangles, 0U);
}

TEST(ModelReport, VolumeIsPreciseFarFromZero) {
  Model model = make_builtin_model("box");
  model.mesh.origin_m = {1e9, -1e9, 1e9};
  EXPECT_NEAR(inspect(model).check.signed_volume_m3, 8.0, 1e-4);
}

TEST(ModelReport, AHoleMakesTheMeshOpen) {
  Model model = make_builtin_model("sphere");
  model.mesh.triangles.pop_back();
  const ModelReport report = inspect(model);
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.check.open_edges, 3U);
  EXPECT_EQ(report.winding, Winding::undecided);
}

TEST(ModelReport, AnInvertedMeshIsInward) {
  Model model = make_builtin_model("torus");
  for (Triangle& t : model.mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(inspect(model).winding, Winding::inward);
}

TEST(ModelReport, OneFlippedTriangleMakesTheWindingInconsistent) {
  Model model = make_builtin_model("sphere");
  std::swap(model.mesh.triangles[7][0], model.mesh.triangles[7][1]);
  const ModelReport report = inspect(model);
  EXPECT_EQ(report.winding, Winding::inconsistent);
  EXPECT_EQ(report.check.inconsistent_edges, 3U);
}

TEST(ModelReport, CountsMeshDefects) {
  Model model;
  model.materials.resize(1);
  // 3 has the position of 0, 4 is unused, 5 is between 0 and 1
  model.mesh.positions_m = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {9, 9, 9}, {1, 0, 0}};
  model.mesh.triangles = {{0, 1, 2}, {3, 2, 1}, {0, 5, 1}, {0, 1, 3}};
  const ModelReport report = inspect(model);
  EXPECT_EQ(report.check.duplicate_vertices, 1U);
  EXPECT_EQ(report.check.unused_vertices, 1U);
  EXPECT_EQ(report.check.duplicate_triangles, 1U);
  EXPECT_EQ(report.check.degenerate_triangles, 2U);
  EXPECT_EQ(report.check.crowded_edges, 1U);
}

TEST(ModelReport, NamesTexturesOfMaterials) {
  Model model = make_builtin_model("plane");
  model.textures = {{"leaf.png", 2, 1, 4, std::vector<std::uint8_t>(8)}};
  model.materials.at(0).alpha_texture.texture = 0;
  model.materials.at(0).alpha_cutoff = 0.5F;
  const ModelReport report = inspect(model);
  EXPECT_EQ(report.materials.at(0).alpha_texture, "leaf.png");
  EXPECT_EQ(report.materials.at(0).diffuse_texture, "");
  EXPECT_TRUE(report.materials.at(0).cut_out);
  EXPECT_EQ(report.materials.at(0).triangles, report.triangles);
  EXPECT_EQ(report.textures.at(0).width, 2U);
}

TEST(ModelReport, ListsAHeightMapAndItsNormalMapAsOneImage) {
  Model model = make_builtin_model("plane");
  model.textures = {{"weave.png", 2, 1, 1, std::vector<std::uint8_t>(2)},
                    {"weave.png", 2, 1, 3, std::vector<std::uint8_t>(6)},
                    {"other.png", 2, 1, 3, std::vector<std::uint8_t>(6)}};
  const ModelReport report = inspect(model);
  ASSERT_EQ(report.textures.size(), 2U);
  EXPECT_EQ(report.textures[0].name, "weave.png");
  EXPECT_EQ(report.textures[0].channels, 1U);
  EXPECT_EQ(report.textures[1].name, "other.png");
}

TEST(ModelReport, AnEmptyMeshIsReportedWithoutACrash) {
  const ModelReport report = inspect(Model{});
  EXPECT_EQ(report.triangles, 0U);
  EXPECT_FALSE(report.closed);
}

TEST(ModelReport, GuessesTheUnit) {
  EXPECT_THAT(guess_unit(0.155), HasSubstr("plausible as metres"));
  EXPECT_THAT(guess_unit(1550.0), HasSubstr("millimetres"));
  EXPECT_THAT(guess_unit(1550.0), HasSubstr("1.55 m"));
  EXPECT_THAT(guess_unit(1e7), HasSubstr("very large"));
  EXPECT_THAT(guess_unit(0.001), HasSubstr("very small"));
}

}  // namespace
}  // namespace glidar
