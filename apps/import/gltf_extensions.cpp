// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf_extensions.hpp>

#include <import/decode_image.hpp>
#include <import/gltf_draco.hpp>
#include <import/gltf_file.hpp>
#include <import/source_model.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace glidar::import {
namespace {

using Json = nlohmann::json;

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
constexpr const char* kKtxExtension = "KHR_texture_basisu";
constexpr const char* kDecodedName = ".glidar-decoded-draco";  // name of a virtual file

bool is_gltf(const std::filesystem::path& model, FileContent& file) {
  const std::string extension = lower_case(model.extension().string());
  return extension == ".gltf" || extension == ".glb" || file.head(4) == "glTF";
}

bool lists(const Json& gltf, const char* list, const char* extension) {
  const auto found = gltf.find(list);
  return found != gltf.end() && found->is_array() &&
         std::find(found->begin(), found->end(), extension) != found->end();
}

void unlist(Json& gltf, const char* extension) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const auto found = gltf.find(list);
    if (found == gltf.end() || !found->is_array()) continue;
    found->erase(std::remove(found->begin(), found->end(), extension), found->end());
    if (found->empty()) gltf.erase(list);
  }
}

const Json* extension_of(const Json& object, const char* name) {
  const auto all = object.find("extensions");
  if (all == object.end() || !all->is_object()) return nullptr;
  const auto found = all->find(name);
  return found == all->end() ? nullptr : &*found;
}

/// A buffer that exists in its compressed form only (EXT_meshopt_compression, "fallback").
bool is_only_compressed(const Json& buffer) {
  const Json* extension = extension_of(buffer, kMeshoptExtension);
  return extension != nullptr && extension->value("fallback", false) && !buffer.contains("uri");
}

void refuse_meshopt(const Json& gltf) {
  bool is_needed = lists(gltf, "extensionsRequired", kMeshoptExtension);
  for (const Json& buffer : gltf.value("buffers", Json::array())) {
    is_needed = is_needed || is_only_compressed(buffer);
  }
  if (!is_needed) return;
  throw Refusal{std::string("its meshes are compressed by ") + kMeshoptExtension +
                    ", which GLIDAR does not read",
                "export it without that extension (gltfpack: without -c and -cc), or with " +
                    std::string(kDracoExtension)};
}

/// Returns whether a texture was changed.
bool show_ktx_images(Json& gltf) {
  if (!gltf.contains("textures")) return false;
  bool is_changed = false;
  for (Json& texture : gltf.at("textures")) {
    const Json* extension = extension_of(texture, kKtxExtension);
    if (extension == nullptr) continue;
    if (!texture.contains("source") && extension->contains("source")) {
      texture["source"] = Json(extension->at("source"));
    }
    texture["extensions"].erase(kKtxExtension);
    is_changed = true;
  }
  unlist(gltf, kKtxExtension);
  return is_changed;
}

/// Reads the buffers of a glTF file: its own chunk, data URIs, and files below the model's root.
class Buffers {
 public:
  Buffers(const Json& list, std::string_view file, const ModelFolder& folder, ModelFiles& files,
          FileLog& log)
      : list_(list), chunk_(gltf_binary_chunk(file)), folder_(folder), files_(files), log_(log) {}

  std::string_view operator()(std::size_t index) {
    const Json& buffer = list_.at(index);
    const auto uri = buffer.find("uri");
    if (uri == buffer.end()) return index == 0 ? chunk_ : std::string_view{};
    const std::string text = uri->get<std::string>();
    return text.starts_with("data:") ? decoded(index, text) : content(text);
  }

 private:
  std::string_view decoded(std::size_t index, const std::string& uri) {
    const auto [known, is_new] = decoded_.try_emplace(index);
    if (is_new) known->second = data_uri_bytes(uri);
    return {reinterpret_cast<const char*>(known->second.data()), known->second.size()};
  }

  std::string_view content(const std::string& uri) {
    for (const std::string& name : {uri, percent_decoded(uri)}) {
      const ConfinedFile found = confine(name, folder_);
      const auto file =
          found.access == Access::granted ? files_.content(found.path.string()) : nullptr;
      if (file != nullptr) return file->whole();
      add_once(log_.absent, (folder_.folder / name).string());
    }
    throw Refusal{"its buffer '" + uri.substr(0, 120) +
                      "' cannot be read: " + reason(confine(uri, folder_).access),
                  "copy it into the model's folder"};
  }

  Json list_;  // before buffers were added
  std::string_view chunk_;
  const ModelFolder& folder_;
  ModelFiles& files_;
  FileLog& log_;
  std::map<std::size_t, std::vector<std::uint8_t>> decoded_;
};

}  // namespace

void replace_gltf_extensions(const std::filesystem::path& canonical_model,
                             const ModelFolder& folder, ModelFiles& files, FileLog& log) {
  const auto own = files.content(canonical_model.string());
  if (own == nullptr || !is_gltf(canonical_model, *own)) return;
  const std::string_view file = own->whole();
  const std::string_view text = gltf_json(file);
  const auto names = [text](const char* extension) {
    return text.find(extension) != std::string_view::npos;
  };
  if (!names(kMeshoptExtension) && !names(kKtxExtension) && !names(kDracoExtension)) return;
  try {
    Json gltf = Json::parse(text);
    refuse_meshopt(gltf);
    bool is_changed = show_ktx_images(gltf);
    Buffers buffers(gltf.value("buffers", Json::array()), file, folder, files, log);
    std::string decoded = decode_draco(gltf, std::ref(buffers));
    if (!decoded.empty()) {
      gltf["buffers"].back()["uri"] = kDecodedName;
      unlist(gltf, kDracoExtension);
      files.replace((folder.folder / kDecodedName).string(), std::move(decoded));
      is_changed = true;
    }
    if (is_changed) files.replace(canonical_model.string(), with_json(file, gltf));
  } catch (const Json::exception&) {
    // Invalid: the importer reports the error.
  }
}

}  // namespace glidar::import
