// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mtl_options.hpp>

#include <assimp/material.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

namespace glidar::import {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Up to two numbers at the stream's position; a third is for 3D textures and is skipped.
/// What is no number stays in the stream.
void read_pair(std::istringstream& words, Eigen::Vector2f& pair) {
  for (int i = 0; i < 3; ++i) {
    const auto before = words.tellg();
    std::string word;
    words >> word;
    char* end = nullptr;
    const float value = std::strtof(word.c_str(), &end);
    if (word.empty() || *end != '\0') {
      words.clear();
      words.seekg(before);
      return;
    }
    if (i < 2) pair[i] = value;
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

void read_line(const std::string& line, std::string& material, MtlOptions& options) {
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  keyword = lower(keyword);
  if (keyword == "newmtl") {
    std::getline(words >> std::ws, material);
    while (!material.empty() && std::isspace(static_cast<unsigned char>(material.back())) != 0) {
      material.pop_back();
    }
  }
  if (!names_map(keyword)) return;
  MtlTexture texture{material, keyword, Eigen::Vector2f::Ones(), Eigen::Vector2f::Zero()};
  bool given = false;
  for (std::string word; words >> word;) {
    if (word != "-s" && word != "-o") continue;
    read_pair(words, word == "-s" ? texture.scale : texture.offset);
    given = true;
  }
  if (given && texture.scale.allFinite() && texture.offset.allFinite()) {
    options.textures.push_back(std::move(texture));
  }
}

}  // namespace

void MtlOptions::refine(const std::string& material, unsigned type, NamedTexture& texture) const {
  for (const std::string_view keyword : keywords_of(type)) {
    for (const MtlTexture& line : textures) {
      if (line.material != material || line.map != keyword) continue;
      texture.use.uv_scale_rotate = line.scale.asDiagonal();
      texture.use.uv_offset = line.offset;
    }
  }
}

MtlOptions read_mtl_options(const std::vector<std::string>& files) {
  MtlOptions options;
  for (const std::string& path : files) {
    if (!lower(path).ends_with(".mtl")) continue;
    std::ifstream file(path);
    std::string material;
    for (std::string line; std::getline(file, line);) read_line(line, material, options);
  }
  return options;
}

}  // namespace glidar::import
