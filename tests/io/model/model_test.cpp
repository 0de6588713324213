// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model.hpp>
#include <glidar/io/model/model_parts.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>

#include <cmath>

namespace glidar {
namespace {

using testing::gltf;
using ::testing::HasSubstr;
using testing::load;
using testing::load_error;
using ::testing::Not;
using testing::TestFolder;
using testing::without_cache;
namespace fs = std::filesystem;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

Eigen::Vector3d place(const Mesh& mesh, std::size_t triangle, std::size_t corner) {
  return mesh.origin_m + mesh.positions_m[mesh.triangles[triangle][corner]].cast<double>();
}

Eigen::Vector3d front(const Mesh& mesh, std::size_t t) {
  return (place(mesh, t, 1) - place(mesh, t, 0)).cross(place(mesh, t, 2) - place(mesh, t, 0));
}

TEST(LoadModel, ReadsPositionsAndTheirOrderUnchanged) {
  const TestFolder temp;
  const Model model = load(temp.write("a.obj", kTriangle));
  ASSERT_EQ(model.mesh.triangles.size(), 1U);
  EXPECT_EQ(place(model.mesh, 0, 0), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(place(model.mesh, 0, 1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(place(model.mesh, 0, 2), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(model.mesh.normals.at(0), Eigen::Vector3f::UnitZ());
  EXPECT_EQ(model.mesh.name, "a");
  EXPECT_EQ(model.source, (temp.path() / "a.obj").string());
  EXPECT_EQ(model.hash.size(), 32U);
  EXPECT_THAT(model.format, HasSubstr("Wavefront"));
  EXPECT_NO_THROW(validate(model.mesh));
}

TEST(LoadModel, CoordinatesFarFromZeroKeepTheirPrecision) {
  const TestFolder temp;
  const Model model = load(temp.write(
      "far.obj", "v 1000000.125 7 -3\nv 1000001.25 7 -3\nv 1000000.125 8.5 -3\nf 1 2 3\n"));
  EXPECT_EQ(place(model.mesh, 0, 0), Eigen::Vector3d(1000000.125, 7, -3));
  EXPECT_EQ(place(model.mesh, 0, 1), Eigen::Vector3d(1000001.25, 7, -3));
  EXPECT_LT(std::abs(model.mesh.positions_m[0].x()), 2.0F);
}

TEST(LoadModel, ChangingTheUpAxisIsAnExactPermutation) {
  const TestFolder temp;
  const fs::path file = temp.write("a.obj", "v 1 2 3\nv 4 2 3\nv 1 7 9\nf 1 2 3\n");
  ModelOptions options = without_cache();
  const Eigen::Vector3d normal = front(load(file).mesh, 0);
  options.up = Axis::y;
  Mesh mesh = load(file, options).mesh;
  EXPECT_EQ(place(mesh, 0, 0), Eigen::Vector3d(1, -3, 2));
  EXPECT_EQ(front(mesh, 0), Eigen::Vector3d(normal.x(), -normal.z(), normal.y()));
  options.up = Axis::x;
  mesh = load(file, options).mesh;
  EXPECT_EQ(place(mesh, 0, 0), Eigen::Vector3d(2, 3, 1));
  EXPECT_EQ(front(mesh, 0), Eigen::Vector3d(normal.y(), normal.z(), normal.x()));
  options.up = Axis::z;
  EXPECT_EQ(place(load(file, options).mesh, 0, 0), Eigen::Vector3d(1, 2, 3));
}

TEST(LoadModel, UnitsScale) {
  const TestFolder temp;
  ModelOptions options = without_cache();
  options.metres_per_unit = 0.001;
  const Model model =
      load(temp.write("a.obj", "v 0 0 0\nv 500 0 0\nv 0 250 0\nf 1 2 3\n"), options);
  EXPECT_FLOAT_EQ(static_cast<float>(place(model.mesh, 0, 1).x()), 0.5F);
  options.metres_per_unit = 2.0;
  EXPECT_EQ(bounds(load_model("builtin:box", options, {}).mesh).sizes(), Eigen::Vector3d(4, 4, 4));
}

TEST(LoadModel, CentreMovesTheBoxCentreToTheOriginExactly) {
  const TestFolder temp;
  ModelOptions options = without_cache();
  const auto file = temp.write("a.obj", "v 1000.1 2 3\nv 1004.1 2 3\nv 1000.1 7 9\nf 1 2 3\n");
  const Mesh plain = load(file, options).mesh;
  options.centre = true;
  const Mesh centred = load(file, options).mesh;
  EXPECT_EQ(bounds(centred).center(), Eigen::Vector3d::Zero());
  EXPECT_EQ(centred.positions_m, plain.positions_m);
  EXPECT_EQ(Eigen::Vector3d(plain.origin_m - centred.origin_m), bounds(plain).center());
}

TEST(LoadModel, InvalidOptionsAreErrors) {
  for (const double bad : {0.0, -1.0, std::nan(""), double{INFINITY}}) {
    ModelOptions options = without_cache();
    options.metres_per_unit = bad;
    EXPECT_THAT(load_error("builtin:box", options), HasSubstr("metres_per_unit"));
  }
  ModelOptions options = without_cache();
  options.time_limit_s = -1.0;
  EXPECT_THAT(load_error("builtin:box", options), HasSubstr("time_limit_s"));
  options = without_cache();
  options.crease_angle_rad = 4.0;
  EXPECT_THAT(load_error("builtin:box", options), HasSubstr("crease_angle_rad"));
}

TEST(LoadModel, HugeNumbersInErrorsAreShort) {
  ModelOptions options = without_cache();
  options.metres_per_unit = 1e300;
  EXPECT_THAT(load_error("builtin:box", options), HasSubstr("1e+300 makes"));
  options.metres_per_unit = -1e300;
  EXPECT_THAT(load_error("builtin:box", options), HasSubstr("-1e+300"));
  EXPECT_LT(load_error("builtin:box", options).size(), 120U);
}

TEST(LoadModel, NodeTransformsAreAppliedAndMirrorsKeepTheirFronts) {
  const TestFolder temp;
  const Model model = load(temp.write(
      "a.gltf",
      gltf(
          R"([{"children":[1,2]},{"mesh":0,"translation":[0,0,5]},{"mesh":0,"scale":[-2,1,1]}])")));
  ASSERT_EQ(model.parts.size(), 2U);
  EXPECT_EQ(model.parts[1].first_triangle, 1U);
  EXPECT_EQ(place(model.mesh, 0, 0).z(), 5.0);
  EXPECT_GT(front(model.mesh, 0).z(), 0.0);
  // A mirrored thing is seen from the same side as before.
  EXPECT_GT(front(model.mesh, 1).z(), 0.0);
  EXPECT_EQ(bounds(model.mesh).min().x(), -2.0);
  for (const Eigen::Vector3f& n : model.mesh.normals) EXPECT_EQ(n, Eigen::Vector3f::UnitZ());
}

TEST(LoadModel, NodesWithTrianglesAreATreeOfParts) {
  const TestFolder temp;
  const Model model = load(temp.write(
      "a.gltf", gltf(R"([{"name":"robot","children":[1,3],"translation":[1,0,0]},)"
                     R"({"name":"arm","children":[2],"scale":[2,2,2],"translation":[0,3,0]},)"
                     R"({"mesh":0,"name":"hand","translation":[0,0,1]},{"name":"camera"}])")));
  const std::vector<PartSummary> parts = list_parts(model);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[2].name, "robot/arm/hand");
  EXPECT_EQ(parts[2].parent, "robot/arm");
  EXPECT_EQ(parts[2].triangles, 1U);
  // metres, in the file's axes, although the model is turned to z up
  EXPECT_TRUE(parts[0].parent_from_part.isApprox(Pose(Eigen::Translation3d(1, 0, 0))));
  EXPECT_TRUE(parts[1].parent_from_part.isApprox(Pose(Eigen::Translation3d(0, 3, 0))));
  EXPECT_TRUE(parts[2].parent_from_part.isApprox(Pose(Eigen::Translation3d(0, 0, 2))));
  EXPECT_TRUE(parts[2].box_m.isApprox(bounds(model.mesh)));
}

TEST(LoadModel, FramesOfNodesMoveWithUnitUpAxisAndCentre) {
  const TestFolder temp;
  const auto file = temp.write(
      "a.gltf", gltf(R"([{"mesh":0,"name":"a","translation":[1,2,3],"scale":[-1,1,1]}])"));
  ModelOptions options = without_cache();
  options.metres_per_unit = 0.5;
  options.centre = true;
  const Model model = load(file, options);
  ASSERT_EQ(model.nodes.size(), 2U);
  const Model plain = load(file);
  const Eigen::Vector3d moved =
      0.5 * plain.nodes[1].model_from_node.translation() - 0.5 * bounds(plain.mesh).center();
  EXPECT_TRUE(model.nodes[1].model_from_node.translation().isApprox(moved, 1e-7));
  EXPECT_TRUE(is_rigid(model.nodes[1].model_from_node));
  EXPECT_EQ(model.parts[0].node, 1U);
  const Pose in_file = list_parts(model)[0].parent_from_part;
  EXPECT_TRUE(in_file.translation().isApprox(Eigen::Vector3d(0.5, 1.0, 1.5), 1e-7));
}

TEST(LoadModel, PartsWithNaNAreOmittedAndReported) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 1 1\nf 1 2 4\nf 1 2 3\n"));
  EXPECT_EQ(model.mesh.triangles.size(), 1U);
  EXPECT_THAT(model.notes, ::testing::Contains(HasSubstr("1 triangles touch coordinates")));
}

TEST(LoadModel, MaterialsTexturesAndTheirOptions) {
  const TestFolder temp;
  temp.write("a.mtl",
             "newmtl paint\nKd 0.5 0.25 1\nKs 1 1 1\nNs 500\nillum 2\n"
             "map_Kd -s 2 3 1 -o 0.5 0.25 paint.ppm\nmap_Ks gone.ppm\n");
  temp.write("paint.ppm", testing::ppm(2, 2, "abc"));
  std::string reported;
  const Report report{[&reported](Severity, std::string_view text) { reported += text; }, {}};
  const Model model =
      load_model(temp.write("a.obj", testing::quad_obj("a.mtl")).string(), without_cache(), report);
  ASSERT_EQ(model.materials.size(), 1U);
  const Material& m = model.materials[0];
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(m.diffuse, Eigen::Vector3f(0.5F, 0.25F, 1.0F));
  EXPECT_EQ(m.ambient, m.diffuse);
  EXPECT_EQ(m.specular, Eigen::Vector3f::Ones());
  EXPECT_EQ(m.shininess, 128.0F);
  ASSERT_TRUE(m.diffuse_texture.used());
  EXPECT_EQ(m.diffuse_texture.uv_scale_rotate.diagonal(), Eigen::Vector2f(2.0F, 3.0F));
  EXPECT_EQ(m.diffuse_texture.uv_offset, Eigen::Vector2f(0.5F, 0.25F));
  EXPECT_FALSE(m.specular_texture.used());
  EXPECT_EQ(model.textures.at(0).channels, 3U);
  ASSERT_EQ(model.missing_textures.size(), 1U);
  EXPECT_EQ(model.missing_textures[0].name, "gone.ppm");
  EXPECT_EQ(model.missing_textures[0].reason, "not found");
  EXPECT_THAT(reported, HasSubstr("gone.ppm"));
}

TEST(LoadModel, AnOpacityTextureBecomesACutOut) {
  const TestFolder temp;
  temp.write("a.mtl", "newmtl paint\nmap_d mask.tga\n");
  temp.write("mask.tga", testing::tga(2, 2, std::string("\x10\x20\x30\x40", 4)));
  const Model model = load(temp.write("a.obj", testing::quad_obj("a.mtl")));
  const Material& m = model.materials.at(0);
  ASSERT_TRUE(m.alpha_texture.used());
  EXPECT_EQ(m.alpha_cutoff, 0.5F);
  EXPECT_NEAR(opacity_at(m, model.textures, {0.5F, 0.5F}), 64.0F / 255.0F, 1e-6F);
}

TEST(LoadModel, AConstantOpaqueAlphaIsDropped) {
  const TestFolder temp;
  temp.write("a.mtl", "newmtl paint\nmap_Kd opaque.tga\n");
  temp.write("opaque.tga", testing::tga(2, 2, std::string("\x10\x20\x30\xff", 4)));
  const Model model = load(temp.write("a.obj", testing::quad_obj("a.mtl")));
  ASSERT_EQ(model.textures.at(0).channels, 3U);
  EXPECT_EQ(model.textures[0].texels[0], 0x30);  // rgb from bgr
  EXPECT_EQ(model.materials[0].alpha_cutoff, 0.0F);
}

TEST(LoadModel, ABumpMapBecomesANormalMap) {
  const TestFolder temp;
  temp.write("a.mtl", "newmtl paint\nmap_bump -bm 2 bump.pgm\n");
  std::string ramp = "P5 8 8 255\n";
  for (int i = 0; i < 64; ++i) ramp += static_cast<char>(8 * (i % 8));
  temp.write("bump.pgm", ramp);
  const Model model = load(temp.write("a.obj", testing::quad_obj("a.mtl")));
  const Material& m = model.materials.at(0);
  ASSERT_TRUE(m.normal_texture.used());
  const Eigen::Vector3f rgb =
      sample(m.normal_texture, model.textures, {0.4375F, 0.5F}).head<3>() * 2.0F -
      Eigen::Vector3f::Ones();
  EXPECT_NEAR(m.normal_scale * rgb.x() / rgb.z(), -2.0 * 8.0 / 255.0, 2e-3);
  EXPECT_EQ(model.mesh.tangents.size(), model.mesh.positions_m.size());
}

TEST(LoadModel, ANormalMapUnderABumpKeyIsUsedUnchanged) {
  const TestFolder temp;
  temp.write("a.mtl", "newmtl paint\nmap_bump n.ppm\n");
  temp.write("n.ppm", testing::ppm(2, 2, "\x80\x80\xff"));
  const Model model = load(temp.write("a.obj", testing::quad_obj("a.mtl")));
  EXPECT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.materials.at(0).normal_scale, 1.0F);
  EXPECT_TRUE(model.materials.at(0).normal_texture.used());
}

TEST(LoadModel, GltfMaterialsFollowTheDocumentedConversion) {
  const TestFolder temp;
  const Model model = load(temp.write(
      "a.gltf",
      gltf(
          R"([{"mesh":0}])",
          R"({"alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[0.5,1,0.25,1],
"metallicFactor":0,"roughnessFactor":0.5,"baseColorTexture":{"index":0}}})",
          R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"magFilter":9728,"wrapS":33071,"wrapT":33648}],
"images":[{"uri":"leaf%20one.tga"}])")));
  const Material& m = model.materials.at(0);
  EXPECT_EQ(m.diffuse, Eigen::Vector3f(0.5F, 1.0F, 0.25F));
  EXPECT_TRUE(m.specular.isApprox(Eigen::Vector3f::Constant(0.02F)));
  EXPECT_FLOAT_EQ(m.shininess, 30.0F);
  EXPECT_EQ(m.alpha_cutoff, 0.25F);
  EXPECT_EQ(m.diffuse_texture.used(), false);
  EXPECT_EQ(model.missing_textures.at(0).reason, "not found");
  temp.write("leaf one.tga", testing::tga(2, 2, std::string("\x10\x20\x30\x40", 4)));
  const Model whole = load(temp.path() / "a.gltf");
  const Material& leaf = whole.materials.at(0);
  EXPECT_EQ(leaf.diffuse_texture.filter, Filter::nearest);
  EXPECT_EQ(leaf.diffuse_texture.wrap_u, Wrap::clamp);
  EXPECT_EQ(leaf.diffuse_texture.wrap_v, Wrap::mirror);
  EXPECT_EQ(leaf.alpha_texture.texture, leaf.diffuse_texture.texture);
}

