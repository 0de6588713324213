// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Axes, transparency and textures of specific formats.
#include <glidar/io/model/import_process.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using testing::gltf;
using ::testing::HasSubstr;
using testing::load;
using ::testing::Not;
using testing::TestFolder;
namespace fs = std::filesystem;

TEST(ModelFormats, AZUpColladaBarrierStandsOnTheGround) {
  GLIDAR_NEEDS_DATA();
  const Eigen::AlignedBox3d box =
      bounds(load(testing::data_folder() / "scenes/gazebo/jersey_barrier/meshes/jersey_barrier.dae",
                  testing::as_declared())
                 .mesh);
  EXPECT_NEAR(box.min().z(), 0.0, 1e-3);
  EXPECT_NEAR(box.max().z(), 1.143, 1e-3);  // the height in the package's model.sdf
}

std::vector<std::string> notes_of_mtl(const std::string& material) {
  const TestFolder temp;
  temp.write("a.mtl", "newmtl paint\n" + material + "\n");
  temp.write("mask.ppm", testing::ppm(1, 1, "abc"));
  return load(temp.write("a.obj", testing::quad_obj("a.mtl"))).notes;
}

TEST(ModelFormats, UniformTranslucencyIsReportedAsOpaque) {
  EXPECT_THAT(notes_of_mtl("d 0.3"), Contains(HasSubstr("transparency is shown solid")));
  EXPECT_THAT(notes_of_mtl("Tr 0.7"), Contains(HasSubstr("transparency is shown solid")));
  EXPECT_THAT(notes_of_mtl("d 1"), Not(Contains(HasSubstr("transparency"))));
  EXPECT_THAT(notes_of_mtl("d 0.3\nmap_d mask.ppm"),
              Not(Contains(HasSubstr("transparency"))));  // the mask defines the cut-out
}

TEST(ModelFormats, GltfReportsOnlyBlendedMaterialsAsOpaque) {
  const TestFolder temp;
  const auto notes = [&](const std::string& mode) {
    const std::string material =
        R"({"alphaMode":")" + mode + R"(","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]}})";
    return load(temp.write("a.gltf", gltf(R"([{"mesh":0}])", material))).notes;
  };
  EXPECT_THAT(notes("BLEND"), Contains(HasSubstr("transparency is shown solid")));
  EXPECT_THAT(notes("OPAQUE"), Not(Contains(HasSubstr("transparency"))));
  EXPECT_THAT(notes("MASK"), Not(Contains(HasSubstr("transparency"))));
}

