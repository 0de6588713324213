// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf_draco.hpp>

#include <import/source_model.hpp>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

namespace glidar::import {
namespace {

using Json = nlohmann::json;

// Component types of glTF 2.0, section 3.6.2.2.
constexpr int kByte = 5120;
constexpr int kUnsignedByte = 5121;
constexpr int kShort = 5122;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kTriangles = 4;

[[noreturn]] void refuse(const std::string& found) {
  throw Refusal{fmt::format("its Draco data ({}) cannot be decoded: {}", kDracoExtension, found),
                "the file is damaged: export it again"};
}

std::uint8_t component_count(const std::string& type) {
  constexpr std::array<std::pair<const char*, std::uint8_t>, 7> kTypes = {{{"SCALAR", 1},
                                                                           {"VEC2", 2},
                                                                           {"VEC3", 3},
                                                                           {"VEC4", 4},
                                                                           {"MAT2", 4},
                                                                           {"MAT3", 9},
                                                                           {"MAT4", 16}}};
  for (const auto& [name, count] : kTypes) {
    if (type == name) return count;
  }
  refuse("an accessor of the unknown type '" + type.substr(0, 20) + "'");
}

/// The values of an attribute, one row per point, as bytes.
template <class T>
std::string rows_of(const draco::PointCloud& mesh, const draco::PointAttribute& attribute,
                    std::uint8_t components) {
  std::vector<T> values(std::size_t{mesh.num_points()} * components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                              static_cast<std::int8_t>(components),
                              values.data() + std::size_t{i} * components);
  }
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string rows_of(const draco::PointCloud& mesh, const draco::PointAttribute& attribute,
                    const Json& accessor) {
  const std::uint8_t components = component_count(accessor.at("type").get<std::string>());
  switch (accessor.at("componentType").get<int>()) {
    case kByte:
      return rows_of<std::int8_t>(mesh, attribute, components);
    case kUnsignedByte:
      return rows_of<std::uint8_t>(mesh, attribute, components);
    case kShort:
      return rows_of<std::int16_t>(mesh, attribute, components);
    case kUnsignedShort:
      return rows_of<std::uint16_t>(mesh, attribute, components);
    case kUnsignedInt:
      return rows_of<std::uint32_t>(mesh, attribute, components);
    case kFloat:
      return rows_of<float>(mesh, attribute, components);
    default:
      refuse("an accessor of an unknown component type");
  }
}

std::string corners_of(const draco::Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  corners.reserve(std::size_t{mesh.num_faces()} * 3);
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
    for (const draco::PointIndex& corner : mesh.face(face)) corners.push_back(corner.value());
  }
  return {reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof(std::uint32_t)};
}

/// Appends decoded data to one buffer, with bufferViews and accessors.
class DecodedBuffer {
 public:
  explicit DecodedBuffer(Json& gltf) : gltf_(gltf), index_(gltf.at("buffers").size()) {}

  /// The index of a new accessor like this one.
  std::size_t add(const std::string& bytes, std::size_t count, Json accessor) {
    gltf_["bufferViews"].push_back(
        {{"buffer", index_}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    accessor.erase("sparse");
    accessor["bufferView"] = gltf_["bufferViews"].size() - 1;
    accessor["byteOffset"] = 0;
    accessor["count"] = count;
    gltf_["accessors"].push_back(std::move(accessor));
    return gltf_["accessors"].size() - 1;
  }

  std::string finish() {
    if (!bytes_.empty()) gltf_["buffers"].push_back({{"byteLength", bytes_.size()}});
    return std::move(bytes_);
  }

 private:
  Json& gltf_;
  std::size_t index_;
  std::string bytes_;
};

std::string_view view_of(const Json& gltf, std::size_t index, const GltfBuffers& buffers) {
  const Json& view = gltf.at("bufferViews").at(index);
  const std::string_view buffer = buffers(view.at("buffer").get<std::size_t>());
  const std::size_t offset = view.value("byteOffset", std::size_t{0});
  const auto size = view.at("byteLength").get<std::size_t>();
  if (offset > buffer.size() || size > buffer.size() - offset) refuse("its buffer is too short");
  return buffer.substr(offset, size);
}

std::unique_ptr<draco::Mesh> decoded(std::string_view bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) refuse(mesh.status().error_msg_string());
  return std::move(mesh).value();
}

void decode(Json& gltf, Json& primitive, const GltfBuffers& buffers, DecodedBuffer& to) {
  const Json extension = primitive.at("extensions").at(kDracoExtension);
  const auto view = extension.at("bufferView").get<std::size_t>();
  const std::unique_ptr<draco::Mesh> mesh = decoded(view_of(gltf, view, buffers));
  for (const auto& [name, id] : extension.at("attributes").items()) {
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id.get<std::uint32_t>());
    if (attribute == nullptr) refuse("attribute '" + name.substr(0, 40) + "' is missing");
    Json& used = primitive.at("attributes").at(name);
    const Json accessor = gltf.at("accessors").at(used.get<std::size_t>());
    used = to.add(rows_of(*mesh, *attribute, accessor), mesh->num_points(), accessor);
  }
  primitive["indices"] = to.add(corners_of(*mesh), std::size_t{mesh->num_faces()} * 3,
                                {{"componentType", kUnsignedInt}, {"type", "SCALAR"}});
  primitive["mode"] = kTriangles;
  primitive["extensions"].erase(kDracoExtension);
}

}  // namespace

std::string decode_draco(Json& gltf, const GltfBuffers& buffers) {
  if (!gltf.contains("meshes") || !gltf.contains("buffers")) return "";
  DecodedBuffer to(gltf);
  for (Json& mesh : gltf.at("meshes")) {
    for (Json& primitive : mesh.at("primitives")) {
      const auto extensions = primitive.find("extensions");
      const bool is_compressed =
          extensions != primitive.end() && extensions->contains(kDracoExtension);
      if (is_compressed) decode(gltf, primitive, buffers, to);
    }
  }
  return to.finish();
}

}  // namespace glidar::import
