// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/import_model.hpp>

#include <import/assimp_reader.hpp>
#include <import/bake_mesh.hpp>
#include <import/gltf/read_gltf.hpp>
#include <import/loaded_libraries.hpp>
#include <import/own_readers.hpp>
#include <import/read_materials.hpp>
#include <import/unread_formats.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/model/texture_search.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace glidar::import {
namespace {

/// Makes the used materials, in the file's order. Returns the slot of each of them.
std::vector<std::uint16_t> make_materials(const SourceModel& source, TextureStore& textures,
                                          Model& model) {
  std::vector<bool> used(source.materials.size(), false);
  for (const Placed& placed : source.placed) {
    used.at(source.meshes.at(placed.mesh).material) = true;
  }
  std::vector<std::uint16_t> slots(used.size(), 0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    if (model.materials.size() > std::numeric_limits<std::uint16_t>::max()) {
      throw Refusal{"it uses more than 65536 materials", "make the model smaller"};
    }
    slots[i] = static_cast<std::uint16_t>(model.materials.size());
    model.materials.push_back(make_material(source.materials[i], textures, model));
  }
  return slots;
}

/// Texture paths in material files are relative to the material file.
std::vector<std::string> material_folders(const std::vector<std::string>& read,
                                          const ModelFolder& folder) {
  std::vector<std::string> folders;
  for (const std::string& file : read) {
    const std::filesystem::path parent = std::filesystem::path(file).parent_path();
    if (parent != folder.folder) add_once(folders, parent.string());
  }
  return folders;
}

/// The bytes of a buffer of a glTF file, which is a file below the model's root.
std::string_view open_buffer(const std::string& uri, const ModelFolder& folder, ModelFiles& files,
                             FileLog& log) {
  constexpr std::size_t kShown = 120;
  if (uri.find("://") != std::string::npos) {
    throw Refusal{"its buffer '" + uri.substr(0, kShown) + "' is on a network, which is not read",
                  "download it, and save the model with its buffers"};
  }
  std::string forward = percent_decoded(uri);
  std::replace(forward.begin(), forward.end(), '\\', '/');
  for (const std::string& name : {percent_decoded(uri), uri, forward}) {
    const ConfinedFile found = confine(name, folder);
    const auto file =
        found.access == Access::granted ? files.content(found.path.string()) : nullptr;
    if (file != nullptr) return file->whole();
    add_once(log.absent, (folder.folder / name).string());
  }
  throw Refusal{"its buffer '" + uri.substr(0, kShown) +
                    "' is not read: " + reason(confine(percent_decoded(uri), folder).access),
                "or save the model with its buffers inside"};
}

/// By the reader of its format.
SourceModel read_file(const std::filesystem::path& model, const ModelFolder& folder,
                      ModelFiles& files, FileLog& log,
                      const std::function<void(double)>& progress) {
  constexpr std::size_t kHead = 4096;
  auto own = files.content(model.string());
  const std::string extension = lower_case(model.extension().string());
  const std::string_view head = own->head(kHead);
  if (auto unread = unread_format(extension, head)) {
    throw Refusal{std::move(unread->found), std::move(unread->remedy)};
  }
  if (gltf::is_gltf(extension, head)) {
    SourceModel source = gltf::read_gltf(
        own->whole(), [&](const std::string& uri) { return open_buffer(uri, folder, files, log); });
    own = nullptr;
    for (const std::string& read : files.paths()) files.release(read);
    return source;
  }
  const ReaderInput input{model, folder, files, log};
  const Reader reader = own_reader(input);
  return reader != nullptr ? reader(input) : read_with_assimp(model, folder, files, log, progress);
}

}  // namespace

ImportedModel import_model(const std::filesystem::path& canonical_model, ModelFolder folder,
                           double crease_angle_rad, const std::function<void(double)>& progress) {
  ModelFiles files(folder);
  FileLog log;
  if (files.content(canonical_model.string()) == nullptr) {  // the first of the files
    throw Refusal{"cannot be opened", "check its read permission"};
  }
  SourceModel source = read_file(canonical_model, folder, files, log, progress);
  require_triangles(source);
  if (std::any_of(source.nodes.begin(), source.nodes.end(),
                  [](const SourceNode& node) { return node.has_omitted_parts; })) {
    source.notes.add("nodes nested too deeply, or too many, belong to the part above them");
  }
  ImportedModel imported;
  Model& model = imported.model;
  model.format = source.format;
  model.declared = source.declared;
  model.notes = source.notes.texts();
  imported.material_folders = material_folders(files.paths(), folder);
  folder.material_folders.assign(imported.material_folders.begin(),
                                 imported.material_folders.end());
  TextureStore textures(source, folder, files, imported);
  const std::vector<std::uint16_t> slots = make_materials(source, textures, model);
  model.notes.insert(model.notes.end(), log.notes.begin(), log.notes.end());
  bake(source, crease_angle_rad, slots, model);
  imported.absent.insert(imported.absent.end(), log.absent.begin(), log.absent.end());
  imported.files = files.paths();
  imported.hashes = files.hashes();
  imported.libraries = loaded_libraries();
  return imported;
}

}  // namespace glidar::import