TEST(ModelFormats, APlyTruncatedInItsHeaderIsRejectedBeforeTheTimeLimit) {
  const TestFolder temp;
  for (const char* text :
       {"ply\nformat ascii 1.0", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n",
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x"}) {
    const ImportRequest request{fs::canonical(temp.write("a.ply", text)), 0.7, 30.0, 0};
    const ImportRun run = run_import(request, {});
    EXPECT_EQ(run.end, ImportEnd::answered) << text;
    EXPECT_THAT(
        testing::load_error(request.model.string()),
        AllOf(HasSubstr("has no line 'end_header': the file ends too early"), HasSubstr("damaged")))
        << text;
  }
}

TEST(ModelFormats, ThePlyCommentTextureFileNamesTheTexture) {
  const TestFolder temp;
  temp.write("red paint.ppm", testing::ppm(1, 1, "abc"));
  const Model model = load(temp.write("a.ply", R"(ply
format ascii 1.0
comment VCGLIB generated
comment TextureFile   red paint.ppm 
element vertex 3
property float x
property float y
property float z
property float s
property float t
element face 1
property list uchar int vertex_indices
end_header
0 0 0 0 0
1 0 0 1 0
0 1 0 0 1
3 0 1 2
)"));
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.textures[0].name, "red paint.ppm");
  EXPECT_TRUE(model.materials.at(0).diffuse_texture.used());
}

TEST(ModelFormats, TexturesBeyondTheLimitAreMissingWithTheirSize) {
  const auto reason = [](const std::string& image) {
    const TestFolder temp;
    temp.write("paint.ppm", image);
    temp.write("a.mtl", "newmtl paint\nmap_Kd paint.ppm\n");
    const Model model = load(temp.write("a.obj", testing::quad_obj("a.mtl")));
    return model.missing_textures.size() == 1 ? model.missing_textures[0].reason : "";
  };
  const std::string png = "\x89PNG\r\n\x1A\n" + std::string("\0\0\0\x0DIHDR", 8);
  EXPECT_EQ(reason("P6 20000 1 255\n"), "too large: 20000 x 1, allowed 16384 per side");
  EXPECT_EQ(reason("P6\n# a comment\n2000000000 3000000000 255\n"),
            "too large: 2000000000 x 3000000000, allowed 16384 per side");
  EXPECT_EQ(reason("P5 1 99999999999999999999999 255\n"),
            "too large: 1 x 18446744073709551615, allowed 16384 per side");
  EXPECT_EQ(reason(png + std::string("\x7F\xFF\xFF\xFF\0\0\0\x02\x08\x02\0\0\0", 13)),
            "too large: 2147483647 x 2, allowed 16384 per side");
  EXPECT_EQ(reason("P6 0 4 255\n"), "it has no pixels");
  EXPECT_EQ(reason("P6 abc"), "it has no pixels");
}

TEST(ModelFormats, ATextureInASiblingFolderIsReportedWithARemedy) {
  const TestFolder temp;
  temp.write("pictures/paint.ppm", testing::ppm(1, 1, "abc"));
  temp.write("model/a.mtl", "newmtl paint\nmap_Kd ../pictures/paint.ppm\n");
  const Model model = load(temp.write("model/a.obj", testing::quad_obj("a.mtl")));
  ASSERT_EQ(model.missing_textures.size(), 1U);
  EXPECT_EQ(model.missing_textures[0].name, "../pictures/paint.ppm");
  EXPECT_THAT(
      model.missing_textures[0].reason,
      AllOf(HasSubstr("outside the model's folder"), HasSubstr("copy it into the model's folder")));
  temp.write("model/paint.ppm", testing::ppm(1, 1, "abc"));
  EXPECT_THAT(load(temp.path() / "model/a.obj").missing_textures, ::testing::IsEmpty());
}

// KHR_texture_transform, "Example JSON": offset (0, 1), a quarter turn and half size show "only the
// lower left quadrant of the source image, rotated clockwise 90 degrees".
TEST(ModelFormats, TheTextureTransformExampleOfTheGltfExtensionShowsTheLowerLeftQuadrant) {
  const TestFolder temp;
  temp.write("t.ppm", testing::ppm(1, 1, "abc"));
  const std::string material =
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]}}}}})";
  const std::string more =
      R"(,"extensionsUsed":["KHR_texture_transform"],"textures":[{"source":0}],"images":[{"uri":"t.ppm"}])";
  const TextureUse use = load(temp.write("a.gltf", gltf(R"([{"mesh":0}])", material, more)))
                             .materials.at(0)
                             .diffuse_texture;
  ASSERT_TRUE(use.used());
  const auto shown = [&](float u, float v) -> Eigen::Vector2f {
    return use.uv_scale_rotate * Eigen::Vector2f(u, v) + use.uv_offset;
  };
  // With v up. Turned clockwise, the image's lower left corner is seen at the upper left.
  EXPECT_LT((shown(0, 1) - Eigen::Vector2f(0, 0)).norm(), 1e-6F);
  EXPECT_LT((shown(1, 1) - Eigen::Vector2f(0, 0.5F)).norm(), 1e-6F);
  EXPECT_LT((shown(1, 0) - Eigen::Vector2f(0.5F, 0.5F)).norm(), 1e-6F);
  EXPECT_LT((shown(0, 0) - Eigen::Vector2f(0.5F, 0)).norm(), 1e-6F);
}

TEST(ModelFormats, EveryFileOfAModelIsListed) {
  const TestFolder temp;
  ModelOptions options;
  options.cache_folder = temp.path() / "cache";
  temp.write("a.mtl", "newmtl paint\nmap_Kd paint.ppm\n");
  temp.write("paint.ppm", testing::ppm(1, 1, "abc"));
  const fs::path file = temp.write("a.obj", testing::quad_obj("a.mtl"));
  for (const bool from_cache : {false, true}) {
    const Model model = load(file, options);
    EXPECT_EQ(model.from_cache, from_cache);
    EXPECT_THAT(model.files, ::testing::ElementsAre(file.string(), (temp.path() / "a.mtl").string(),
                                                    (temp.path() / "paint.ppm").string()));
  }
}

}  // namespace
}  // namespace glidar
