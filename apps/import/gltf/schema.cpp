// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/schema.hpp>

#include <import/source_model.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

namespace glidar::import::gltf {
namespace {

/// A member of an object, and the type of it or of its elements; empty: no objects inside.
struct Member {
  std::string_view type;
  std::string_view name;
  std::string_view member_type;
};

// The objects of glTF 2.0, chapter 5, and of the extensions that are used.
constexpr std::array kMembers = std::to_array<Member>({
    {"glTF", "accessors", "accessor"},
    {"glTF", "animations", ""},
    {"glTF", "asset", "asset"},
    {"glTF", "buffers", "buffer"},
    {"glTF", "bufferViews", "bufferView"},
    {"glTF", "cameras", ""},
    {"glTF", "extensionsRequired", ""},
    {"glTF", "extensionsUsed", ""},
    {"glTF", "images", "image"},
    {"glTF", "materials", "material"},
    {"glTF", "meshes", "mesh"},
    {"glTF", "nodes", "node"},
    {"glTF", "samplers", "sampler"},
    {"glTF", "scene", ""},
    {"glTF", "scenes", "scene"},
    {"glTF", "skins", "skin"},
    {"glTF", "textures", "texture"},
    {"asset", "copyright", ""},
    {"asset", "generator", ""},
    {"asset", "minVersion", ""},
    {"asset", "version", ""},
    {"accessor", "bufferView", ""},
    {"accessor", "byteOffset", ""},
    {"accessor", "componentType", ""},
    {"accessor", "count", ""},
    {"accessor", "max", ""},
    {"accessor", "min", ""},
    {"accessor", "normalized", ""},
    {"accessor", "sparse", "sparse"},
    {"accessor", "type", ""},
    {"sparse", "count", ""},
    {"sparse", "indices", "sparse.indices"},
    {"sparse", "values", "sparse.values"},
    {"sparse.indices", "bufferView", ""},
    {"sparse.indices", "byteOffset", ""},
    {"sparse.indices", "componentType", ""},
    {"sparse.values", "bufferView", ""},
    {"sparse.values", "byteOffset", ""},
    {"buffer", "byteLength", ""},
    {"buffer", "uri", ""},
    {"buffer", "EXT_meshopt_compression", "meshopt buffer"},
    {"meshopt buffer", "fallback", ""},
    {"bufferView", "buffer", ""},
    {"bufferView", "byteLength", ""},
    {"bufferView", "byteOffset", ""},
    {"bufferView", "byteStride", ""},
    {"bufferView", "target", ""},
    {"bufferView", "EXT_meshopt_compression", "meshopt"},
    {"meshopt", "buffer", ""},
    {"meshopt", "byteLength", ""},
    {"meshopt", "byteOffset", ""},
    {"meshopt", "byteStride", ""},
    {"meshopt", "count", ""},
    {"meshopt", "filter", ""},
    {"meshopt", "mode", ""},
    {"image", "bufferView", ""},
    {"image", "mimeType", ""},
    {"image", "uri", ""},
    {"material", "alphaCutoff", ""},
    {"material", "alphaMode", ""},
    {"material", "doubleSided", ""},
    {"material", "emissiveFactor", ""},
    {"material", "emissiveTexture", "textureInfo"},
    {"material", "normalTexture", "textureInfo"},
    {"material", "occlusionTexture", "textureInfo"},
    {"material", "pbrMetallicRoughness", "metallic"},
    {"material", "KHR_materials_emissive_strength", "emissive"},
    {"material", "KHR_materials_ior", "ior"},
    {"material", "KHR_materials_pbrSpecularGlossiness", "glossiness"},
    {"material", "KHR_materials_specular", "specular"},
    {"material", "KHR_materials_unlit", "unlit"},
    {"metallic", "baseColorFactor", ""},
    {"metallic", "baseColorTexture", "textureInfo"},
    {"metallic", "metallicFactor", ""},
    {"metallic", "metallicRoughnessTexture", "textureInfo"},
    {"metallic", "roughnessFactor", ""},
    {"emissive", "emissiveStrength", ""},
    {"ior", "ior", ""},
    {"glossiness", "diffuseFactor", ""},
    {"glossiness", "diffuseTexture", "textureInfo"},
    {"glossiness", "glossinessFactor", ""},
    {"glossiness", "specularFactor", ""},
    {"glossiness", "specularGlossinessTexture", "textureInfo"},
    {"specular", "specularColorFactor", ""},
    {"specular", "specularColorTexture", "textureInfo"},
    {"specular", "specularFactor", ""},
    {"specular", "specularTexture", "textureInfo"},
    {"textureInfo", "index", ""},
    {"textureInfo", "scale", ""},
    {"textureInfo", "strength", ""},
    {"textureInfo", "texCoord", ""},
    {"textureInfo", "KHR_texture_transform", "transform"},
    {"transform", "offset", ""},
    {"transform", "rotation", ""},
    {"transform", "scale", ""},
    {"transform", "texCoord", ""},
    {"mesh", "primitives", "primitive"},
    {"mesh", "weights", ""},
    {"primitive", "attributes", ""},
    {"primitive", "indices", ""},
    {"primitive", "material", ""},
    {"primitive", "mode", ""},
    {"primitive", "targets", ""},
    {"primitive", "KHR_draco_mesh_compression", "draco"},
    {"draco", "attributes", ""},
    {"draco", "bufferView", ""},
    {"node", "camera", ""},
    {"node", "children", ""},
    {"node", "matrix", ""},
    {"node", "mesh", ""},
    {"node", "rotation", ""},
    {"node", "scale", ""},
    {"node", "skin", ""},
    {"node", "translation", ""},
    {"node", "weights", ""},
    {"node", "EXT_mesh_gpu_instancing", "instancing"},
    {"node", "KHR_node_visibility", "visibility"},
    {"instancing", "attributes", ""},
    {"visibility", "visible", ""},
    {"sampler", "magFilter", ""},
    {"sampler", "minFilter", ""},
    {"sampler", "wrapS", ""},
    {"sampler", "wrapT", ""},
    {"scene", "nodes", ""},
    {"skin", "inverseBindMatrices", ""},
    {"skin", "joints", ""},
    {"skin", "skeleton", ""},
    {"texture", "sampler", ""},
    {"texture", "source", ""},
    {"texture", "EXT_texture_webp", "image source"},
    {"texture", "KHR_texture_basisu", "image source"},
    {"image source", "source", ""},
});

// Required extensions without an effect on the shape: a note names them.
constexpr std::array<std::string_view, 18> kNoted = {"KHR_animation_pointer",
                                                     "KHR_lights_punctual",
                                                     "KHR_materials_anisotropy",
                                                     "KHR_materials_clearcoat",
                                                     "KHR_materials_diffuse_transmission",
                                                     "KHR_materials_dispersion",
                                                     "KHR_materials_iridescence",
                                                     "KHR_materials_sheen",
                                                     "KHR_materials_transmission",
                                                     "KHR_materials_variants",
                                                     "KHR_materials_volume",
                                                     "KHR_techniques_webgl",
                                                     "KHR_xmp_json_ld",
                                                     "EXT_lights_ies",
                                                     "EXT_lights_image_based",
                                                     "EXT_mesh_features",
                                                     "EXT_structural_metadata",
                                                     "EXT_instance_features"};

bool is_used(std::string_view extension) {
  return extension == "KHR_mesh_quantization" ||
         std::any_of(kMembers.begin(), kMembers.end(),
                     [&](const Member& member) { return member.name == extension; });
}

const Member* member_of(std::string_view type, std::string_view name) {
  const auto* const found = std::find_if(
      kMembers.begin(), kMembers.end(),
      [&](const Member& member) { return member.type == type && member.name == name; });
  return found == kMembers.end() ? nullptr : found;
}

/// Things of one kind that are not used.
struct Unused {
  std::string first_path;
  std::uint64_t count = 0;
};

/// Collects what is not used, by its kind: an extension, or a member of a type of objects.
class Search {
 public:
  void object(const Json& json, std::string_view type, const std::string& path) {
    if (!json.is_object()) return;  // an error, which the reader of this value reports
    for (const auto& [name, value] : json.items()) {
      if (name == "name" || name == "extras") continue;
      if (name == "extensions") {
        extensions(value, type, path);
        continue;
      }
      const Member* member = member_of(type, name);
      const std::string at = path.empty() ? name : fmt::format("{}.{}", path, name);
      if (member == nullptr) {
        add(members, std::string(type) + "." + name, at);
      } else if (!member->member_type.empty()) {
        inside(value, member->member_type, at);
      }
    }
  }

