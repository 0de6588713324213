// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor.hpp"

#include "convert.hpp"

#include <glidar/io/sensor_file.hpp>
#include <glidar/io/sensor_presets.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace glidar::python {
namespace {

using Shared = std::shared_ptr<SensorHandle>;

Shared make(Sensor sensor) {
  const nb::gil_scoped_release release;
  return std::make_shared<SensorHandle>(std::move(sensor));
}

Shared load(const std::string& name_or_path) {
  return make(load_sensor_file(find_sensor_file(name_or_path)));
}

Shared parse(const std::string& text) {
  return make(parse_sensor(text));
}

Shared made_ideal(const SensorHandle& handle) {
  return make(ideal(handle.sensor()));
}

/// An array of one number, or one vector, per beam.
template <class T, class Values, class Shape>
nb::object per_beam(const Values& values, const Shape& shape, nb::handle owner) {
  const T* data = values.empty() ? nullptr : reinterpret_cast<const T*>(values.data());
  return nb::cast(array_at(data, shape, owner));
}

nb::object directions(const nb::handle& self) {
  const auto beams = nb::cast<const SensorHandle&>(self).beams(0);
  const std::array<std::size_t, 3> shape = {beams->rows, beams->cols, 3};
  return per_beam<double>(beams->directions, shape, self);
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : preset_files()) names.push_back(file.stem().string());
  return names;
}

}  // namespace

SensorHandle::SensorHandle(Sensor sensor)
    : sensor_(std::move(sensor)), first_(std::make_shared<const Beams>(make_beams(sensor_))) {}

std::shared_ptr<const Beams> SensorHandle::beams(std::uint32_t number) const {
  if (number == 0 || std::holds_alternative<Pinhole>(sensor_.optics)) return first_;
  const std::lock_guard lock(mutex_);
  if (last_number_ != number) {
    last_ = std::make_shared<const Beams>(make_beams(sensor_, scan_window(sensor_, number)));
    last_number_ = number;
  }
  return last_;
}

void bind_sensor(nb::module_& module) {
  nb::class_<SensorHandle>(module, "Sensor")
      .def_prop_ro("name", [](const SensorHandle& self) { return self.sensor().name; })
      .def_prop_ro("rate_hz", [](const SensorHandle& self) { return self.sensor().rate_hz; })
      .def_prop_ro("kind", [](const SensorHandle& self) { return self.sensor().optics.index(); })
      .def_prop_ro("rows", [](const SensorHandle& self) { return self.beams(0)->rows; })
      .def_prop_ro("cols", [](const SensorHandle& self) { return self.beams(0)->cols; })
      .def_prop_ro("returns", [](const SensorHandle& self) { return self.beams(0)->returns; })
      .def_prop_ro("frame_id", [](const SensorHandle& self) { return self.beams(0)->frame_id; })
      .def_prop_ro("directions", directions)
      .def("ideal", made_ideal);
  module.def("load_sensor", load, nb::arg("name_or_path"));
  module.def("parse_sensor", parse, nb::arg("text"));
  module.def("sensor_file", find_sensor_file, nb::arg("name_or_path"));
  module.def("preset_names", preset_names);
}

}  // namespace glidar::python
