// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/texture_store.hpp>

#include <import/decode_image.hpp>
#include <import/gltf/data_uri.hpp>

#include <glidar/io/model/height_map.hpp>

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace glidar::import {
namespace {

/// Larger files cannot become a texture and are not read.
bool is_too_large(const std::string& path) {
  constexpr std::uintmax_t kMaxTexture_bytes = std::uintmax_t{256} << 20U;
  std::error_code error;
  return std::filesystem::file_size(path, error) > kMaxTexture_bytes || error;
}

Decoded decode_file(ModelFiles& files, const std::string& path, std::uint64_t budget) {
  const auto content = files.content(path);
  if (content == nullptr) return {{}, "cannot be opened"};
  const std::string_view bytes = content->whole();
  return decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, budget);
}

constexpr std::size_t kMaxNameLength = 1024;  // for messages and lists

}  // namespace

TextureStore::TextureStore(SourceModel& source, ModelFolder folder, ModelFiles& files,
                           ImportedModel& imported)
    : source_(source), search_(std::move(folder)), files_(files), imported_(imported) {}

std::int32_t TextureStore::keep(Texture texture) {
  budget_ -= texture.texels.size();
  imported_.model.textures.push_back(std::move(texture));
  return static_cast<std::int32_t>(imported_.model.textures.size() - 1);
}

std::int32_t TextureStore::decode(const std::string& name) {
  Decoded decoded;
  std::string file;
  if (const auto image = source_.images.find(name); image != source_.images.end()) {
    decoded = decode_embedded(std::move(image->second), budget_);
  } else if (gltf::is_data_uri(name)) {
    decoded = decode_data_uri(name, budget_);
  } else {
    TextureLookup lookup = search_.find(name);
    file = lookup.found;
    decoded.reason = lookup.reason;
    imported_.lookups.push_back(std::move(lookup));
    // Material files have comments after names.
    const std::size_t comment = name.find(" #");
    if (file.empty() && comment != std::string::npos) return decode(name.substr(0, comment));
    if (const auto known = by_file_.find(file); known != by_file_.end()) return known->second;
    if (!file.empty() && is_too_large(file)) {
      decoded.reason = "too large: the file has more than 256 MiB";
      add_once(imported_.absent, file);
    } else if (!file.empty()) {
      decoded = decode_file(files_, file, budget_);
      files_.release(file);
    }
  }
  if (!decoded.reason.empty()) {
    imported_.model.missing_textures.push_back({name.substr(0, kMaxNameLength), decoded.reason});
    return TextureUse::kNone;
  }
  decoded.texture.name = name.substr(0, kMaxNameLength);
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
