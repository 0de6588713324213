// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// glTF files with compressed meshes and textures. The compressed meshes are made here, by the
// encoders of Draco and meshoptimizer.
#include <glidar/io/model/model.hpp>

#include <io/model_test_support.hpp>

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string_view>

namespace glidar {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TestFolder;

/// A height field of n x n squares, 2 n^2 triangles, whose heights differ.
struct Sheet {
  std::uint32_t n = 3;
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Triangle> triangles;

  explicit Sheet(std::uint32_t squares) : n(squares) {
    const auto step = static_cast<float>(n);
    for (std::uint32_t i = 0; i <= n; ++i) {
      for (std::uint32_t j = 0; j <= n; ++j) {
        const auto x = static_cast<float>(j);
        const auto y = static_cast<float>(i);
        positions.emplace_back(x, y, 0.125F * static_cast<float>((i * j) % 5));
        uvs.emplace_back(x / step, y / step);
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const std::uint32_t k = i * (n + 1) + j;
        triangles.push_back({k, k + 1, k + n + 2});
        triangles.push_back({k, k + n + 2, k + n + 1});
      }
    }
  }
};

struct Compressed {
  std::string bytes;
  std::uint32_t position_id = 0;
  std::uint32_t uv_id = 0;
};

template <class V>
std::uint32_t add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type,
                            const std::vector<V>& values) {
  constexpr auto kComponents = static_cast<std::int8_t>(V::RowsAtCompileTime);
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, kComponents, draco::DT_FLOAT32, false, sizeof(V), 0);
  const auto count = static_cast<std::uint32_t>(values.size());
  const int id = mesh.AddAttribute(attribute, true, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  }
  return mesh.attribute(id)->unique_id();
}

/// Without loss unless `position_bits` are given.
Compressed compress(const Sheet& sheet, int position_bits = 0) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(sheet.positions.size()));
  for (const Triangle& t : sheet.triangles) {
    mesh.AddFace({{draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])}});
  }
  Compressed result;
  result.position_id = add_attribute(mesh, draco::GeometryAttribute::POSITION, sheet.positions);
  result.uv_id = add_attribute(mesh, draco::GeometryAttribute::TEX_COORD, sheet.uvs);
  draco::Encoder encoder;
  if (position_bits > 0) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, position_bits);
  }
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  result.bytes.assign(buffer.data(), buffer.size());
  return result;
}

constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// A glTF of one compressed mesh; its one buffer has no URI yet.
Json gltf_of(const Sheet& sheet, const Compressed& compressed) {
  const Json extension = {
      {"bufferView", 0},
      {"attributes", {{"POSITION", compressed.position_id}, {"TEXCOORD_0", compressed.uv_id}}}};
  const auto n = static_cast<float>(sheet.n);
  return {{"asset", {{"version", "2.0"}}},
          {"extensionsUsed", {kDraco}},
          {"extensionsRequired", {kDraco}},
          {"scenes", {{{"nodes", {0}}}}},
          {"scene", 0},
          {"nodes", {{{"mesh", 0}, {"translation", {10, 0, 0}}}}},
          {"meshes",
           {{{"primitives",
              {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}},
                {"indices", 2},
                {"extensions", {{kDraco, extension}}}}}}}}},
          {"accessors",
           {{{"componentType", 5126},
             {"count", sheet.positions.size()},
             {"type", "VEC3"},
             {"min", {0, 0, 0}},
             {"max", {n, n, 1}}},
            {{"componentType", 5126}, {"count", sheet.uvs.size()}, {"type", "VEC2"}},
            {{"componentType", 5125}, {"count", sheet.triangles.size() * 3}, {"type", "SCALAR"}}}},
          {"bufferViews", {{{"buffer", 0}, {"byteLength", compressed.bytes.size()}}}},
          {"buffers", {{{"byteLength", compressed.bytes.size()}}}}};
}

