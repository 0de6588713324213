// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/assimp_reader.hpp>

#include <import/assimp_material.hpp>
#include <import/confined_io.hpp>
#include <import/declared_frame.hpp>
#include <import/mend_model.hpp>
#include <import/polygons.hpp>
#include <import/process_limits.hpp>
#include <import/skin.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <string_view>

namespace glidar::import {
namespace {

// Identical vertices are merged later, exactly: Assimp's own step merges nearly equal ones.
// Polygons are split later, in double.
constexpr unsigned kSteps = aiProcess_ValidateDataStructure | aiProcess_GenUVCoords;
constexpr std::uint64_t kMaxNodes = 10'000'000;

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
  why = excerpt(why);  // it may quote much of the file
  for (const std::string& note : log.notes) why += "; " + note;
  if (why.find("No suitable reader") != std::string::npos) {
    throw Refusal{"not a model file of a known format",
                  "GLIDAR reads PLY, OBJ, STL, glTF, GLB, COLLADA, FBX, 3DS, OFF, LWO, X, 3MF and "
                  "other 3D formats"};
  }
  throw Refusal{"cannot be read: " + (why.empty() ? "unknown error" : why),
                "the file is damaged or of a kind that the importer does not know"};
}

Eigen::Vector3f vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

struct Visit {
  const aiNode* node;
  Eigen::Matrix4d model_from_parent;
  std::uint32_t parent = 0;  ///< index into SourceModel::nodes
};

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

void copy_vertices(const aiMesh& from, SourceMesh& mesh) {
  const std::size_t count = from.mNumVertices;
  const auto copy = [count](const aiVector3D* values, auto& to) {
    to.reserve(count);
    for (std::size_t v = 0; v < count; ++v) {
      const Eigen::Vector3f value = vector(values[v]);
      to.emplace_back(
          value.head<std::decay_t<decltype(to)>::value_type::RowsAtCompileTime>()
              .template cast<typename std::decay_t<decltype(to)>::value_type::Scalar>());
    }
  };
  copy(from.mVertices, mesh.positions);
  for (unsigned set = 0; set < mesh.uvs.size(); ++set) {
    if (from.HasTextureCoords(set)) copy(from.mTextureCoords[set], mesh.uvs[set]);
  }
  if (from.HasNormals()) copy(from.mNormals, mesh.normals);
  for (std::size_t v = 0; v < count && from.HasVertexColors(0); ++v) {
    const aiColor4D& c = from.mColors[0][v];
    mesh.colours.emplace_back(c.r, c.g, c.b);
  }
  if (mesh.normals.empty() || !from.HasTangentsAndBitangents()) return;
  for (std::size_t v = 0; v < count; ++v) {
    const Eigen::Vector3f t = vector(from.mTangents[v]);
    const Eigen::Vector3f b = vector(from.mBitangents[v]);
    const float side = mesh.normals[v].cross(t).dot(b) < 0.0F ? -1.0F : 1.0F;
    mesh.tangents.emplace_back(t.x(), t.y(), t.z(), side);
  }
}

/// What several meshes add to.
struct Left {
  PolygonSplitter polygons;
  std::uint64_t outside = 0;  ///< faces with a corner that is no vertex
};

/// Removes vertices that only points and lines use.
void drop_vertices_of_lines(const std::vector<bool>& of_lines, SourceMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> renumbered(used.size(), 0);
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (of_lines[v] && !used[v]) continue;
    renumbered[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
  }
  const auto keep = [&kept](auto& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
  };
  keep(mesh.positions);
  keep(mesh.normals);
  keep(mesh.tangents);
  keep(mesh.uvs[0]);
  keep(mesh.uvs[1]);
  keep(mesh.colours);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
}

/// Returns the number of points and lines.
std::uint64_t copy_faces(const aiMesh& from, SourceMesh& mesh, Left& left) {
  std::uint64_t lines = 0;
  std::vector<bool> of_lines(from.mNumVertices, false);
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const std::span<const unsigned> corners(from.mFaces[f].mIndices, from.mFaces[f].mNumIndices);
    const bool is_inside = std::all_of(corners.begin(), corners.end(),
                                       [&](unsigned v) { return v < from.mNumVertices; });
    if (!is_inside) {
      ++left.outside;
    } else if (corners.size() >= 3) {
      left.polygons.add(mesh, corners);
    } else {
      ++lines;
      for (const unsigned v : corners) of_lines[v] = true;
    }
  }
  if (lines > 0) drop_vertices_of_lines(of_lines, mesh);
  return lines;
}

using Places = std::map<std::string, Eigen::Matrix4d>;

