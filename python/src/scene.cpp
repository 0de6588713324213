// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include "report.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/surfaces.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>

namespace glidar::python {
namespace {

ModelOptions model_options(double metres_per_unit, const std::optional<int>& up, bool use_cache) {
  ModelOptions options;
  options.metres_per_unit = metres_per_unit;
  if (up) options.up = static_cast<Axis>(*up);
  options.use_cache = use_cache;
  return options;
}

/// A scene file with all that it names.
SceneHandle load_file(const std::filesystem::path& path, const ModelOptions& options,
                      const nb::object& log) {
  SceneFile file =
      unlocked([&](Watch& watch) { return load_scene_file(path, options, report_to(log, watch)); });
  SceneHandle handle;
  handle.scene = std::make_shared<Scene>(std::move(file.scene));
  handle.motion = std::move(file.world_from_instance);
  if (file.sensor) handle.sensor = std::make_shared<SensorHandle>(std::move(*file.sensor));
  handle.world_from_sensor = file.world_from_sensor;
  handle.looks_at = file.looks_at;
  handle.sensor_motion = std::move(file.sensor_motion);
  handle.files = std::move(file.files);
  return handle;
}

SceneHandle load(const std::filesystem::path& path, double metres_per_unit,
                 const std::optional<int>& up, bool use_cache, const nb::object& log) {
  return load_file(path, model_options(metres_per_unit, up, use_cache), log);
}

/// Whatever is added to a scene whose instances move stands still.
void add_still(SceneHandle& handle) {
  if (handle.motion.empty()) return;
  const Scene& scene = *handle.scene;
  for (std::size_t i = handle.motion.size(); i < scene.instances.size(); ++i) {
    handle.motion.emplace_back(ConstantPose{scene.instances[i].world_from_object});
  }
}

std::size_t add_model(SceneHandle& handle, const std::string& source, double metres_per_unit,
                      const std::optional<int>& up, bool use_cache, const nb::object& log) {
  const ModelOptions options = model_options(metres_per_unit, up, use_cache);
  Model model =
      unlocked([&](Watch& watch) { return load_model(source, options, report_to(log, watch)); });
  const std::size_t instance = glidar::add_model(handle.change(), std::move(model));
  add_still(handle);
  return instance;
}

using Floats3 = Table<float, 3>;

template <class Vector, class Array>
std::vector<Vector> vectors(const std::optional<Array>& given) {
  if (!given) return {};
  std::vector<Vector> result(given->shape(0));
  if (!result.empty())
    std::memcpy(static_cast<void*>(result.data()), given->data(), result.size() * sizeof(Vector));
  return result;
}

/// What a mesh is made of; arrays of one row per vertex but for the triangles.
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
  // near an origin single precision keeps every detail; at zero it is what files have
  if (count > 0 && !points.cast<float>().cast<double>().isApprox(points, 0.0)) {
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

std::size_t add_mesh(SceneHandle& handle, const std::string& name, const Table<double, 3>& vertices,
                     const Table<std::uint32_t, 3>& triangles,
                     const std::optional<Floats3>& normals,
                     const std::optional<Table<float, 2>>& uvs,
                     const std::optional<Floats3>& colours) {
  Model model;
  model.source = "array:" + name;
  model.mesh = make_mesh(name, {vertices, triangles, normals, uvs, colours});
  model.materials = {Material{}};
  const std::size_t instance = glidar::add_model(handle.change(), std::move(model));
  add_still(handle);
  return instance;
}

std::size_t add_instance(SceneHandle& handle, std::size_t of) {
  Scene& scene = handle.change();
  scene.instances.push_back(Instance(scene.instances.at(of)));
  add_still(handle);
  return scene.instances.size() - 1;
}

std::uint32_t class_number(Scene& scene, const std::string& name) {
  const auto found = std::find(scene.class_names.begin(), scene.class_names.end(), name);
  const auto number = static_cast<std::uint32_t>(found - scene.class_names.begin());
  if (found == scene.class_names.end()) scene.class_names.push_back(name);
  return number;
}

/// Sets what is given of an object.
void set_object(SceneHandle& handle, std::size_t index, const std::optional<PoseArray>& pose,
                std::optional<double> scale, const std::optional<std::string>& name,
                std::optional<std::uint32_t> id, const std::optional<std::string>& class_name) {
  Scene& scene = handle.change();
  Instance changed = scene.instances.at(index);
  if (pose) changed.world_from_object = pose_of(*pose, 0, "pose");
  if (scale) changed.scale = *scale;
  if (name) changed.name = *name;
  if (id) changed.id = *id;
  if (class_name) changed.class_id = class_number(scene, *class_name);
  std::swap(scene.instances[index], changed);
  try {
    validate(scene);
  } catch (...) {
    std::swap(scene.instances[index], changed);
    throw;
  }
  if (pose && !handle.motion.empty()) {
    handle.motion[index] = ConstantPose{scene.instances[index].world_from_object};
  }
}

nb::dict object_info(const SceneHandle& handle, std::size_t index) {
  const Scene& scene = *handle.scene;
  const Instance& instance = scene.instances.at(index);
  nb::dict info;
  info["name"] = instance.name;
  info["id"] = instance.id;
  info["class_name"] = scene.class_names.at(instance.class_id);
  info["pose"] = nb::cast(matrix_of(instance.world_from_object));
  info["scale"] = instance.scale;
  info["source"] = scene.sources.at(instance.mesh).path;
  info["triangles"] = scene.meshes.at(instance.mesh).triangles.size();
  info["vertices"] = scene.meshes.at(instance.mesh).positions_m.size();
  return info;
}

template <class T>
using Rows3 = Eigen::Matrix<T, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The corners of the object's mesh in its own frame, before scale.
Rows3<double> vertices_m(const SceneHandle& handle, std::size_t index) {
  const Scene& scene = *handle.scene;
  const Mesh& mesh = scene.meshes.at(scene.instances.at(index).mesh);
  Rows3<double> rows(static_cast<Eigen::Index>(mesh.positions_m.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::Vector3f& position = mesh.positions_m[static_cast<std::size_t>(i)];
    rows.row(i) = (mesh.origin_m + position.cast<double>()).transpose();
  }
  return rows;
}

Rows3<std::uint32_t> faces(const SceneHandle& handle, std::size_t index) {
  const Scene& scene = *handle.scene;
  const Mesh& mesh = scene.meshes.at(scene.instances.at(index).mesh);
  Rows3<std::uint32_t> rows(static_cast<Eigen::Index>(mesh.triangles.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(i)];
    rows.row(i) << triangle[0], triangle[1], triangle[2];
  }
  return rows;
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

std::shared_ptr<PreparedScene> prepare(SceneHandle& handle, const RendererOptions& options) {
  const std::pair key(options.kind, options.threads);
  if (const auto found = handle.prepared.find(key); found != handle.prepared.end()) {
    return found->second;
  }
  auto made = std::make_shared<PreparedScene>();
  made->scene = handle.scene;
  {
    const nb::gil_scoped_release release;
    made->renderer = make_renderer(*made->scene, options);
  }
  if (made->scene == handle.scene) handle.prepared[key] = made;  // nobody changed it meanwhile
  return made;
}

void bind_scene(nb::module_& module) {
  nb::class_<SceneHandle>(module, "Scene")
      .def(nb::init<>())
      .def("__len__", [](const SceneHandle& self) { return self.scene->instances.size(); })
      .def("add_model", add_model, nb::arg("source"), nb::arg("metres_per_unit"),
           nb::arg("up").none(), nb::arg("use_cache"), nb::arg("log").none())
      .def("add_mesh", add_mesh, nb::arg("name"), nb::arg("vertices"), nb::arg("triangles"),
           nb::arg("normals").none(), nb::arg("uvs").none(), nb::arg("colours").none())
      .def("add_instance", add_instance, nb::arg("of"))
      .def("set_object", set_object, nb::arg("index"), nb::arg("pose").none(),
           nb::arg("scale").none(), nb::arg("name").none(), nb::arg("id").none(),
           nb::arg("class_name").none())
      .def("object", object_info, nb::arg("index"))
      .def("vertices_m", vertices_m, nb::arg("index"))
      .def("faces", faces, nb::arg("index"))
      .def("bounds", bounds_of)
      .def_prop_ro("class_names", [](const SceneHandle& self) { return self.scene->class_names; })
      .def_prop_ro("files", [](const SceneHandle& self) { return self.files; })
      .def_prop_ro(
          "sensor", [](const SceneHandle& self) { return self.sensor; },
          nb::sig("def sensor(self) -> Sensor | None"));
  module.def("load_scene", load, nb::arg("path"), nb::arg("metres_per_unit"), nb::arg("up").none(),
             nb::arg("use_cache"), nb::arg("log").none());
}

}  // namespace glidar::python
