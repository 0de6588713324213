// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/ply_header.hpp>

#include <glidar/core/text.hpp>
#include <import/source_model.hpp>

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace glidar::import {
namespace {

constexpr std::size_t kMaxHeader = std::size_t{1} << 20U;

bool is_ply(FileContent& file) {
  constexpr std::string_view kMark = "ply";
  const std::string_view head = file.head(kMark.size() + 1);
  return head.starts_with(kMark) && head.find_first_of("\r\n") == kMark.size();
}

}  // namespace

PlyHeader read_ply_header(FileContent& file) {
  constexpr std::string_view kTexture = "comment TextureFile ";
  if (!is_ply(file)) return {};
  PlyHeader header;
  std::string_view text = file.head(kMaxHeader);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (line == "end_header") return header;
    if (header.texture.empty() && line.starts_with(kTexture)) {
      header.texture = trimmed(line.substr(kTexture.size()));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (file.size() > kMaxHeader) return header;
  throw Refusal{"the header of the PLY file has no line 'end_header': the file ends too early",
                "the file is damaged; copy or export it again"};
}

void add_ply_texture(const PlyHeader& header, aiScene& scene) {
  if (header.texture.empty()) return;
  const aiString name(header.texture);
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    scene.mMaterials[i]->AddProperty(&name, AI_MATKEY_TEXTURE_DIFFUSE(0));
  }
}

}  // namespace glidar::import
