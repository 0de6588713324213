// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scene_state.hpp"

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/files/content_hash.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <type_traits>

namespace glidar::python {
namespace {

/// Adds values to a hash, each list preceded by its length, so that different contents give
/// different bytes.
class Digest {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(const Number& number) { hash_.add(&number, sizeof(Number)); }
  void add(const std::string& text) { add_bytes(text.data(), text.size(), 1); }
  template <class Scalar, int kRows, int kCols>
  void add(const Eigen::Matrix<Scalar, kRows, kCols>& matrix) {
    hash_.add(matrix.data(), sizeof(Scalar) * static_cast<std::size_t>(matrix.size()));
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    if constexpr (std::is_same_v<Value, std::string>) {
      add(values.size());
      for (const std::string& text : values) add(text);
    } else {
      add_bytes(values.data(), values.size(), sizeof(Value));  // contiguous numbers without padding
    }
  }
  template <class... Values>
  requires(sizeof...(Values) > 1) void add(const Values&... values) { (add(values), ...); }
  [[nodiscard]] std::string text() const { return hex(hash_.value()); }

 private:
  void add_bytes(const void* bytes, std::size_t count, std::size_t size) {
    add(count);
    if (count > 0) hash_.add(bytes, count * size);
  }

  ContentHash hash_;
};

void add(const Mesh& mesh, Digest& digest) {
  digest.add(mesh.origin_m, mesh.positions_m, mesh.normals, mesh.uvs[0], mesh.uvs[1], mesh.tangents,
             mesh.colours, mesh.triangles, mesh.material_slots, mesh.origins.size());
  for (const MeshOrigin& run : mesh.origins) {
    digest.add(run.first_vertex, run.first_triangle, run.origin_m);
  }
}

/// Adds the numbers of a described struct.
class DigestFields final : public FieldVisitor {
 public:
  explicit DigestFields(Digest& digest) : digest_(digest) {}

  [[nodiscard]] Mode mode() const override { return Mode::report; }

  void number(const FieldInfo& /*field*/, const NumberRule& /*rule*/, double& value) override {
    digest_.add(value);
  }
  void variant(const FieldInfo& /*field*/, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    digest_.add(std::string(types[chosen].name));
    describe(chosen, *this);
  }

 protected:
  void key(const FieldInfo& field) override {
    throw std::logic_error(std::string("no digest of the key ") + field.key);
  }

 private:
  Digest& digest_;
};

void add(const Brdf& backscatter, Digest& digest) {
  Brdf described = backscatter;
  DigestFields fields(digest);
  describe(described, fields);
}

void add(const Texture& texture, Digest& digest) {
  digest.add(texture.width, texture.height, texture.channels, texture.texels);
}

/// Adds the contents that instances refer to, so that neither indices nor unused data
/// affect the hash. Each mesh and texture is hashed once.
class Contents {
 public:
  explicit Contents(const Scene& scene) : scene_(scene) {}

  void add(const Instance& instance, Digest& digest) {
    const MeshSource& source = scene_.sources[instance.mesh];
    const bool is_stretched = source.stretch != Eigen::Vector3d::Ones();
    const std::string& mesh_hash =
        hash_of(meshes_, scene_.meshes, is_stretched ? source.unstretched : instance.mesh);
    digest.add(instance.name, mesh_hash, source.stretch,
               Eigen::Matrix4d(instance.world_from_object.matrix()), instance.scale, instance.id,
               instance.class_id, scene_.class_names[instance.class_id], instance.visible_to,
               instance.hidden_from, instance.materials.size());
    for (const std::uint32_t index : instance.materials) add(scene_.materials[index], digest);
  }

 private:
  using Hashes = std::map<std::size_t, std::string>;

  template <class Part>
  static const std::string& hash_of(Hashes& known, const std::vector<Part>& parts,
                                    std::size_t index) {
    const auto [place, is_new] = known.try_emplace(index);
    if (is_new) {
      Digest digest;
      python::add(parts[index], digest);
      place->second = digest.text();
    }
    return place->second;
  }

  void add(const TextureUse& use, Digest& digest) {
    digest.add(use.used());
    if (!use.used()) return;
    digest.add(hash_of(textures_, scene_.textures, static_cast<std::size_t>(use.texture)));
    digest.add(use.uv_set, use.wrap_u, use.wrap_v, use.filter, use.uv_scale_rotate, use.uv_offset);
  }

  void add(const Material& material, Digest& digest) {
    digest.add(material.name, material.ambient, material.diffuse, material.specular,
               material.shininess, material.opacity, material.alpha_cutoff, material.mirror,
               material.noise_scale, material.normal_scale);
    python::add(material.backscatter, digest);
    digest.add(material.spectrum);
    for (const TextureUse* use :
         {&material.diffuse_texture, &material.specular_texture, &material.alpha_texture,
          &material.normal_texture, &material.noise_texture}) {
      add(*use, digest);
    }
  }

