// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/json_value.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/config/json_text.hpp>

#include <algorithm>
#include <cstdlib>

namespace glidar {
namespace {

const char* type_text(const nlohmann::json& json) {
  if (json.is_object()) return "an object";
  if (json.is_array()) return "a list";
  if (json.is_string()) return "a text";
  if (json.is_number()) return "a number";
  if (json.is_boolean()) return "true or false";
  return "null";
}

/// Where the text is not valid, by the byte that the parser read last, from 1.
std::string syntax_text(std::string_view text, std::size_t byte) {
  const bool is_blank = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
  const bool is_early = is_blank || byte > text.size();
  const std::string_view before =
      text.substr(0, is_early ? text.size() : std::max<std::size_t>(byte, 1) - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  const std::string place =
      (line == 1 ? "" : "line " + std::to_string(line) + ", ") + "column " + std::to_string(column);
  return is_early ? "its text ends too early, at " + place
                  : "its text is not valid JSON from " + place + " on";
}

}  // namespace

nlohmann::json parse_own_json(const std::string& where, std::string_view text,
                              const RefuseJson& refuse) {
  try {
    return parse_json<nlohmann::json>(where, text);
  } catch (const nlohmann::json::parse_error& error) {
    refuse(syntax_text(text, error.byte));
  } catch (const nlohmann::json::exception&) {  // the only other one of the parser
    refuse("a number is too large");
  }
  std::abort();  // it throws
}

bool JsonValue::contains(const char* key) const {
  return json_->contains(key);
}

JsonValue JsonValue::at(const char* key) const {
  if (!json_->is_object()) refuse_type("an object");
  const auto found = json_->find(key);
  if (found != json_->end()) return inner(*found, key);
  (*refuse_)("the key '" + std::string(key) + "' is missing" +
             (place_.empty() ? "" : " in '" + place_ + "'"));
  std::abort();  // it throws
}

std::vector<JsonValue> JsonValue::items() const {
  if (!json_->is_array()) refuse_type("a list");
  std::vector<JsonValue> items;
  for (const nlohmann::json& item : *json_)
    items.push_back(inner(item, std::to_string(items.size())));
  return items;
}

bool JsonValue::is_null() const {
  return json_->is_null();
}

std::string JsonValue::text() const {
  if (!json_->is_string()) refuse_type("a text");
  return json_->get<std::string>();
}

std::vector<std::string> JsonValue::texts() const {
  std::vector<std::string> texts;
  for (const JsonValue& item : items()) texts.push_back(item.text());
  return texts;
}

std::vector<double> JsonValue::numbers() const {
  if (!json_->is_array()) refuse_type("a list");
  std::vector<double> numbers;
  for (const nlohmann::json& item : *json_) {
    if (!item.is_number()) inner(item, std::to_string(numbers.size())).refuse_type("a number");
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

std::int64_t JsonValue::integer() const {
  constexpr std::uint64_t kMax = std::numeric_limits<std::int64_t>::max();
  const bool fits = json_->is_number_unsigned() ? json_->get<std::uint64_t>() <= kMax
                                                : json_->is_number_integer();
  if (!fits) refuse(shown() + " is not a whole number of 64 bits");
  return json_->get<std::int64_t>();
}

std::uint64_t JsonValue::count(std::uint64_t max) const {
  if (json_->is_number_unsigned() && json_->get<std::uint64_t>() <= max)
    return json_->get<std::uint64_t>();
  refuse(shown() + " is not a count");
}

std::string JsonValue::shown() const {
  return shown_json(*json_);
}

void JsonValue::refuse(const std::string& found) const {
  (*refuse_)(place_.empty() ? found : place_ + ": " + found);
  std::abort();  // it throws
}

JsonValue JsonValue::inner(const nlohmann::json& json, const std::string& name) const {
  JsonValue value(json, *refuse_);
  value.place_ = place_.empty() ? name : place_ + "." + name;
  return value;
}

void JsonValue::refuse_type(const char* wanted) const {
  const std::string place = place_.empty() ? "" : " in '" + place_ + "'";
  (*refuse_)("a value of another type" + place + ": " + type_text(*json_) + " instead of " +
             wanted);
  std::abort();  // it throws
}

}  // namespace glidar