TEST(LoadModel, TextureTransformsOfGltf) {
  const TestFolder temp;
  temp.write("t.ppm", testing::ppm(1, 1, "abc"));
  const auto use_for = [&temp](const std::string& transform) {
    return load(
               temp.write(
                   "a.gltf",
                   gltf(
                       R"([{"mesh":0}])",
                       R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":)" +
                           transform + "}}}}",
                       R"(,"extensionsUsed":["KHR_texture_transform"],"textures":[{"source":0}],"images":[{"uri":"t.ppm"}])")))
        .materials.at(0)
        .diffuse_texture;
  };
  // The extension's own formula with v down: uv' = offset + R S uv, R counter-clockwise in the
  // image.
  const auto expected = [](Eigen::Vector2f uv, Eigen::Vector2f o, float r, Eigen::Vector2f s) {
    const Eigen::Vector2f down(uv.x() * s.x(), (1.0F - uv.y()) * s.y());
    const float c = std::cos(r);
    const float n = std::sin(r);
    return Eigen::Vector2f(o.x() + c * down.x() + n * down.y(),
                           1.0F - (o.y() - n * down.x() + c * down.y()));
  };
  const Eigen::Vector2f at(0.3F, 0.8F);
  const TextureUse moved = use_for(R"({"offset":[0.25,0.125],"scale":[2,4]})");
  EXPECT_LT((moved.uv_scale_rotate * at + moved.uv_offset -
             expected(at, {0.25F, 0.125F}, 0.0F, {2.0F, 4.0F}))
                .norm(),
            1e-5F);
  const TextureUse turned = use_for(R"({"offset":[0.25,0.5],"rotation":0.7,"scale":[2,3]})");
  EXPECT_LT((turned.uv_scale_rotate * at + turned.uv_offset -
             expected(at, {0.25F, 0.5F}, 0.7F, {2.0F, 3.0F}))
                .norm(),
            1e-5F);
}

