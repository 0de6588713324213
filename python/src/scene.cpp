// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "objects.hpp"

#include <glidar/core/box_classes.hpp>
#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/length_unit.hpp>
#include <glidar/io/config/surface_presets.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/model/model_parts.hpp>
#include <glidar/math/single_precision.hpp>
#include "motion.hpp"
#include "report.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
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

/// Hash over all objects of a scene with their meshes, materials, textures and classes; not
/// over file names, nor over data that no object uses. Equal scenes have equal
/// digests.
std::string digest_of(const Scene& scene) {
  Digest digest;
  Contents contents(scene);
  digest.add(scene.instances.size());
  for (const Instance& instance : scene.instances) contents.add(instance, digest);
  return digest.text();
}

/// The arrays of a mesh from Python, and the bit-identical mesh from such arrays. `index`
/// counts meshes without scaled copies. The second throws Error or a Python error when the state
/// is malformed.
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

/// What pickling and comparing scenes need.
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

/// Options from Python for reading a model.
ModelOptions model_options(const nb::dict& given) {
  ModelOptions options;
  options.metres_per_unit = entry<double>(given, "metres_per_unit");
  if (const auto up = entry<int>(given, "up")) options.up = static_cast<Axis>(*up);
  options.centre = entry<bool>(given, "centre").value_or(false);
  for (const std::string& folder : entry<std::vector<std::string>>(given, "texture_folders")
                                       .value_or(std::vector<std::string>()))
    options.texture_folders.emplace_back(folder);
  return options;
}

SceneHandle handle_of(SceneFile file) {
  SceneHandle handle;
  handle.scene = std::make_shared<Scene>(std::move(file.scene));
  handle.motion = std::move(file.world_from_instance);
  for (RigSensor& one : file.sensors) {
    handle.sensors.push_back({std::move(one.name),
                              std::make_shared<SensorHandle>(std::move(one.sensor)),
                              one.rig_from_sensor});
  }
  handle.box_classes = std::move(file.box_classes);
  handle.world_from_rig = file.world_from_rig;
  handle.looks_at = file.looks_at;
  handle.rig_motion = std::move(file.rig_motion);
  handle.imus = std::move(file.imus);
  handle.gravity_m_s2 = file.gravity_m_s2;
  handle.files = std::move(file.files);
  return handle;
}

SceneHandle load(const std::filesystem::path& path, const nb::dict& given, const nb::object& log) {
  const ModelOptions options = model_options(given);
  return handle_of(unlocked(
      [&](Watch& watch) { return load_scene_file(path, options, report_to(log, watch)); }));
}

SceneHandle load_content(const std::filesystem::path& path, const std::string& content,
                         const nb::object& log) {
  return handle_of(unlocked(
      [&](Watch& watch) { return load_scene_content(path, content, {}, report_to(log, watch)); }));
}

SceneHandle parse(const std::string& text, const nb::object& log,
                  const std::filesystem::path& folder) {
  return handle_of(
      unlocked([&](Watch& watch) { return parse_scene(text, report_to(log, watch), folder); }));
}

/// An instance that is added to a scene with motion is stationary.
void add_still(SceneHandle& handle) {
  if (handle.motion.empty()) return;
  const Scene& scene = *handle.scene;
  for (std::size_t i = handle.motion.size(); i < scene.instances.size(); ++i) {
    handle.motion.emplace_back(ConstantPose{scene.instances[i].world_from_object});
  }
}

std::size_t add_model(SceneHandle& handle, const std::string& source, const nb::dict& given,
                      const nb::object& log) {
  const ModelOptions options = model_options(given);
  Model model =
      unlocked([&](Watch& watch) { return load_model(source, options, report_to(log, watch)); });
  const std::size_t instance = glidar::add_model(handle.change(), std::move(model));
  add_still(handle);
  return instance;
}

/// Adds models with the keys of scene files; several instances if they are cut into parts.
void add_models(SceneHandle& handle, const std::string& text, const nb::dict& given,
                const nb::object& log, const std::filesystem::path& folder) {
  const ModelOptions options = model_options(given);
  std::vector<std::string> sensors;
  for (const MountedSensor& one : handle.sensors) sensors.push_back(one.name);
  Scene& scene = handle.change();
  unlocked([&](Watch& watch) {
    glidar::add_models(scene, text, options, sensors, report_to(log, watch), folder);
    return true;
  });
  add_still(handle);
}