/// model_from_node of all nodes by their names.
Places places_of(const aiScene& scene) {
  Places places;
  std::vector<Visit> stack;
  if (scene.mRootNode != nullptr) stack.push_back({scene.mRootNode, Eigen::Matrix4d::Identity()});
  while (!stack.empty() && places.size() < kMaxNodes) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Eigen::Matrix4d here = visit.model_from_parent * matrix(visit.node->mTransformation);
    places.emplace(visit.node->mName.C_Str(), here);
    for (unsigned i = 0; i < visit.node->mNumChildren; ++i) {
      stack.push_back({visit.node->mChildren[i], here});
    }
  }
  return places;
}

/// COLLADA 1.4.1, "Skin Deformation": bind shape, inverse bind matrix (Assimp's offset is their
/// product) and joint, by the weights. Returns false, and changes nothing, if a joint or a vertex's
/// weights are missing.
bool pose_collada(const aiMesh& from, const Places& places, SourceMesh& mesh) {
  std::vector<Eigen::Matrix4d> skin(mesh.positions.size(), Eigen::Matrix4d::Zero());
  std::vector<double> sums(skin.size(), 0.0);
  for (unsigned i = 0; i < from.mNumBones; ++i) {
    const aiBone& bone = *from.mBones[i];
    const auto place = places.find(bone.mName.C_Str());
    if (place == places.end()) return false;
    const Eigen::Matrix4d moved = place->second * matrix(bone.mOffsetMatrix);
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& weight = bone.mWeights[k];
      if (weight.mVertexId >= skin.size()) return false;
      skin[weight.mVertexId] += double{weight.mWeight} * moved;
      sums[weight.mVertexId] += double{weight.mWeight};
    }
  }
  const bool is_complete =
      !sums.empty() && std::all_of(sums.begin(), sums.end(), [](double sum) { return sum > 0.0; });
  if (!is_complete) return false;
  for (std::size_t v = 0; v < skin.size(); ++v) skin[v] /= sums[v];
  apply_skin(skin, mesh);
  return true;
}

/// What is left to do with a converted mesh.
struct Copied {
  std::uint64_t lines = 0;  ///< and points, left out
  bool is_posed = false;    ///< its skeleton places it in the model
};

/// Converts the meshes, with the same indices.
std::vector<Copied> copy_meshes(const aiScene& scene, SourceModel& source) {
  const bool has_skins = source.format.find("Collada") != std::string::npos;
  const Places places = has_skins ? places_of(scene) : Places{};
  Left left;
  std::vector<Copied> all;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& from = *scene.mMeshes[i];
    SourceMesh& mesh = source.meshes.emplace_back();
    mesh.material = from.mMaterialIndex;
    copy_vertices(from, mesh);
    Copied& copied = all.emplace_back();
    copied.lines = copy_faces(from, mesh, left);
    const bool has_skin = has_skins && from.mNumBones > 0 && copied.lines == 0;
    copied.is_posed = has_skin && pose_collada(from, places, mesh);
  }
  left.polygons.note_intersecting(source);
  if (left.outside > 0) {
    source.notes.add(
        fmt::format("faces that name missing vertices are left out: {}", left.outside));
  }
  return all;
}

/// The tree with the meshes of its nodes.
class Tree {
 public:
  Tree(const aiScene& scene, std::vector<Copied> copied,
       const std::map<std::string, std::string>& names, SourceModel& source)
      : scene_(scene), copied_(std::move(copied)), names_(names), source_(source) {}

  /// Nodes depth first, parents first.
  void place() {
    // An explicit stack, because hostile trees are deep.
    std::vector<Visit> stack;
    if (scene_.mRootNode != nullptr) {
      stack.push_back({scene_.mRootNode, Eigen::Matrix4d::Identity()});
    }
    for (std::uint64_t visited = 0; !stack.empty(); ++visited) {
      if (visited > kMaxNodes) {
        throw Refusal{fmt::format("its tree has more than {} nodes", kMaxNodes),
                      "make the model smaller"};
      }
      const Visit visit = stack.back();
      stack.pop_back();
      const Eigen::Matrix4d model_from_node =
          visit.model_from_parent * matrix(visit.node->mTransformation);
      const std::uint32_t part =
          add_node(source_.nodes, part_name(*visit.node), visit.parent, model_from_node);
      place_meshes(*visit.node, model_from_node, part);
      for (unsigned child = visit.node->mNumChildren; child-- > 0;) {
        stack.push_back({visit.node->mChildren[child], model_from_node, part});
      }
    }
    if (skinned_ > 0) {
      source_.notes.add(
          fmt::format("{} meshes have a skeleton: shown in their rest pose", skinned_));
    }
  }

 private:
  /// Empty: it is no part. The root has the name of the file or of its format, and Assimp adds
  /// nodes for the steps of a transform of FBX, and names in COLLADA.
  std::string part_name(const aiNode& node) const {
    std::string name = node.mName.C_Str();
    if (&node == scene_.mRootNode || name.find("$AssimpFbx$") != std::string::npos) return "";
    if (const auto known = names_.find(name); known != names_.end()) return known->second;
    if (name.starts_with("$ColladaAutoName$")) name.clear();
    if (!name.empty() || node.mNumMeshes == 0) return name;
    const unsigned first = node.mMeshes[0];
    if (first < scene_.mNumMeshes) name = scene_.mMeshes[first]->mName.C_Str();
    return name.empty() ? fmt::format("node_{}", source_.nodes.size()) : name;
  }

