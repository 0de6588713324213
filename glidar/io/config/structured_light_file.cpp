// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/structured_light_file.hpp>

#include <glidar/io/config/yaml_field_reader.hpp>

namespace glidar {
namespace {

StructuredLight read_structured_light(const YamlField& root) {
  StructuredLight setup;
  read_struct(root, setup);
  setup.patterns.width = setup.projector.intrinsics.width;
  setup.patterns.height = setup.projector.intrinsics.height;
  return setup;
}

}  // namespace

StructuredLight load_structured_light(const std::filesystem::path& path) {
  return read_structured_light(read_yaml(path));
}

StructuredLight parse_structured_light(const std::string& text) {
  return read_structured_light(read_yaml_text("structured light", text));
}

}  // namespace glidar