nb::list parts_of(const std::string& source, const nb::dict& given, const nb::object& log) {
  const ModelOptions options = model_options(given);
  const Model model =
      unlocked([&](Watch& watch) { return load_model(source, options, report_to(log, watch)); });
  nb::list parts;
  for (const PartSummary& part : list_parts(model)) {
    nb::dict values;
    values["name"] = part.name;
    values["parent"] = part.parent;
    values["materials"] = part.materials;
    values["triangles"] = part.triangles;
    values["minimum"] = Eigen::Vector3d(part.box_m.min());
    values["maximum"] = Eigen::Vector3d(part.box_m.max());
    values["pose"] = nb::cast(matrix_of(part.parent_from_part));
    parts.append(values);
  }
  return parts;
}

using Floats3 = Table<float, 3>;

nb::dict mesh_of(const SceneHandle& handle, std::size_t index) {
  const Scene& scene = *handle.scene;
  const std::uint32_t placed = scene.instances.at(index).mesh;
  const bool is_stretched = scene.sources.at(placed).stretch != Eigen::Vector3d::Ones();
  const Mesh& mesh = scene.meshes.at(is_stretched ? scene.sources[placed].unstretched : placed);
  std::vector<Eigen::Vector3d> vertices;
  for (std::uint32_t v = 0; v < mesh.positions_m.size(); ++v) {
    vertices.push_back(vertex_m(mesh, v));
  }
  nb::dict arrays;
  arrays["vertices"] = rows_of<double, 3>(vertices);
  arrays["triangles"] = rows_of<std::uint32_t, 3>(mesh.triangles);
  arrays["normals"] = rows_of<float, 3>(mesh.normals);
  arrays["uvs"] = rows_of<float, 2>(mesh.uvs[0]);
  arrays["colours"] = rows_of<float, 3>(mesh.colours);
  return arrays;
}

/// The arrays of a mesh, with one row per vertex or triangle.
struct MeshArrays {
  Table<double, 3> vertices;
  Table<std::uint32_t, 3> triangles;
  std::optional<Floats3> normals;
  std::optional<Table<float, 2>> uvs;
  std::optional<Floats3> colours;
};

Mesh make_mesh(const std::string& name, const MeshArrays& arrays) {
  Mesh mesh;
  mesh.name = name;
  const std::size_t count = arrays.vertices.shape(0);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> points(
      arrays.vertices.data(), static_cast<Eigen::Index>(count), 3);
  // single precision is sufficient near the mesh's origin; like files, meshes near zero have the
  // origin zero
  if (count > 0 && !points.unaryExpr(&rounded_to_float).isApprox(points, 0.0)) {
    mesh.origin_m = 0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff()).transpose();
  }
  mesh.positions_m.reserve(count + 1);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    mesh.positions_m.emplace_back((points.row(i).transpose() - mesh.origin_m).cast<float>());
  }
  mesh.normals = vectors<Eigen::Vector3f>(arrays.normals);
  mesh.uvs[0] = vectors<Eigen::Vector2f>(arrays.uvs);
  mesh.colours = vectors<Eigen::Vector3f>(arrays.colours);
  mesh.triangles = vectors<Triangle>(std::optional(arrays.triangles));
  validate(mesh);
  return mesh;
}

std::size_t add_made_mesh(SceneHandle& handle, Mesh mesh) {
  Model model;
  model.source = "array:" + mesh.name;
  model.mesh = std::move(mesh);
  model.materials = {Material{}};
  const std::size_t instance = glidar::add_model(handle.change(), std::move(model));
  add_still(handle);
  return instance;
}

std::size_t add_mesh(SceneHandle& handle, const std::string& name, const nb::dict& arrays) {
  return add_made_mesh(
      handle,
      make_mesh(name, {entry<Table<double, 3>>(arrays, "vertices").value(),
                       entry<Table<std::uint32_t, 3>>(arrays, "triangles").value(),
                       entry<Floats3>(arrays, "normals"), entry<Table<float, 2>>(arrays, "uvs"),
                       entry<Floats3>(arrays, "colours")}));
}

/// A mesh from its pickled state.
std::size_t restore_mesh(SceneHandle& handle, const nb::dict& state) {
  return add_made_mesh(handle, mesh_from(state));
}

