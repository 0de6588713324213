// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "model_decoders.hpp"

#include "demand.hpp"

#include <import/decode_image.hpp>
#include <import/mend_model.hpp>
#include <import/mtl_reader.hpp>
#include <import/own_readers.hpp>
#include <import/zip_archive.hpp>

#include <glidar/core/error.hpp>

#include <pugixml.hpp>

#include <fstream>
#include <iterator>
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

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

[[noreturn]] void refuse(const fs::path& file, const std::string& found,
                         const std::string& remedy = "") {
  throw Error({.where = file.string(), .found = found, .remedy = remedy});
}

}  // namespace

void read_model_file(const fs::path& file) {
  const fs::path canonical = fs::canonical(file);
  const ModelFolder folder = model_folder(canonical);
  import::ModelFiles files(folder);
  import::FileLog log;
  const import::ReaderInput input{canonical, folder, files, log};
  if (files.content(canonical.string()) == nullptr) refuse(file, "cannot be opened");
  try {
    check(import::own_reader(input)(input));
  } catch (const import::Refusal& refusal) {
    refuse(file, refusal.found, refusal.remedy);
  }
}

void read_mtl_file(const fs::path& file) {
  import::SourceModel source;
  import::MtlReader reader(source);
  reader.read(bytes_of(file), "a.mtl");
  if (source.materials.empty()) refuse(file, "no material");
  const std::string first = source.materials.front().material.name;
  for (const std::string& name : {first, first + " # paint", std::string()}) {
    demand(reader.number_of(name) < source.materials.size(), "a material of each name exists");
  }
  reader.finish();
  for (const import::SourceMaterial& one : source.materials) {
    const Material& m = one.material;
    const bool is_finite = m.diffuse.allFinite() && m.ambient.allFinite() &&
                           m.specular.allFinite() && m.shininess >= 0.0F && m.opacity >= 0.0F;
    demand(is_finite, "colours are finite");
  }
}

void read_image_file(const fs::path& file) {
  const std::string bytes = bytes_of(file);
  constexpr std::uint64_t kBudget = std::uint64_t{16} << 20U;
  const import::Decoded decoded = import::decode_image(
      {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, kBudget);
  if (!decoded.reason.empty()) refuse(file, decoded.reason);
  const Texture& t = decoded.texture;
  demand(t.width > 0 && t.height > 0 && t.channels > 0 && t.channels < 5, "an image has texels");
  demand(t.texels.size() == std::size_t{t.width} * t.height * t.channels, "all texels are there");
}

void read_mended_file(const fs::path& file) {
  const fs::path canonical = fs::canonical(file);
  import::ModelFiles files(model_folder(canonical));
  import::Notes notes;
  try {
    import::mend_model(canonical, files, notes);
  } catch (const import::Refusal& refusal) {
    refuse(file, refusal.found, refusal.remedy);
  }
  const std::string* mended = files.replacement(canonical.string());
  if (mended == nullptr) refuse(file, "neither COLLADA nor an archive with a model");
  if (mended->starts_with("PK")) {
    demand(!import::ZipArchive(*mended).names().empty(), "an archive stays an archive");
  } else {
    demand(pugi::xml_document().load_buffer(mended->data(), mended->size()), "XML stays XML");
  }
}

}  // namespace glidar::testing
