// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <glidar/io/config/yaml_value.hpp>

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>

namespace glidar::python {
namespace {

nb::dict dict_of(std::vector<std::pair<std::string, YamlValue>> entries) {
  nb::dict dict;
  for (auto& [key, value] : entries) dict[text_of(key)] = nb::cast(std::move(value));
  return dict;
}

const char* kind_of(const YamlValue& value) {
  constexpr std::array<const char*, 4> kNames = {"none", "text", "list", "map"};
  return kNames.at(static_cast<std::size_t>(value.kind()));
}

double number(const YamlValue& value, double min, double max, bool is_open,
              const std::string& allowed) {
  return value.number({min, max, is_open, allowed.c_str()});
}

}  // namespace

void bind_yaml(nb::module_& module) {
  nb::class_<YamlValue>(module, "YamlValue")
      .def(nb::init<const std::string&, const std::string&>(), nb::arg("file"), nb::arg("content"))
      .def_prop_ro("kind", kind_of)
      .def_prop_ro(
          "file", [](const YamlValue& self) { return text_of(self.file()); },
          nb::sig("def file(self) -> str"))
      .def_prop_ro(
          "path", [](const YamlValue& self) { return text_of(self.path()); },
          nb::sig("def path(self) -> str"))
      .def_prop_ro(
          "where", [](const YamlValue& self) { return text_of(self.where()); },
          nb::sig("def where(self) -> str"))
      .def_prop_ro(
          "description", [](const YamlValue& self) { return text_of(self.description()); },
          nb::sig("def description(self) -> str"))
      .def_prop_ro(
          "value", [](const YamlValue& self) { return text_of(self.scalar()); },
          nb::sig("def value(self) -> str"))
      .def_prop_ro("position", &YamlValue::position)
      .def("is_number", &YamlValue::is_number)
      .def("has_anchor_alias_or_tag", &YamlValue::has_anchor_alias_or_tag)
      .def("reject", &YamlValue::reject, nb::arg("found"), nb::arg("allowed") = "",
           nb::arg("remedy") = "",
           nb::sig("def reject(self, found: str, allowed: str = '', "
                   "remedy: str = '') -> typing.NoReturn"))
      .def(
          "entries", [](const YamlValue& self) { return dict_of(self.entries()); },
          nb::sig("def entries(self) -> dict[str, YamlValue]"))
      .def(
          "require_keys",
          [](const YamlValue& self, const std::vector<std::string>& known) {
            return dict_of(self.entries(known));
          },
          nb::arg("known"),
          nb::sig("def require_keys(self, known: list[str]) -> dict[str, YamlValue]"))
      .def("items", &YamlValue::items)
      .def("number", number, nb::arg("min"), nb::arg("max"), nb::arg("is_open"), nb::arg("allowed"))
      .def("boolean", &YamlValue::boolean)
      .def(
          "text", [](const YamlValue& self) { return text_of(self.text()); },
          nb::sig("def text(self) -> str"))
      .def("one_of", &YamlValue::one_of, nb::arg("words"));
  module.def("with_values", with_values, nb::arg("content"), nb::arg("replaced"));
}

}  // namespace glidar::python