std::size_t add_instance(SceneHandle& handle, std::size_t of) {
  Scene& scene = handle.change();
  scene.instances.push_back(Instance(scene.instances.at(of)));
  add_still(handle);
  return scene.instances.size() - 1;
}

/// Throws Error unless the pose and the names of an instance of a scene are valid; what its mesh
/// and materials require is known. The time does not depend on the scene.
void validate_placing(const Scene& scene, Instance instance) {
  Scene alone;
  alone.meshes.emplace_back();
  alone.sources.emplace_back();
  alone.materials.emplace_back();
  alone.class_names.resize(std::max<std::size_t>(scene.class_names.size(), 1));
  instance.mesh = 0;
  instance.materials = {0};
  alone.instances.push_back(std::move(instance));
  validate(alone);
}

/// An instance of an object's mesh for each pose (N, 4, 4); changes nothing when it throws.
void add_instances(SceneHandle& handle, std::size_t of, const PoseArray& poses,
                   const std::vector<std::string>& names, const std::vector<std::uint32_t>& ids) {
  if (poses.shape(0) != names.size() || ids.size() != names.size())
    throw Error({"add_instances", "poses, names and ids of different numbers", "one of each"});
  Scene& scene = handle.change();
  std::vector<Instance> added;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Instance instance = scene.instances.at(of);
    instance.name = names[i];
    instance.id = ids.at(i);
    instance.world_from_object = pose_of(poses, i, "poses");
    validate_placing(scene, instance);
    added.push_back(std::move(instance));
  }
  scene.instances.insert(scene.instances.end(), std::make_move_iterator(added.begin()),
                         std::make_move_iterator(added.end()));
  add_still(handle);
}

std::uint32_t class_number(Scene& scene, const std::string& name) {
  const auto found = std::find(scene.class_names.begin(), scene.class_names.end(), name);
  const auto number = static_cast<std::uint32_t>(found - scene.class_names.begin());
  if (found == scene.class_names.end()) scene.class_names.push_back(name);
  return number;
}

void set_box_classes(SceneHandle& handle, std::vector<std::string> names) {
  boxed_classes(handle.scene->class_names, names, "box_classes");  // for its errors
  handle.prepared.clear();
  handle.box_classes = std::move(names);
}

using Scale = std::array<double, 3>;

/// Sets the given attributes of an object; changes nothing when it throws.
void set_object(SceneHandle& handle, std::size_t index, const nb::dict& changes) {
  Scene& scene = handle.change();
  const std::size_t classes = scene.class_names.size();
  Instance changed = scene.instances.at(index);
  const auto pose = entry<PoseArray>(changes, "pose");
  if (pose) changed.world_from_object = pose_of(*pose, 0, "pose");
  changed.name = entry<std::string>(changes, "name").value_or(changed.name);
  changed.id = entry<std::uint32_t>(changes, "id").value_or(changed.id);
  if (const auto name = entry<std::string>(changes, "class_name")) {
    changed.class_id = class_number(scene, *name);
  }
  using Ids = std::vector<std::uint32_t>;
  changed.visible_to = entry<Ids>(changes, "visible_to").value_or(changed.visible_to);
  changed.hidden_from = entry<Ids>(changes, "hidden_from").value_or(changed.hidden_from);
  std::swap(scene.instances[index], changed);
  try {
    validate_placing(scene, scene.instances[index]);
    if (const auto scale = entry<Scale>(changes, "scale")) {
      set_scale(scene, index, {(*scale)[0], (*scale)[1], (*scale)[2]});
    }
  } catch (...) {
    std::swap(scene.instances[index], changed);
    scene.class_names.resize(classes);
    throw;
  }
  if (pose && !handle.motion.empty()) {
    handle.motion[index] = ConstantPose{scene.instances[index].world_from_object};
  }
}

void set_materials_of(SceneHandle& handle, std::size_t index, const std::string& text,
                      const std::filesystem::path& folder) {
  set_materials(handle.change(), index, text, folder);
}

std::vector<std::string> materials_of(const SceneHandle& handle, std::size_t index) {
  std::vector<std::string> names;
  for (const std::uint32_t material : handle.scene->instances.at(index).materials) {
    names.push_back(handle.scene->materials.at(material).name);
  }
  return names;
}