void append(std::string& bytes, std::uint32_t value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// RFC 4648, without padding.
std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : bytes) {
    bits = (bits << 8U) | static_cast<unsigned char>(c);
    for (count += 8; count >= 6; count -= 6) text += kDigits[(bits >> (count - 6)) & 63U];
  }
  if (count > 0) text += kDigits[(bits << (6 - count)) & 63U];
  return text;
}

std::string glb_of(const Json& json, std::string body) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  body.resize((body.size() + 3) / 4 * 4);
  std::string file = "glTF";
  append(file, 2);
  append(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + body.size()));
  append(file, static_cast<std::uint32_t>(text.size()));
  file += "JSON" + text;
  append(file, static_cast<std::uint32_t>(body.size()));
  file += std::string("BIN\0", 4) + body;
  return file;
}

/// The corners of every triangle, in any order: encoders exchange triangles and their corners.
std::vector<std::array<float, 3>> sorted_corners(
    const std::vector<Triangle>& triangles,
    const std::function<Eigen::Vector3f(std::uint32_t)>& position) {
  std::vector<std::array<float, 3>> all;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t corner : t) {
      const Eigen::Vector3f p = position(corner);
      all.push_back({p.x(), p.y(), p.z()});
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

void expect_is(const Model& model, const Sheet& sheet) {
  const auto expected = sorted_corners(sheet.triangles, [&](std::uint32_t i) {
    return Eigen::Vector3f(sheet.positions[i] + Eigen::Vector3f(10, 0, 0));
  });
  const auto found = sorted_corners(model.mesh.triangles, [&](std::uint32_t i) {
    return Eigen::Vector3f(vertex_m(model.mesh, i).cast<float>());
  });
  EXPECT_EQ(found, expected);
}

class GltfDraco : public ::testing::Test {
 protected:
  TestFolder temp_;
};

TEST_F(GltfDraco, MeshesWithFewAndManyVerticesAreRead) {
  // Assimp 5.2 itself fails for indices of 32 bits, with any number of vertices.
  for (const std::uint32_t squares : {3U, 300U}) {
    const Sheet sheet(squares);
    const Compressed compressed = compress(sheet);
    Json json = gltf_of(sheet, compressed);
    json["buffers"][0]["uri"] = "a%20b.bin";
    temp_.write("a b.bin", compressed.bytes);
    const Model model = testing::load(temp_.write("a.gltf", json.dump()));
    expect_is(model, sheet);
    EXPECT_EQ(model.format, "glTF2");
    EXPECT_EQ(model.files.size(), 2U);  // so that another buffer voids the cache
  }
}

TEST_F(GltfDraco, IndicesOf16BitsAreRead) {
  const Sheet sheet(20);
  const Compressed compressed = compress(sheet);
  Json json = gltf_of(sheet, compressed);
  json["accessors"][2]["componentType"] = 5123;
  EXPECT_NO_THROW(
      expect_is(testing::load(temp_.write("a.glb", glb_of(json, compressed.bytes))), sheet));
}

TEST_F(GltfDraco, BinaryFilesAndDataUrisAreRead) {
  const Sheet sheet(40);
  const Compressed compressed = compress(sheet);
  Json json = gltf_of(sheet, compressed);
  expect_is(testing::load(temp_.write("a.glb", glb_of(json, compressed.bytes))), sheet);
  const Sheet small(1);
  const Compressed few = compress(small);
  Json inline_json = gltf_of(small, few);
  inline_json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(few.bytes);
  expect_is(testing::load(temp_.write("b.gltf", inline_json.dump())), small);
}

TEST_F(GltfDraco, TextureCoordinatesBelongToTheirVertices) {
  const Sheet sheet(5);
  const Compressed compressed = compress(sheet);
  Json json = gltf_of(sheet, compressed);
  json["images"] = {{{"uri", "paint.ppm"}}};
  json["textures"] = {{{"source", 0}}};
  json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  json["meshes"][0]["primitives"][0]["material"] = 0;
  temp_.write("paint.ppm", testing::ppm(2, 2, "abc"));
  const Model model = testing::load(temp_.write("a.glb", glb_of(json, compressed.bytes)));
  ASSERT_EQ(model.mesh.uvs[0].size(), model.mesh.positions_m.size());
  for (std::uint32_t i = 0; i < model.mesh.positions_m.size(); ++i) {
    const Eigen::Vector3d p = vertex_m(model.mesh, i) - Eigen::Vector3d(10, 0, 0);
    const Eigen::Vector2f uv = model.mesh.uvs[0][i];  // v down in the file, up here
    EXPECT_FLOAT_EQ(uv.x(), static_cast<float>(p.x()) / 5.0F);
    EXPECT_FLOAT_EQ(1.0F - uv.y(), static_cast<float>(p.y()) / 5.0F);
  }
}

TEST_F(GltfDraco, QuantizedPositionsAreWithinHalfAStep) {
  const Sheet sheet(30);
  constexpr int kBits = 11;
  const Compressed compressed = compress(sheet, kBits);
  const Model model =
      testing::load(temp_.write("a.glb", glb_of(gltf_of(sheet, compressed), compressed.bytes)));
  const double step = 30.0 / ((1 << kBits) - 1);
  ASSERT_EQ(model.mesh.triangles.size(), sheet.triangles.size());
  for (std::uint32_t i = 0; i < model.mesh.positions_m.size(); ++i) {
    const Eigen::Vector3d p = vertex_m(model.mesh, i);
    EXPECT_NEAR(p.x(), std::round(p.x()), 0.51 * step);
    EXPECT_NEAR(p.y(), std::round(p.y()), 0.51 * step);
  }
}

TEST_F(GltfDraco, AChangedBufferInvalidatesTheCache) {
  ModelOptions options;
  options.cache_folder = temp_ / "cache";
  const auto write = [&](const Sheet& sheet) {
    const Compressed compressed = compress(sheet);
    Json json = gltf_of(sheet, compressed);
    json["buffers"][0]["uri"] = "a.bin";
    temp_.write("a.bin", compressed.bytes);
    return temp_.write("a.gltf", json.dump());
  };
  const auto model = write(Sheet(3));
  testing::load(model, options);
  EXPECT_TRUE(testing::load(model, options).from_cache);
  write(Sheet(4));
  const Model changed = testing::load(model, options);
  EXPECT_FALSE(changed.from_cache);
  EXPECT_EQ(changed.mesh.triangles.size(), 32U);
}

TEST_F(GltfDraco, DamagedDataIsAnErrorThatNamesTheExtension) {
  const Sheet sheet(20);
  Compressed compressed = compress(sheet);
  const Json json = gltf_of(sheet, compressed);
  std::string cut = compressed.bytes;
  std::fill(cut.begin() + 40, cut.end(), '\x7f');
  for (const std::string& body : {cut, std::string(compressed.bytes.size(), 'x')}) {
    EXPECT_THAT(testing::load_error(temp_.write("a.glb", glb_of(json, body)).string()),
                AllOf(HasSubstr("its Draco data (KHR_draco_mesh_compression) cannot be decoded"),
                      HasSubstr("the file is damaged")));
  }
  EXPECT_THAT(testing::load_error(temp_.write("a.glb", glb_of(json, "")).string()),
              HasSubstr("buffers[0].byteLength"));
}

TEST_F(GltfDraco, ABufferOutsideTheModelsFolderIsNotRead) {
  const Sheet sheet(3);
  const Compressed compressed = compress(sheet);
  Json json = gltf_of(sheet, compressed);
  json["buffers"][0]["uri"] = "../a.bin";
  temp_.write("a.bin", compressed.bytes);
  EXPECT_THAT(testing::load_error(temp_.write("model/a.gltf", json.dump()).string()),
              AllOf(HasSubstr("'../a.bin'"), HasSubstr("outside the model's folder")));
}

/// Appends compressed data to the file's bytes, as a view instead of `decoded` bytes.
std::size_t add_compressed(Json& json, std::string& bytes, const std::vector<unsigned char>& data,
                           const Json& extension) {
  const std::size_t size =
      extension.at("count").get<std::size_t>() * extension.at("byteStride").get<std::size_t>();
  Json named = extension;
  named["buffer"] = 0;
  named["byteOffset"] = bytes.size();
  named["byteLength"] = data.size();
  json["bufferViews"].push_back(
      {{"buffer", 1}, {"byteLength", size}, {"extensions", {{"EXT_meshopt_compression", named}}}});
  bytes.append(data.begin(), data.end());
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return json["bufferViews"].size() - 1;
}

/// The same squares with positions and indices as meshoptimizer's own encoders write them.
Json meshopt_of(const Sheet& sheet, const std::string& mode, std::string& bytes) {
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : sheet.triangles) corners.insert(corners.end(), t.begin(), t.end());
  const std::size_t vertices = sheet.positions.size();
  std::vector<unsigned char> positions(meshopt_encodeVertexBufferBound(vertices, 12));
  positions.resize(meshopt_encodeVertexBuffer(positions.data(), positions.size(),
                                              sheet.positions.data(), vertices, 12));
  const bool is_triangles = mode == "TRIANGLES";
  std::vector<unsigned char> indices(
      is_triangles ? meshopt_encodeIndexBufferBound(corners.size(), vertices)
                   : meshopt_encodeIndexSequenceBound(corners.size(), vertices));
  indices.resize(is_triangles ? meshopt_encodeIndexBuffer(indices.data(), indices.size(),
                                                          corners.data(), corners.size())
                              : meshopt_encodeIndexSequence(indices.data(), indices.size(),
                                                            corners.data(), corners.size()));
  Json json = {
      {"asset", {{"version", "2.0"}}},
      {"extensionsUsed", {"EXT_meshopt_compression"}},
      {"extensionsRequired", {"EXT_meshopt_compression"}},
      {"nodes", {{{"mesh", 0}, {"translation", {10, 0, 0}}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
        {{"bufferView", 1},
         {"componentType", 5125},
         {"count", corners.size()},
         {"type", "SCALAR"}}}},
      {"bufferViews", Json::array()}};
  add_compressed(json, bytes, positions,
                 {{"mode", "ATTRIBUTES"}, {"count", vertices}, {"byteStride", 12}});
  add_compressed(json, bytes, indices,
                 {{"mode", mode}, {"count", corners.size()}, {"byteStride", 4}});
  json["buffers"] = {{{"byteLength", bytes.size()}},
                     {{"byteLength", vertices * 12 + corners.size() * 4},
                      {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  return json;
}

TEST(GltfExtensions, MeshoptCompressionIsRead) {
  const TestFolder temp;
  const Sheet sheet(40);
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    std::string bytes;
    const Json json = meshopt_of(sheet, mode, bytes);
    expect_is(testing::load(temp.write("a.glb", glb_of(json, bytes))), sheet);
  }
}

TEST(GltfExtensions, ExponentialNumbersOfMeshoptAreRead) {
  const TestFolder temp;
  // Sixteenths: mantissa times 2^-4.
  const Sheet sheet(3);
  std::string bytes;
  Json json = meshopt_of(sheet, "INDICES", bytes);
  std::vector<std::int32_t> words;
  for (const Eigen::Vector3f& p : sheet.positions) {
    for (const float x : p) {
      const auto mantissa = static_cast<std::int32_t>(x * 16.0F) & 0xFF'FFFF;
      words.push_back(static_cast<std::int32_t>(0xFC00'0000U) | mantissa);
    }
  }
  std::vector<unsigned char> data(meshopt_encodeVertexBufferBound(sheet.positions.size(), 12));
  data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), words.data(),
                                         sheet.positions.size(), 12));
  json["accessors"][0]["bufferView"] = add_compressed(json, bytes, data,
                                                      {{"mode", "ATTRIBUTES"},
                                                       {"count", sheet.positions.size()},
                                                       {"byteStride", 12},
                                                       {"filter", "EXPONENTIAL"}});
  json["buffers"][0]["byteLength"] = bytes.size();
  expect_is(testing::load(temp.write("a.glb", glb_of(json, bytes))), sheet);
}

TEST(GltfExtensions, DamagedMeshoptDataIsRefusedWithItsPath) {
  const TestFolder temp;
  const Sheet sheet(3);
  const auto error = [&](const std::string& key, const Json& value) {
    std::string bytes;
    Json json = meshopt_of(sheet, "TRIANGLES", bytes);
    json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    return testing::load_error(temp.write("a.glb", glb_of(json, bytes)).string());
  };
  const std::string path = "bufferViews[0].extensions.EXT_meshopt_compression";
  EXPECT_THAT(error("byteLength", 5), HasSubstr(path));
  EXPECT_THAT(error("count", 1'000'000'000), HasSubstr(path + ".count: 1000000000 elements, more"));
  EXPECT_THAT(error("byteStride", 10), HasSubstr(path + ".byteStride: 10 bytes"));
  EXPECT_THAT(error("mode", "SPHERES"), HasSubstr(path + ".mode: 'SPHERES'"));
  EXPECT_THAT(error("filter", "QUATERNION"), HasSubstr(path + ".filter: 'QUATERNION' with"));
}

constexpr const char* kKtx2 = "\xABKTX 20\xBB\r\n\x1A\n and more";

TEST(GltfExtensions, KtxTexturesAreReportedByTheirExtension) {
  const TestFolder temp;
  temp.write("paint.ktx2", kKtx2);
  temp.write("paint.ppm", testing::ppm(1, 1, "abc"));
  Json json = Json::parse(testing::gltf(
      R"([{"mesh":0}])", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})"));
  json["images"] = {{{"uri", "paint.ktx2"}, {"mimeType", "image/ktx2"}}, {{"uri", "paint.ppm"}}};
  json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  json["extensionsUsed"] = {"KHR_texture_basisu"};
  json["extensionsRequired"] = {"KHR_texture_basisu"};
  const Model model = testing::load(temp.write("a.gltf", json.dump()));
  EXPECT_EQ(model.mesh.triangles.size(), 1U);
  ASSERT_EQ(model.missing_textures.size(), 1U);
  EXPECT_EQ(model.missing_textures[0].name, "paint.ktx2");
  EXPECT_THAT(model.missing_textures[0].reason,
              AllOf(HasSubstr("KTX2"), HasSubstr("KHR_texture_basisu"), HasSubstr("PNG or JPEG")));
  // With another image beside it, that one is used.
  json["textures"][0]["source"] = 1;
  json.erase("extensionsRequired");
  const Model painted = testing::load(temp.write("a.gltf", json.dump()));
  EXPECT_TRUE(painted.missing_textures.empty());
  ASSERT_EQ(painted.textures.size(), 1U);
  EXPECT_EQ(painted.textures[0].texels.at(0), 'a');
}

TEST(GltfExtensions, AKtxImageInsideABinaryFileIsReportedToo) {
  const TestFolder temp;
  const std::string image(kKtx2);
  Json json = Json::parse(testing::gltf(
      R"([{"mesh":0}])", R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})"));
  const Json first = {{"byteLength", image.size()}};
  json["buffers"].insert(json["buffers"].begin(), first);
  for (Json& view : json["bufferViews"]) view["buffer"] = 1;
  json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", image.size()}});
  json["images"] = {{{"bufferView", 2}, {"mimeType", "image/ktx2"}}};
  json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  json["extensionsUsed"] = {"KHR_texture_basisu"};
  json["extensionsRequired"] = {"KHR_texture_basisu"};
  const Model model = testing::load(temp.write("a.glb", glb_of(json, image)));
  ASSERT_EQ(model.missing_textures.size(), 1U);
  EXPECT_THAT(model.missing_textures[0].reason, HasSubstr("KHR_texture_basisu"));
}

}  // namespace
}  // namespace glidar
