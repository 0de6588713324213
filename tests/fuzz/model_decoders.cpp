// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "model_decoders.hpp"

#include <import/own_readers.hpp>

#include <glidar/core/error.hpp>

#include <stdexcept>

namespace glidar::testing {
namespace {

namespace fs = std::filesystem;

/// What the steps after a reader rely on.
void check(const import::SourceModel& source) {
  for (const import::SourceMesh& mesh : source.meshes) {
    bool sound = mesh.material < source.materials.size();
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) sound = sound && v < mesh.positions.size();
    }
    for (const std::size_t size : {mesh.normals.size(), mesh.uvs[0].size(), mesh.colours.size()}) {
      sound = sound && (size == 0 || size == mesh.positions.size());
    }
    if (!sound) throw std::logic_error("a reader made a mesh with invalid indices");
  }
  import::require_triangles(source);
}

}  // namespace

void read_model_file(const fs::path& file) {
  const fs::path canonical = fs::canonical(file);
  const ModelFolder folder = model_folder(canonical);
  import::ModelFiles files(folder);
  import::FileLog log;
  const import::ReaderInput input{canonical, folder, files, log};
  if (files.content(canonical.string()) == nullptr)
    throw Error({.where = file.string(), .found = "cannot be opened"});
  try {
    check(import::own_reader(input)(input));
  } catch (const import::Refusal& refusal) {
    throw Error({.where = file.string(), .found = refusal.found, .remedy = refusal.remedy});
  }
}

}  // namespace glidar::testing
