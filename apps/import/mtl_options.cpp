// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mtl_options.hpp>

#include <glidar/core/text.hpp>

#include <assimp/material.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

namespace glidar::import {
namespace {

/// Removes and returns the first word of the text.
std::string next_word(std::string_view& text) {
  text = trimmed(text);
  std::string word(text.substr(0, text.find_first_of(kWhiteSpace)));
  text.remove_prefix(word.size());
  return word;
}

/// Removes and returns a number at the start of the text.
std::optional<float> next_number(std::string_view& text) {
  std::string_view rest = text;
  const std::string word = next_word(rest);
  char* end = nullptr;
  const float value = std::strtof(word.c_str(), &end);
  if (word.empty() || *end != '\0') return std::nullopt;
  text = rest;
  return value;
}

/// One to three numbers; the third is for 3D textures.
void next_pair(std::string_view& text, Eigen::Vector2f& pair) {
  for (int i = 0; i < 3; ++i) {
    const auto value = next_number(text);
    if (!value) return;
    if (i < 2) pair[i] = *value;
  }
}

/// Removes the values of an option from the text. False if it is not an option.
bool parse_option(const std::string& option, std::string_view& text, MtlTexture& texture) {
  constexpr std::array<std::string_view, 8> kOneWord = {
      "-blendu", "-blendv", "-cc", "-texres", "-boost", "-imfchan", "-type", "-colorspace"};
  Eigen::Vector2f unused;
  if (option == "-s") {
    next_pair(text, texture.scale);
  } else if (option == "-o") {
    next_pair(text, texture.offset);
  } else if (option == "-t" || option == "-mm") {
    next_pair(text, unused);
  } else if (option == "-bm") {
    texture.bump = next_number(text);
  } else if (option == "-clamp") {
    texture.clamp = next_word(text) == "on";
  } else if (std::find(kOneWord.begin(), kOneWord.end(), option) != kOneWord.end()) {
    next_word(text);
  } else {
    return false;
  }
  return true;
}

/// Options are before the name, in some files after it.
bool parse_options(std::string_view& text, MtlTexture& texture) {
  bool any = false;
  for (;;) {
    std::string_view rest = text;
    if (!parse_option(next_word(rest), rest, texture)) return any;
    text = rest;
    any = true;
  }
}

bool names_map(std::string_view keyword) {
  return keyword.starts_with("map_") || keyword == "bump" || keyword == "norm";
}

std::vector<std::string_view> keywords_of(unsigned type) {
  switch (type) {
    case aiTextureType_DIFFUSE:
      return {"map_kd"};
    case aiTextureType_SPECULAR:
      return {"map_ks"};
    case aiTextureType_OPACITY:
      return {"map_d"};
    case aiTextureType_HEIGHT:
      return {"map_bump", "bump"};
    case aiTextureType_NORMALS:
      return {"norm", "map_kn"};
    default:
      return {};
  }
}

void read_texture(std::string_view text, MtlTexture texture, MtlOptions& options) {
  bool any = parse_options(text, texture);
  text = trimmed(text);
  if (const std::size_t after = text.find(" -"); after != std::string_view::npos) {
    std::string_view tail = text.substr(after);
    if (parse_options(tail, texture)) {
      text = trimmed(text.substr(0, after));
      any = true;
    }
  }
  texture.name = text;
  if (any && !texture.name.empty() && texture.scale.allFinite() && texture.offset.allFinite()) {
    options.textures.push_back(std::move(texture));
  }
}

}  // namespace

void MtlOptions::refine(const std::string& material, unsigned type,
                        std::optional<NamedTexture>& texture) const {
  for (const std::string_view keyword : keywords_of(type)) {
    for (const MtlTexture& line : textures) {
      if (line.material != material || line.map != keyword) continue;
      if (!texture) texture.emplace();
      texture->name = line.name;
      texture->bump = line.bump;
      texture->use.uv_scale_rotate = line.scale.asDiagonal();
      texture->use.uv_offset = line.offset;
      if (line.clamp) texture->use.wrap_u = texture->use.wrap_v = Wrap::clamp;
    }
  }
}

MtlOptions read_mtl_options(ModelFiles& files) {
  MtlOptions options;
  for (const std::string& path : files.paths()) {
    if (!lower_case(path).ends_with(".mtl")) continue;
    const auto content = files.content(path);
    if (content == nullptr) continue;
    std::istringstream file{std::string(content->whole())};
    std::string material;
    for (std::string line; std::getline(file, line);) {
      std::string_view text = line;
      const std::string keyword = lower_case(next_word(text));
      if (keyword == "newmtl") material = trimmed(text);
      if (!names_map(keyword)) continue;
      MtlTexture texture;
      texture.material = material;
      texture.map = keyword;
      read_texture(text, std::move(texture), options);
    }
  }
  return options;
}

}  // namespace glidar::import