TEST(LoadModel, TexturesInsideTheFileAreRead) {
  const TestFolder temp;
  // A PPM of one pixel (1 2 3), as a data URI.
  const Model model = load(temp.write(
      "a.gltf",
      gltf(
          R"([{"mesh":0}])", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})",
          R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,UDYgMSAxIDI1NQoBAgM="}])")));
  ASSERT_EQ(model.textures.size(), 1U);
  EXPECT_EQ(model.textures[0].texels, (std::vector<std::uint8_t>{1, 2, 3}));
}

TEST(LoadModel, UvsPointUpwards) {
  const TestFolder temp;
  const Model model = load(temp.write("a.gltf", gltf(R"([{"mesh":0}])")));
  // In the file v runs down: the corner at (0, 0) is the top left of the image.
  EXPECT_EQ(model.mesh.uvs[0].at(model.mesh.triangles[0][0]), Eigen::Vector2f(0.0F, 1.0F));
}

TEST(LoadModel, FilesThatAreNotModelsAreReported) {
  const TestFolder temp;
  EXPECT_THAT(load_error((temp.path() / "asteriod.obj").string()), HasSubstr("cannot be opened"));
  temp.write("asteroid.obj", kTriangle);
  EXPECT_THAT(load_error((temp.path() / "asteriod.obj").string()),
              HasSubstr("did you mean asteroid.obj?"));
  EXPECT_THAT(load_error(temp.path().string()), HasSubstr("not a file"));
  EXPECT_THAT(load_error(temp.write("empty.ply", "").string()), HasSubstr("empty"));
  EXPECT_THAT(load_error(temp.write("a.xyzzy", "words").string()), HasSubstr("known format"));
  EXPECT_THAT(load_error(temp.write("p.obj", "v 0 0 0\nv 1 0 0\np 1 2\n").string()),
              HasSubstr("no triangles"));
  EXPECT_THAT(load_error(""), HasSubstr("builtin:NAME"));
  EXPECT_THAT(load_error("builtin:sphre"), HasSubstr("sphere"));
}

