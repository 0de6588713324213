// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/draco.hpp>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace glidar::import::gltf {
namespace {

[[noreturn]] void refuse_data(const Value& extension, const std::string& found) {
  refuse(extension.path(),
         "its Draco data (KHR_draco_mesh_compression) cannot be decoded: " + found,
         "the file is damaged: export it again");
}

/// The values of an attribute, one row per point, as bytes; empty if one does not fit.
template <class T>
std::string rows_of(const draco::PointCloud& mesh, const draco::PointAttribute& attribute,
                    std::size_t components) {
  std::vector<T> values(std::size_t{mesh.num_points()} * components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const bool fits = attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                                                static_cast<std::int8_t>(components),
                                                values.data() + std::size_t{i} * components);
    if (!fits) return {};
  }
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::unique_ptr<draco::Mesh> decompressed(const Value& extension, std::string_view bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) refuse_data(extension, mesh.status().error_msg_string());
  return std::move(mesh).value();
}

void note_size(Document& document, const Value& accessor, std::size_t found) {
  const std::size_t stated = accessor.required("count").count();
  if (stated == found) return;
  document.notes.add(
      fmt::format("{}.count: {} is stated, its Draco data has {}", accessor.path(), stated, found));
}

}  // namespace

DracoMesh decode_draco(Document& document, Buffers& buffers, const Value& primitive) {
  const Value extension = primitive.extension(kDracoExtension);
  const View view = buffers.view(extension.required("bufferView"));
  const std::unique_ptr<draco::Mesh> mesh = decompressed(extension, view.bytes);
  DracoMesh result;
  buffers.take(Budget::numbers, std::uint64_t{mesh->num_faces()} * 3, extension.path());
  for (const auto& [name, id] : extension.required("attributes").members()) {
    const auto unique = static_cast<std::uint32_t>(id.count());
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(unique);
    if (attribute == nullptr)
      refuse_data(extension, "attribute " + in_quotes(name) + " is missing");
    const Value index = primitive.required("attributes").required(name.c_str());
    const Value value = document.target("accessors", index);
    Accessor accessor = describe_accessor(value);
    note_size(document, value, mesh->num_points());
    buffers.take(Budget::numbers,
                 std::max<std::uint64_t>(accessor.count, mesh->num_points()) * accessor.components,
                 extension.path());
    std::string& bytes = result.bytes[name] = with_type(accessor.type, [&](auto zero) {
      return rows_of<decltype(zero)>(*mesh, *attribute, accessor.components);
    });
    accessor.count = mesh->num_points();
    accessor.stride = accessor.components * size_of(accessor.type);
    if (bytes.size() != accessor.count * accessor.stride) {
      refuse_data(extension, "values of " + in_quotes(name) + " do not fit their component type");
    }
    accessor.bytes = bytes;
    accessor.min.clear();
    accessor.max.clear();
    result.views.emplace(name, std::move(accessor));
  }
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face) {
    for (const draco::PointIndex& corner : mesh->face(face)) {
      result.corners.push_back(corner.value());
    }
  }
  if (primitive["indices"]) {
    note_size(document, document.target("accessors", primitive["indices"]), result.corners.size());
  }
  return result;
}

}  // namespace glidar::import::gltf
