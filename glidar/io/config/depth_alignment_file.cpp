// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/depth_alignment_file.hpp>

#include <glidar/io/config/yaml_field_reader.hpp>

namespace glidar {
namespace {

DepthAlignment read_depth_alignment(const YamlField& root) {
  DepthAlignment alignment;
  read_struct(root, alignment);
  return alignment;
}

}  // namespace

DepthAlignment load_depth_alignment(const std::filesystem::path& path) {
  return read_depth_alignment(read_yaml(path));
}

DepthAlignment parse_depth_alignment(const std::string& text) {
  return read_depth_alignment(read_yaml_text("depth alignment", text));
}

}  // namespace glidar