  std::map<std::string, Unused> unused_extensions;
  std::map<std::string, Unused> members;

 private:
  static void add(std::map<std::string, Unused>& to, const std::string& kind,
                  const std::string& path) {
    Unused& unused = to[kind];
    if (unused.count++ == 0) unused.first_path = path;
  }

  // The depth of recursion is that of the table of members.
  void inside(const Json& value, std::string_view type, const std::string& path) {
    if (!value.is_array()) return object(value, type, path);
    std::size_t i = 0;
    for (const Json& element : value) object(element, type, fmt::format("{}[{}]", path, i++));
  }

  void extensions(const Json& all, std::string_view type, const std::string& path) {
    if (!all.is_object()) return;
    for (const auto& [name, value] : all.items()) {
      const Member* member = member_of(type, name);
      if (member == nullptr) {
        add(unused_extensions, name, path.empty() ? "the document" : path);
      } else {
        inside(value, member->member_type, fmt::format("{}.extensions.{}", path, name));
      }
    }
  }
};

std::string places(const Unused& unused) {
  if (unused.count < 2) return unused.first_path;
  return fmt::format("{} and {} more", unused.first_path, unused.count - 1);
}

void note_extensions(const Search& found, Document& document) {
  std::map<std::string, Unused> all = found.unused_extensions;
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const Value listed = document.root()[list];
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const std::string name = listed.at(i).text();
      if (!is_used(name)) all.try_emplace(name);
    }
  }
  for (const auto& [name, unused] : all) {
    const std::string where = unused.count == 0 ? "" : " (" + places(unused) + ")";
    document.notes.add(fmt::format("the extension {} is left out{}", name.substr(0, 80), where));
  }
}

void note_list(Document& document, const char* list, const char* note) {
  const std::size_t count = document.root()[list].size();
  if (count > 0) document.notes.add(fmt::format("{} {}", count, note));
}

}  // namespace

void check_extensions(const Document& document) {
  const Value required = document.root()["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string name = required.at(i).text();
    const bool is_known =
        is_used(name) || std::find(kNoted.begin(), kNoted.end(), name) != kNoted.end();
    if (is_known) continue;
    refuse(required.at(i).path(),
           "it requires the extension " + in_quotes(name) + ", which GLIDAR does not read",
           "export it without that extension");
  }
}

void note_unused(Document& document) {
  Search search;
  search.object(document.json, "glTF", "");
  note_extensions(search, document);
  for (const auto& [kind, unused] : search.members) {
    document.notes.add(
        fmt::format("{} is not part of glTF 2.0: left out", places(unused).substr(0, 160)));
  }
  note_list(document, "animations", "animations are left out: the model is in its initial pose");
  note_list(document, "cameras", "cameras are left out");
}

}  // namespace glidar::import::gltf
