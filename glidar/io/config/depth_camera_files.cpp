// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/depth_camera_files.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <cstdint>
#include <sstream>
#include <variant>

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

namespace {

struct DepthFilterList {
  std::vector<DepthFilter> filters;
};

void describe(DepthFilterList& list, FieldVisitor& visitor) {
  visit_list(visitor, {"depth_filters", "in their order"}, {0, kMaxDepthFilters},
             "at most 64 filters", list.filters);
}

}  // namespace

std::vector<DepthFilter> parse_depth_filters(const std::string& text) {
  DepthFilterList list;
  read_struct(read_yaml_text("depth filters", text), list);
  return list.filters;
}

DepthFilter parse_depth_filter(const std::string& text) {
  std::istringstream words(text);
  std::string word;
  std::getline(words, word, ',');
  std::string map = "type: " + word + "\n";
  while (std::getline(words, word, ',')) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw Error({"", "'" + excerpt(word) + "' is no setting of a filter", "KEY=VALUE",
                   "write, for example, spatial,alpha=0.6,delta=8"});
    }
    map += word.substr(0, equals) + ": " + word.substr(equals + 1) + "\n";
  }
  DepthFilter filter;
  read_struct(read_yaml_text("depth filter '" + excerpt(text) + "'", map), filter);
  return filter;
}

std::string depth_filters_document(const std::vector<DepthFilter>& filters) {
  return write_struct(FieldVisitor::Mode::document, DepthFilterList{filters}).dump();
}

namespace {

StructuredLight read_structured_light(const YamlField& root) {
  StructuredLight setup;
  read_struct(root, setup);
  return setup;
}

/// A sensor file has all keys of a setup.
bool is_sensor(const YamlField& root) {
  return root.node["depth_camera"].IsDefined();
}

/// Levels of 9 to 15 bits are stored as 16 bits, whose greatest level they do not reach.
void set_saturation_level(const Imager& imager, FringeDecoding& decoding) {
  const bool fills_its_type = imager.bits == 8 || imager.bits == 16;
  if (decoding.saturation_level > 0 || fills_its_type) return;
  decoding.saturation_level = (std::uint32_t{1} << imager.bits) - 1;
}

StructuredLight setup_of_sensor(const std::string& source, const Sensor& sensor) {
  const auto* camera = std::get_if<StructuredLightCamera>(&*sensor.depth_camera);
  if (camera != nullptr) {
    StructuredLight setup = setup_of(*camera, std::get<Pinhole>(sensor.optics));
    set_saturation_level(camera->imager, setup.decoding);
    return setup;
  }
  throw Error({.where = source + ": depth_camera",
               .found = "a sensor that projects no patterns",
               .allowed = "type: structured_light",
               .remedy = "use another sensor file, or a setup with camera and projector"});
}

}  // namespace

StructuredLight load_structured_light(const std::filesystem::path& path) {
  const YamlField root = read_yaml(path);
  if (is_sensor(root)) return setup_of_sensor(path.string(), load_sensor_file(path));
  return read_structured_light(root);
}

StructuredLight parse_structured_light(const std::string& text) {
  const YamlField root = read_yaml_text("structured light", text);
  if (is_sensor(root)) return setup_of_sensor("structured light", parse_sensor(text));
  return read_structured_light(root);
}

}  // namespace glidar
