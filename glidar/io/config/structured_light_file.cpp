// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/structured_light_file.hpp>

#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <cstdint>
#include <variant>

namespace glidar {
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
