// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/kitti_classes.hpp>

#include <glidar/io/pictures/picture.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>

namespace glidar {
namespace {

/// A name as a quoted text; JSON's are YAML's.
std::string yaml_text(const std::string& name) {
  return nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A map from each class number; `value(number)` gives the text.
template <class Value>
std::string class_map(const char* key, const Scene& scene, const Value& value) {
  std::string text = fmt::format("{}:\n", key);
  for (std::uint32_t i = 0; i < scene.class_names.size(); ++i)
    text += fmt::format("  {}: {}\n", i, value(i));
  return text;
}

/// Blue, green and red, as the API stores them.
std::string colour_text(std::uint32_t class_id) {
  if (class_id == 0) return "[0, 0, 0]";
  const Colour colour = category_colour(class_id);
  return fmt::format("[{}, {}, {}]", colour.b, colour.g, colour.r);
}

}  // namespace

std::string kitti_classes(const Scene& scene) {
  const auto number = [](std::uint32_t i) { return std::to_string(i); };
  const auto is_ignored = [](std::uint32_t i) { return i == 0 ? "True" : "False"; };
  return "name: \"glidar\"\n" +
         class_map("labels", scene,
                   [&](std::uint32_t i) { return yaml_text(scene.class_names[i]); }) +
         class_map("color_map", scene, colour_text) + class_map("learning_map", scene, number) +
         class_map("learning_map_inv", scene, number) +
         class_map("learning_ignore", scene, is_ignored) +
         "split:\n  train: [0]\n  valid: [0]\n  test: [0]\n";
}

}  // namespace glidar
