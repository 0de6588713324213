// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/json_members.hpp>

#include <glidar/core/error.hpp>

#include <nlohmann/json.hpp>

namespace glidar::foxglove {

nlohmann::json parse_object(std::string_view text, const std::string& where) {
  nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
  if (!value.is_object()) {
    throw Error({.where = where,
                 .found = value.is_discarded() ? "invalid JSON" : "JSON that is not an object",
                 .allowed = "a JSON object"});
  }
  return value;
}

const nlohmann::json& member(const nlohmann::json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (found == object.end()) {
    throw Error({.where = "received JSON", .found = std::string("no member '") + name + "'"});
  }
  return *found;
}

std::string text_member(const nlohmann::json& object, const char* name, std::size_t max_bytes) {
  const nlohmann::json& value = member(object, name);
  const auto* text = value.get_ptr<const std::string*>();
  if (text == nullptr || text->size() > max_bytes) {
    throw Error({.where = std::string("received JSON, ") + name,
                 .found = text == nullptr ? "no text" : std::to_string(text->size()) + " bytes",
                 .allowed = "a text of at most " + std::to_string(max_bytes) + " bytes"});
  }
  return *text;
}

std::uint64_t whole_number(const nlohmann::json& value, const char* name, std::uint64_t max) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > max) {
    throw Error({.where = std::string("received JSON, ") + name,
                 .found = "no whole number in range",
                 .allowed = "0 to " + std::to_string(max)});
  }
  return value.get<std::uint64_t>();
}

std::string compact_text(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace glidar::foxglove