TEST(LoadModel, LimitsAreEnforced) {
  GLIDAR_SKIP_SANITIZED();
  const TestFolder temp;
  const std::string file = temp.write("a.obj", kTriangle).string();
  ModelOptions options = without_cache();
  options.time_limit_s = 1e-6;
  EXPECT_THAT(load_error(file, options), HasSubstr("longer than"));
  options = without_cache();
  options.memory_limit_bytes = 64U << 20U;
  std::string large = kTriangle;
  for (int i = 0; i < 400'000; ++i) large += "v 0.123456789 0.123456789 0.123456789\nf -1 1 2\n";
  EXPECT_THAT(load_error(temp.write("large.obj", large).string(), options),
              ::testing::AnyOf(HasSubstr("more memory than 64 MiB"), HasSubstr("crashed")));
}

TEST(LoadModel, AMissingImportProgramIsAnErrorThatNamesIt) {
  const TestFolder temp;
  const std::string file = temp.write("a.obj", kTriangle).string();
  ::setenv("GLIDAR_IMPORT_HELPER", "/nowhere/glidar-import", 1);
  const std::string text = load_error(file);
  ::unsetenv("GLIDAR_IMPORT_HELPER");
  EXPECT_THAT(text, HasSubstr("GLIDAR_IMPORT_HELPER"));
  EXPECT_THAT(text, HasSubstr("/nowhere/glidar-import"));
  EXPECT_EQ(load_error(file), "no error");
}

TEST(LoadModel, MaterialsOutsideTheFolderAreNotOpened) {
  const TestFolder temp;
  temp.write("secret.mtl", "newmtl paint\nKd 1 0 0\n");
  const Model model = load(temp.write("inner/a.obj", testing::quad_obj("../secret.mtl")));
  EXPECT_THAT(model.notes, ::testing::Contains(HasSubstr("outside the model's folder")));
  EXPECT_NE(model.materials.at(0).diffuse, Eigen::Vector3f(1, 0, 0));
}

TEST(AddModel, AppendsWithItsOwnMaterialsAndTextures) {
  Scene scene;
  Model first = load_model("builtin:box", without_cache(), {});
  first.textures.assign(2, {"other", 1, 1, 1, {3}});
  Model second = load_model("builtin:plane", without_cache(), {});
  second.textures.push_back({"t", 1, 1, 1, {7}});
  second.materials.at(0).diffuse_texture.texture = 0;
  EXPECT_EQ(add_model(scene, first), 0U);
  EXPECT_EQ(add_model(scene, second), 1U);
  ASSERT_EQ(scene.instances.size(), 2U);
  const Instance& instance = scene.instances[1];
  EXPECT_EQ(instance.mesh, 1U);
  EXPECT_EQ(scene.sources.at(1).path, "builtin:plane");
  const Material& material = scene.materials.at(instance.materials.at(0));
  EXPECT_EQ(material.diffuse_texture.texture, 2);
  EXPECT_EQ(scene.textures.at(2).name, "t");
  EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace glidar
