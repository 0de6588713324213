// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/import_process.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <regex>

namespace glidar {
namespace {

namespace fs = std::filesystem;
using testing::data_folder;
using testing::load;

/// Triangles that the manifest's independent look at a file found, by path.
std::map<std::string, std::uint64_t> counted_triangles() {
  std::map<std::string, std::uint64_t> counts;
  std::ifstream manifest(data_folder() / "MANIFEST.tsv");
  const std::regex pattern(R"(^([^\t]+)\t.*\tOK .* insttris=(\d+) otherprim=(\d+))");
  for (std::string line; std::getline(manifest, line);) {
    std::smatch found;
    if (!std::regex_search(line, found, pattern)) continue;
    const auto triangles = std::stoull(found[2]) - std::stoull(found[3]);
    if (triangles > 0) counts[found[1]] = triangles;
  }
  return counts;
}

/// Why some count differs or a file that the manifest could read is refused.
const std::map<std::string, std::string> kExceptions = {
    {"textured/assimp/Collada/cameras.dae", "it has no surfaces"},
    {"textured/assimp/Collada/lights.dae", "it has no surfaces"},
    {"textured/assimp/OBJ/number_formats.obj", "3.1+e2 is no number"},
    {"textured/obj_mtl/tinyobj/test-nan.obj", "two triangles touch NaN and are left out"}};

class DataModels : public ::testing::TestWithParam<const char*> {};

TEST_P(DataModels, LoadWithAllTheirTriangles) {
  GLIDAR_NEEDS_DATA();
  std::size_t loaded = 0;
  for (const auto& [path, triangles] : counted_triangles()) {
    if (!path.starts_with(std::string(GetParam()) + "/") || kExceptions.contains(path)) continue;
    SCOPED_TRACE(path);
    try {
      const Model model = load(data_folder() / path);
      EXPECT_EQ(model.mesh.triangles.size(), triangles);
      EXPECT_EQ(model.mesh.normals.size(), model.mesh.positions_m.size());
      EXPECT_NO_THROW(validate(model.mesh));
      ++loaded;
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(loaded, 10U);
}

INSTANTIATE_TEST_SUITE_P(Folders, DataModels, ::testing::Values("models", "textured", "scenes"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(DataModels, GazeboTexturesAreFoundInTheirPackage) {
  GLIDAR_NEEDS_DATA();
  const Model model =
      load(data_folder() / "scenes/gazebo/jersey_barrier/meshes/jersey_barrier.dae");
  EXPECT_TRUE(model.missing_textures.empty());
  EXPECT_EQ(model.textures.size(), 1U);
}

TEST(DataModels, WindowsPathsAreFound) {
  GLIDAR_NEEDS_DATA();
  for (const char* path : {"textured/assimp/OBJ/spider.obj",
                           "textured/obj_mtl/obj2gltf/box-windows-paths/box-windows-paths.obj",
                           "textured/trimesh/fuze.ply", "textured/trimesh/fuze.obj"}) {
    const Model model = load(data_folder() / path);
    EXPECT_FALSE(model.textures.empty()) << path;
    EXPECT_TRUE(model.missing_textures.empty()) << path;
  }
}

TEST(DataModels, EmbeddedTexturesAreRead) {
  GLIDAR_NEEDS_DATA();
  for (const char* path :
       {"textured/assimp/FBX/embedded_ascii/box.FBX", "textured/assimp/Collada/duck.zae"}) {
    EXPECT_EQ(load(data_folder() / path).textures.size(), 1U) << path;
  }
}

TEST(DataModels, NormalMapsCreateTangents) {
  GLIDAR_NEEDS_DATA();
  const Model model =
      load(data_folder() / "textured/gltf/NormalTangentTest/glTF/NormalTangentTest.gltf");
  EXPECT_TRUE(model.materials.at(0).normal_texture.used());
  ASSERT_EQ(model.mesh.tangents.size(), model.mesh.positions_m.size());
  for (std::size_t v = 0; v < model.mesh.tangents.size(); ++v) {
    EXPECT_NEAR(model.mesh.tangents[v].head<3>().norm(), 1.0F, 1e-4F);
    EXPECT_NEAR(model.mesh.tangents[v].head<3>().dot(model.mesh.normals[v]), 0.0F, 1e-2F);
  }
}

TEST(DataModels, SamplerSettingsAreRead) {
  GLIDAR_NEEDS_DATA();
  const Model model =
      load(data_folder() / "textured/gltf/TextureSettingsTest/glTF/TextureSettingsTest.gltf");
  std::map<Wrap, int> wraps;
  for (const Material& m : model.materials) ++wraps[m.diffuse_texture.wrap_u];
  EXPECT_GT(wraps[Wrap::repeat], 0);
  EXPECT_GT(wraps[Wrap::mirror], 0);
  EXPECT_GT(wraps[Wrap::clamp], 0);
}

}  // namespace
}  // namespace glidar
