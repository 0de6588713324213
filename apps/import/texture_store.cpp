// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/texture_store.hpp>

#include <import/decode_image.hpp>

#include <glidar/io/height_map.hpp>
#include <glidar/io/texture_search.hpp>

#include <assimp/scene.h>
#include <assimp/texture.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace glidar::import {
namespace {

/// The whole file, if it is no larger than what could become a texture.
std::vector<std::uint8_t> content(const std::string& path) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{256} << 20U;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::vector<std::uint8_t> bytes;
  if (error || size > kMostBytes) return bytes;
  bytes.resize(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

constexpr std::size_t kLongestName = 1024;  // of a missing texture, for the user's eyes

}  // namespace

TextureStore::TextureStore(const aiScene& scene, ModelFolder folder, FileLog& log,
                           ImportedModel& imported)
    : scene_(scene), folder_(std::move(folder)), log_(log), imported_(imported) {}

std::int32_t TextureStore::keep(Texture texture) {
  budget_ -= texture.texels.size();
  imported_.model.textures.push_back(std::move(texture));
  return static_cast<std::int32_t>(imported_.model.textures.size() - 1);
}

std::int32_t TextureStore::decode(const std::string& name) {
  Decoded decoded;
  std::string file;
  if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str())) {
    decoded = decode_embedded(*embedded, budget_);
  } else if (name.starts_with("data:")) {
    decoded = decode_data_uri(name, budget_);
  } else {
    TextureLookup lookup = find_texture(name, folder_);
    file = lookup.found;
    decoded.reason = lookup.reason;
    imported_.lookups.push_back(std::move(lookup));
    if (const auto known = by_file_.find(file); known != by_file_.end()) return known->second;
    if (!file.empty()) {
      add_once(log_.read, file);
      decoded = decode_image(content(file), budget_);
    }
  }
  if (!decoded.reason.empty()) {
    imported_.model.missing_textures.push_back({name.substr(0, kLongestName), decoded.reason});
    return TextureUse::kNone;
  }
  decoded.texture.name = name.substr(0, kLongestName);
  const std::int32_t index = keep(std::move(decoded.texture));
  if (!file.empty()) by_file_.emplace(file, index);
  return index;
}

std::int32_t TextureStore::colours(const std::string& name) {
  if (const auto known = by_name_.find(name); known != by_name_.end()) return known->second;
  return by_name_.emplace(name, decode(name)).first->second;
}

TextureStore::NormalMap TextureStore::normals(const std::string& name) {
  const std::int32_t image = colours(name);
  if (image == TextureUse::kNone) return {};
  if (const auto known = normals_.find(image); known != normals_.end()) return known->second;
  NormalMap map{image, 1.0F};
  const Texture& texture = imported_.model.textures[static_cast<std::size_t>(image)];
  const bool heights = !looks_like_normal_map(texture);
  const std::uint64_t bytes = std::uint64_t{texture.width} * texture.height * 3;
  if (heights && bytes > budget_) {
    imported_.model.missing_textures.push_back({texture.name, "no memory to convert its heights"});
    map.texture = TextureUse::kNone;
  } else if (heights) {
    HeightNormals converted = normals_from_heights(texture);
    map = {keep(std::move(converted.texture)), converted.normal_scale};
  }
  return normals_.emplace(image, map).first->second;
}

}  // namespace glidar::import