  const Scene& scene_;
  Hashes meshes_;
  Hashes textures_;
};

/// The meshes that were loaded or created, without scaled copies; they are never
/// removed.
std::vector<std::size_t> loaded_meshes(const Scene& scene) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (scene.sources[i].stretch == Eigen::Vector3d::Ones()) found.push_back(i);
  }
  return found;
}

Eigen::Vector3d origin_in(const nb::dict& state) {
  const auto origin_m = nb::cast<Eigen::Vector3d>(state["origin_m"]);
  if (origin_m.allFinite()) return origin_m;
  throw Error({.where = "mesh",
               .found = "an origin that is not finite",
               .allowed = "three finite numbers"});
}

}  // namespace

std::string digest_of(const Scene& scene) {
  Digest digest;
  Contents contents(scene);
  digest.add(scene.instances.size());
  for (const Instance& instance : scene.instances) contents.add(instance, digest);
  return digest.text();
}

nb::dict mesh_state(const SceneHandle& handle, std::size_t index) {
  const Mesh& mesh = handle.scene->meshes.at(loaded_meshes(*handle.scene).at(index));
  nb::dict state;
  state["name"] = mesh.name;
  state["origin_m"] = mesh.origin_m;
  state["positions_m"] = rows_of<float, 3>(mesh.positions_m);
  state["triangles"] = rows_of<std::uint32_t, 3>(mesh.triangles);
  state["normals"] = rows_of<float, 3>(mesh.normals);
  state["uvs"] = rows_of<float, 2>(mesh.uvs[0]);
  state["colours"] = rows_of<float, 3>(mesh.colours);
  return state;
}

Mesh mesh_from(const nb::dict& state) {
  Mesh mesh;
  mesh.name = nb::cast<std::string>(state["name"]);
  mesh.origin_m = origin_in(state);
  const auto positions = entry<Table<float, 3>>(state, "positions_m").value();
  mesh.positions_m.reserve(positions.shape(0) + 1);  // so that renderers need no copy
  mesh.positions_m.resize(positions.shape(0));
  std::copy_n(positions.data(), positions.size(),
              reinterpret_cast<float*>(mesh.positions_m.data()));
  mesh.triangles = vectors<Triangle>(entry<Table<std::uint32_t, 3>>(state, "triangles"));
  mesh.normals = vectors<Eigen::Vector3f>(entry<Table<float, 3>>(state, "normals"));
  mesh.uvs[0] = vectors<Eigen::Vector2f>(entry<Table<float, 2>>(state, "uvs"));
  mesh.colours = vectors<Eigen::Vector3f>(entry<Table<float, 3>>(state, "colours"));
  validate(mesh);
  return mesh;
}

void add_classes(SceneHandle& handle, const std::vector<std::string>& names) {
  std::vector<std::string>& known = handle.change().class_names;
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  }
}

/// The motion of objects and rig, and the rig's pose, in the scene file.
nb::dict placing_state(const SceneHandle& handle) {
  nb::dict state;
  state["motion"] = states_of(handle.motion);
  std::vector<Trajectory> rig;
  if (handle.rig_motion) rig.push_back(*handle.rig_motion);
  if (handle.world_from_rig) rig.emplace_back(ConstantPose{*handle.world_from_rig});
  state["rig"] = states_of(rig);
  state["looks_at"] = handle.looks_at;
  return state;
}

std::optional<std::string> hash_of_file(const std::filesystem::path& path) {
  const std::optional<Hash128> hash = hash_file(path);
  return hash ? std::optional(hex(*hash)) : std::nullopt;
}

void bind_scene_state(nb::module_& module) {
  module.def(
      "copy_scene", [](const SceneHandle& scene) { return SceneHandle(scene); }, nb::arg("scene"));
  module.def(
      "scene_digest", [](const SceneHandle& scene) { return digest_of(*scene.scene); },
      nb::arg("scene"));
  module.def(
      "loaded_mesh_count",
      [](const SceneHandle& scene) { return loaded_meshes(*scene.scene).size(); },
      nb::arg("scene"));
  module.def("mesh_state", mesh_state, nb::arg("scene"), nb::arg("index"),
             nb::sig("def mesh_state(scene: Scene, index: int) -> dict[str, typing.Any]"));
  module.def("add_classes", add_classes, nb::arg("scene"), nb::arg("names"));
  module.def("placing_state", placing_state, nb::arg("scene"),
             nb::sig("def placing_state(scene: Scene) -> dict[str, typing.Any]"));
  module.def("hash_file", hash_of_file, nb::arg("path"),
             nb::sig("def hash_file(path: str) -> str | None"));
}

}  // namespace glidar::python