nb::dict object_info(const SceneHandle& handle, std::size_t index) {
  const Scene& scene = *handle.scene;
  const Instance& instance = scene.instances.at(index);
  nb::dict info;
  info["name"] = instance.name;
  info["id"] = instance.id;
  info["class_name"] = scene.class_names.at(instance.class_id);
  info["pose"] = nb::cast(matrix_of(instance.world_from_object));
  const Eigen::Vector3d scale = scale_of(scene, instance);
  info["scale"] = nb::make_tuple(scale.x(), scale.y(), scale.z());
  info["visible_to"] = instance.visible_to;
  info["hidden_from"] = instance.hidden_from;
  info["source"] = scene.sources.at(instance.mesh).path;
  info["triangles"] = scene.meshes.at(instance.mesh).triangles.size();
  info["vertices"] = scene.meshes.at(instance.mesh).positions_m.size();
  return info;
}

/// Name, sensor and rig_from_sensor of each sensor of the scene file.
nb::list rig_of(const SceneHandle& handle) {
  nb::list rig;
  for (const MountedSensor& one : handle.sensors) {
    rig.append(nb::make_tuple(one.name, one.sensor, matrix_of(one.rig_from_sensor)));
  }
  return rig;
}

/// Name, IMU and rig_from_imu of each IMU of the scene file.
nb::list imus_of(const SceneHandle& handle) {
  nb::list imus;
  for (const RigImu& one : handle.imus) {
    imus.append(nb::make_tuple(one.name, ImuHandle{one.imu}, matrix_of(one.rig_from_imu)));
  }
  return imus;
}

/// The rig's motion or pose in the scene file.
std::optional<Trajectories> rig_motion_of(const SceneHandle& handle) {
  if (handle.rig_motion) return Trajectories{{*handle.rig_motion}};
  if (handle.world_from_rig) return Trajectories{{ConstantPose{*handle.world_from_rig}}};
  return std::nullopt;
}

/// Removes the last object and its scaled mesh.
void drop_last(SceneHandle& handle) {
  Scene& scene = handle.change();
  set_scale(scene, scene.instances.size() - 1, Eigen::Vector3d::Ones());
  scene.instances.pop_back();
  if (!handle.motion.empty()) handle.motion.resize(scene.instances.size());
}

/// The units of model files by name, in metres.
std::vector<std::pair<std::string, double>> length_units() {
  std::vector<std::pair<std::string, double>> units;
  for (const Named<double>& unit : kLengthUnits) units.emplace_back(unit.name, unit.value);
  return units;
}

std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> bounds_of(const SceneHandle& handle) {
  const Eigen::AlignedBox3d box = bounds(*handle.scene);
  if (box.isEmpty()) return std::nullopt;
  return std::pair(Eigen::Vector3d(box.min()), Eigen::Vector3d(box.max()));
}

}  // namespace

Scene& SceneHandle::change() {
  prepared.clear();
  if (scene.use_count() > 1) scene = std::make_shared<Scene>(*scene);
  return *scene;
}

