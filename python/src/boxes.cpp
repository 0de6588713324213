// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "convert.hpp"
#include "frame.hpp"
#include "report.hpp"

#include <glidar/core/output_frame.hpp>
#include <glidar/simulate/simulator.hpp>

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

std::vector<ObjectBox> find_boxes(Measured& measured, const BoxedClasses& classes) {
  PreparedScene& prepared = measured.rendered();
  Simulator simulator(*prepared.scene, measured.sensor, *prepared.renderer);
  simulator.set_boxed_classes(classes);
  return simulator.find_boxes(*measured.motion, measured.frame, BoxSelection::with_class);
}

/// The boxes of all objects, or of those of the classes; no classes: those of the scene.
std::vector<ObjectBox> boxes_of(Measured& measured, bool all,
                                const std::vector<std::string>& names) {
  return unlocked([&](Watch&) {
    if (!all && names.empty()) {
      ensure_boxes(measured);
      return measured.frame.boxes;
    }
    const Scene& scene = *measured.scene().scene;
    BoxedClasses classes(scene.class_names.size(), true);
    if (!all) classes = boxed_classes(scene.class_names, names, "classes");
    const std::lock_guard lock(measured.rendered().mutex);
    return find_boxes(measured, classes);
  });
}

/// The pose of a coordinate frame of clouds.
Matrix4 cloud_from_sensor(const Measured& measured, const std::string& frame) {
  return matrix_of(
      output_frame(frame, *measured.beams, measured.frame.world_from_sensor).cloud_from_sensor);
}

std::string class_of(const Measured& measured, const ObjectBox& box) {
  const Scene& scene = *measured.scene().scene;
  return scene.class_names.at(scene.instances.at(box.instance).class_id);
}

}  // namespace

bool lacks_boxes(const Measured& measured) {
  return !measured.has_boxes && has_classes(*measured.scene().scene);
}

void ensure_boxes(Measured& measured) {
  const std::lock_guard lock(measured.rendered().mutex);
  if (measured.has_boxes) return;
  measured.frame.boxes = find_boxes(measured, measured.rendered().boxed_classes);
  measured.has_boxes = true;
}

void bind_boxes(nb::module_& module) {
  nb::class_<ObjectBox>(module, "ObjectBox")
      .def_ro("instance", &ObjectBox::instance)
      .def_prop_ro("sensor_from_box",
                   [](const ObjectBox& self) { return matrix_of(self.sensor_from_box); })
      .def_ro("size_m", &ObjectBox::size_m)
      .def_ro("velocity_m_s", &ObjectBox::velocity_m_s)
      .def_ro("points", &ObjectBox::points)
      .def_ro("beams", &ObjectBox::beams)
      .def_ro("visible_beams", &ObjectBox::visible_beams)
      .def_prop_ro("occlusion", [](const ObjectBox& self) { return occlusion(self); });
  module.def("boxes", boxes_of, nb::arg("frame"), nb::arg("all"), nb::arg("names"));
  module.def("cloud_from_sensor", cloud_from_sensor, nb::arg("frame"), nb::arg("name"));
  module.def(
      "object_name",
      [](const Measured& measured, const ObjectBox& box) {
        return measured.scene().scene->instances.at(box.instance).name;
      },
      nb::arg("frame"), nb::arg("box"));
  module.def(
      "object_id",
      [](const Measured& measured, const ObjectBox& box) {
        return measured.scene().scene->instances.at(box.instance).id;
      },
      nb::arg("frame"), nb::arg("box"));
  module.def("object_class", class_of, nb::arg("frame"), nb::arg("box"));
}

}  // namespace glidar::python