  void place_meshes(const aiNode& node, const Eigen::Matrix4d& model_from_node,
                    std::uint32_t part) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const std::size_t index = node.mMeshes[i];
      if (index >= source_.meshes.size()) continue;
      source_.lines_and_points += copied_[index].lines;
      if (source_.meshes[index].triangles.empty()) continue;
      const aiMesh& mesh = *scene_.mMeshes[index];
      const bool is_posed = copied_[index].is_posed;
      skinned_ += mesh.mNumBones > 0 && !is_posed ? 1 : 0;
      const aiString& name = mesh.mName.length > 0 ? mesh.mName : node.mName;
      const Eigen::Matrix4d placed =
          is_posed ? Eigen::Matrix4d(Eigen::Matrix4d::Identity()) : model_from_node;
      const std::uint32_t of = &node == scene_.mRootNode
                                   ? add_node(source_.nodes, name.C_Str(), part, model_from_node)
                                   : part;
      source_.take_instances(1);
      source_.place({index, placed, std::string(name.C_Str()), of});
    }
  }

  const aiScene& scene_;
  std::vector<Copied> copied_;  ///< of each mesh
  const std::map<std::string, std::string>& names_;
  SourceModel& source_;
  std::uint64_t skinned_ = 0;
};

EmbeddedImage image_of(const aiTexture& texture) {
  EmbeddedImage image;
  if (texture.pcData == nullptr) return image;
  if (texture.mHeight == 0) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture.pcData);
    image.bytes.assign(bytes, bytes + texture.mWidth);
    return image;
  }
  image.width = texture.mWidth;
  image.height = texture.mHeight;
  const std::size_t texels = std::size_t{texture.mWidth} * texture.mHeight;
  image.bytes.reserve(texels * 4);
  for (std::size_t i = 0; i < texels; ++i) {
    const aiTexel& texel = texture.pcData[i];
    image.bytes.insert(image.bytes.end(), {texel.r, texel.g, texel.b, texel.a});
  }
  return image;
}

void copy_materials(const aiScene& scene, SourceModel& source) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    const SourceMaterial& material =
        source.materials.emplace_back(assimp_material(*scene.mMaterials[i]));
    for (const auto* texture :
         {&material.diffuse, &material.specular, &material.opacity, &material.normals}) {
      if (!*texture || source.images.contains((*texture)->name)) continue;
      const aiTexture* image = scene.GetEmbeddedTexture((*texture)->name.c_str());
      if (image != nullptr) source.images.emplace((*texture)->name, image_of(*image));
    }
  }
}

/// As read_with_assimp(), within limits.
SourceModel read_within(InputLimits& limits, const std::filesystem::path& model,
                        const ModelFolder& folder, ModelFiles& files, FileLog& log,
                        const std::function<void(double)>& progress) {
  const auto own = files.content(model.string());
  limits.set_input(own->size());
  SourceModel source;
  const std::map<std::string, std::string> names = mend_model(model, files, source.notes);
  // Never destroyed: the destructor of a deep tree recurses, and the process ends anyway.
  auto& importer = *new Assimp::Importer;
  importer.SetIOHandler(new ConfinedIo(folder, files, limits, log));
  importer.SetProgressHandler(new AssimpProgress(progress));
  // Files without surfaces have nothing to measure.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  if (importer.ReadFile(model.string(), kSteps) == nullptr) refuse(importer.GetErrorString(), log);
  // Owned here, because the importer's own scene is const; the importer keeps its files open.
  aiScene& scene = *importer.GetOrphanedScene();
  source.budget.add_input(files.total_bytes());
  source.format = importer_name(importer);
  source.is_single_precision = true;
  source.declared = extract_declared_frame(scene, source.format, *own, source.notes);
  Tree(scene, copy_meshes(scene, source), names, source).place();
  copy_materials(scene, source);
  return source;
}

}  // namespace

SourceModel read_with_assimp(const std::filesystem::path& model, const ModelFolder& folder,
                             ModelFiles& files, FileLog& log,
                             const std::function<void(double)>& progress) {
  InputLimits limits;
  try {
    return read_within(limits, model, folder, files, log, progress);
  } catch (const std::bad_alloc&) {
    if (!limits.is_strictest()) throw;
    throw Refusal{fmt::format("reading it needs more memory than {} MiB, which is the limit for a "
                              "file of its size",
                              limits.memory_bytes() >> 20U),
                  "the file may be corrupt; otherwise save the model as PLY, OBJ or glTF"};
  }
}

}  // namespace glidar::import
