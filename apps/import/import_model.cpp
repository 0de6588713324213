// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/import_model.hpp>

#include <import/bake_mesh.hpp>
#include <import/confined_io.hpp>
#include <import/declared_frame.hpp>
#include <import/gltf_extensions.hpp>
#include <import/gltf_transforms.hpp>
#include <import/loaded_libraries.hpp>
#include <import/ply_header.hpp>
#include <import/read_materials.hpp>
#include <import/split_polygons.hpp>

#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>

#include <algorithm>
#include <limits>
#include <new>
#include <string_view>

namespace glidar::import {
namespace {

// Identical vertices are merged later, exactly: Assimp's own step merges nearly equal ones.
constexpr unsigned kStepsOnPolygons = aiProcess_ValidateDataStructure | aiProcess_GenUVCoords;
constexpr unsigned kStepsToTriangles = aiProcess_Triangulate | aiProcess_SortByPType;

class AssimpProgress : public Assimp::ProgressHandler {
 public:
  explicit AssimpProgress(std::function<void(double)> report) : report_(std::move(report)) {}
  bool Update(float fraction) override {
    if (fraction < fraction_) return true;
    fraction_ = fraction;
    report_(fraction);
    return true;
  }

 private:
  std::function<void(double)> report_;
  float fraction_ = 0.0F;  ///< the largest one; the second group of steps starts again
};

std::string importer_name(const Assimp::Importer& importer) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* about =
      index < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(index));
  std::string name = about == nullptr ? "unknown" : about->mName;
  for (const std::string_view tail : {" Importer", " importer", " Reader", " Mesh", "\n"}) {
    if (name.ends_with(tail)) name.resize(name.size() - tail.size());
  }
  return name;
}

[[noreturn]] void refuse(std::string why, const FileLog& log) {
  if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  for (const char* empty : {"contains no faces", "contains no vertices", "mNumMeshes is 0"}) {
    if (why.find(empty) != std::string::npos) throw no_triangles("");
  }
  std::replace(why.begin(), why.end(), '\n', ' ');
  for (const std::string& note : log.notes) why += "; " + note;
  if (why.find("No suitable reader") != std::string::npos) {
    throw Refusal{"not a model file of a known format",
                  "GLIDAR reads PLY, OBJ, STL, glTF, GLB, COLLADA, FBX, 3DS, OFF, LWO, X, 3MF and "
                  "other 3D formats"};
  }
  throw Refusal{"cannot be read: " + (why.empty() ? "unknown error" : why),
                "the file is damaged or of a kind that the importer does not know"};
}

/// The scene with triangles, lines and points only. The caller owns it.
aiScene* read_scene(Assimp::Importer& importer, const std::string& model, FileLog& log) {
  const aiScene* scene = importer.ReadFile(model, kStepsOnPolygons);
  if (scene == nullptr) refuse(importer.GetErrorString(), log);
  // The importer owns the scene until its last step, and only lends it.
  const std::size_t intersecting = split_polygons(*const_cast<aiScene*>(scene));
  if (intersecting > 0) {
    log.notes.push_back(fmt::format(
        "polygons that intersect themselves, parts of which are left out: {}", intersecting));
  }
  if (importer.ApplyPostProcessing(kStepsToTriangles) == nullptr) {
    refuse(importer.GetErrorString(), log);
  }
  return importer.GetOrphanedScene();
}

/// Reads the used materials, in the file's order, and assigns slots.
void read_materials(const aiScene& scene, const Walk& walk, const MaterialContext& context,
                    Model& model, BakeOptions& bake_options) {
  std::vector<bool> used(scene.mNumMaterials, false);
  for (const Placed& placed : walk.placed) used.at(placed.mesh->mMaterialIndex) = true;
  bake_options.slot_of_material.resize(used.size(), 0);
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    if (!used[i]) continue;
    if (model.materials.size() > std::numeric_limits<std::uint16_t>::max()) {
      throw Refusal{"it uses more than 65536 materials", "make the model smaller"};
    }
    bake_options.slot_of_material[i] = static_cast<std::uint16_t>(model.materials.size());
    model.materials.push_back(read_material(*scene.mMaterials[i], context, model));
    const TextureUse& normals = model.materials.back().normal_texture;
    bake_options.needs.push_back({normals.used(), normals.uv_set});
  }
}

/// Texture paths in material files are relative to the material file.
std::vector<std::string> texture_folders(const std::vector<std::string>& read,
                                         const ModelFolder& folder) {
  std::vector<std::string> folders;
  for (const std::string& file : read) {
    const std::filesystem::path parent = std::filesystem::path(file).parent_path();
    if (parent != folder.folder) add_once(folders, parent.string());
  }
  return folders;
}

}  // namespace

ImportedModel import_model(const std::filesystem::path& canonical_model, double crease_angle_rad,
                           const std::function<void(double)>& progress) {
  ModelFolder folder = model_folder(canonical_model);
  ModelFiles files(folder);
  FileLog log;
  const auto own = files.content(canonical_model.string());  // the first of the files
  if (own == nullptr) throw Refusal{"cannot be opened", "check its read permission"};
  const PlyHeader ply = read_ply_header(*own);
  replace_gltf_extensions(canonical_model, folder, files, log);
  // Never destroyed: the destructor of a deep tree recurses, and the process ends anyway.
  auto& importer = *new Assimp::Importer;
  importer.SetIOHandler(new ConfinedIo(folder, files, log));
  importer.SetProgressHandler(new AssimpProgress(progress));
  // Owned here, because the importer's own scene is const; the importer keeps its files open.
  aiScene* scene = read_scene(importer, canonical_model.string(), log);
  add_ply_texture(ply, *scene);
  ImportedModel imported;
  Model& model = imported.model;
  model.format = importer_name(importer);
  model.declared = extract_declared_frame(*scene, model.format, *own, model.notes);
  const bool gltf = model.format.find("glTF") != std::string::npos;
  const Walk walked = walk(*scene, gltf ? gltf_transforms(own->whole(), *scene) : NodeTransforms{});
  const MtlOptions mtl = read_mtl_options(files);
  imported.texture_folders = texture_folders(files.paths(), folder);
  folder.material_folders.assign(imported.texture_folders.begin(), imported.texture_folders.end());
  TextureStore textures(*scene, folder, files, imported);
  BakeOptions options;
  options.crease_angle_rad = crease_angle_rad;
  options.facet_normals = model.format.find("(STL)") != std::string::npos;
  read_materials(*scene, walked, {textures, mtl, gltf}, model, options);
  model.notes.insert(model.notes.end(), log.notes.begin(), log.notes.end());
  bake(walked, options, model);
  imported.absent.insert(imported.absent.end(), log.absent.begin(), log.absent.end());
  imported.files = files.paths();
  imported.hashes = files.hashes();
  imported.libraries = loaded_libraries();
  return imported;
}

}  // namespace glidar::import