std::vector<std::string> files_read(const SceneHandle& handle) {
  std::vector<std::string> files = files_of(*handle.scene);
  files.insert(files.end(), handle.files.begin(), handle.files.end());
  for (const MountedSensor& one : handle.sensors) {
    const std::vector<std::string>& more = one.sensor->sensor().files;
    files.insert(files.end(), more.begin(), more.end());
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

void MeasurementMutex::lock() {
  if (holder_.load() == std::this_thread::get_id()) {
    throw Error({.where = "scene",
                 .found = "a signal handler uses the scene whose measurement it interrupts",
                 .allowed = "another scene, or this one after the measurement",
                 .remedy = "set a flag in the handler, and act on it after the measurement"});
  }
  mutex_.lock();
  holder_.store(std::this_thread::get_id());
}

void MeasurementMutex::unlock() {
  holder_.store({});
  mutex_.unlock();
}

std::shared_ptr<PreparedScene> unrendered(const SceneHandle& handle, const std::string& kind) {
  auto made = std::make_shared<PreparedScene>();
  made->kind = kind;
  made->scene = handle.scene;
  made->files = files_read(handle);
  made->boxed_classes = boxed_classes(made->scene->class_names, handle.box_classes);
  return made;
}

std::shared_ptr<PreparedScene> prepare(SceneHandle& handle, const RendererOptions& options) {
  const std::pair key(options.kind, options.threads);
  if (const auto found = handle.prepared.find(key); found != handle.prepared.end()) {
    return found->second;
  }
  auto made = unrendered(handle, options.kind);
  {
    const nb::gil_scoped_release release;
    made->renderer = make_renderer(*made->scene, options);
  }
  if (made->scene == handle.scene) handle.prepared[key] = made;  // unless it was changed meanwhile
  return made;
}

void bind_scene(nb::module_& module) {
  nb::class_<SceneHandle>(module, "Scene")
      .def(nb::init<>())
      .def("__len__", [](const SceneHandle& self) { return self.scene->instances.size(); })
      .def("add_model", add_model, nb::arg("source"), nb::arg("options"), nb::arg("log").none(),
           nb::sig("def add_model(self, source: str, options: dict[str, typing.Any], "
                   "log: object | None) -> int"))
      .def("add_models", add_models, nb::arg("text"), nb::arg("options"), nb::arg("log").none(),
           nb::arg("folder") = std::filesystem::path(),
           nb::sig("def add_models(self, text: str, options: dict[str, typing.Any], "
                   "log: object | None, folder: str = '') -> None"))
      .def("add_mesh", add_mesh, nb::arg("name"), nb::arg("arrays"),
           nb::sig("def add_mesh(self, name: str, arrays: dict[str, typing.Any]) -> int"))
      .def("restore_mesh", restore_mesh, nb::arg("state"),
           nb::sig("def restore_mesh(self, state: dict[str, typing.Any]) -> int"))
      .def("add_instance", add_instance, nb::arg("of"))
      .def("add_instances", add_instances, nb::arg("of"), nb::arg("poses"), nb::arg("names"),
           nb::arg("ids"))
      .def("set_object", set_object, nb::arg("index"), nb::arg("changes"),
           nb::sig("def set_object(self, index: int, changes: dict[str, typing.Any]) -> None"))
      .def("set_box_classes", set_box_classes, nb::arg("names"))
      .def("mesh", mesh_of, nb::arg("index"),
           nb::sig("def mesh(self, index: int) -> dict[str, numpy.ndarray | None]"))
      .def("set_materials", set_materials_of, nb::arg("index"), nb::arg("text"),
           nb::arg("folder") = std::filesystem::path(),
           nb::sig("def set_materials(self, index: int, text: str, folder: str = '') -> None"))
      .def("materials", materials_of, nb::arg("index"))
      .def("object", object_info, nb::arg("index"),
           nb::sig("def object(self, index: int) -> dict[str, typing.Any]"))
      .def("bounds", bounds_of)
      .def_prop_ro("class_names", [](const SceneHandle& self) { return self.scene->class_names; })
      .def_prop_ro("box_classes", [](const SceneHandle& self) { return self.box_classes; })
      .def_prop_ro("files", files_read)
      .def("drop_last", drop_last)
      .def("rig", rig_of, nb::sig("def rig(self) -> list[tuple[str, Sensor, numpy.ndarray]]"))
      .def("imus", imus_of, nb::sig("def imus(self) -> list[tuple[str, Imu, numpy.ndarray]]"))
      .def_prop_ro("gravity_m_s2", [](const SceneHandle& self) { return self.gravity_m_s2; })
      .def("rig_motion", rig_motion_of);
  module.def("length_units", length_units);
  module.def("list_parts", parts_of, nb::arg("source"), nb::arg("options"), nb::arg("log").none(),
             nb::sig("def list_parts(source: str, options: dict[str, typing.Any], "
                     "log: object | None) -> list[dict[str, typing.Any]]"));
  module.def("parse_scene", parse, nb::arg("text"), nb::arg("log").none(),
             nb::arg("folder") = std::filesystem::path(),
             nb::sig("def parse_scene(text: str, log: object | None, folder: str = '') -> Scene"));
  module.def("load_scene", load, nb::arg("path"), nb::arg("options"), nb::arg("log").none(),
             nb::sig("def load_scene(path: str, options: dict[str, typing.Any], "
                     "log: object | None) -> Scene"));
  module.def("load_scene_content", load_content, nb::arg("path"), nb::arg("content"),
             nb::arg("log").none(),
             nb::sig("def load_scene_content(path: str, content: str, log: object | None) -> "
                     "Scene"));
  bind_scene_state(module);
}

}  // namespace glidar::python
