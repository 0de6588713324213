// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the library: reads JSON that GLIDAR wrote. The texts of errors are its own, because
// those of the JSON library depend on its version.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Throws an Error about what was found in the file, such as "the key 'folder' is missing in
/// 'command'".
using RefuseJson = std::function<void(const std::string& found)>;

/// Parses a text; `where` is its file, and line where it has many. Refuses text that is no JSON,
/// with the place.
nlohmann::json parse_own_json(const std::string& where, std::string_view text,
                              const RefuseJson& refuse);

/// A value of a parsed file and its place in it, such as "command.folder". Values that are missing
/// or have another type are refused.
class JsonValue {
 public:
  /// Both must outlive the value and those made of it.
  JsonValue(const nlohmann::json& json, const RefuseJson& refuse)
      : json_(&json), refuse_(&refuse) {}

  [[nodiscard]] bool contains(const char* key) const;
  [[nodiscard]] JsonValue at(const char* key) const;
  [[nodiscard]] std::vector<JsonValue> items() const;

  [[nodiscard]] bool is_null() const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::vector<std::string> texts() const;
  [[nodiscard]] std::vector<double> numbers() const;
  [[nodiscard]] std::int64_t integer() const;
  /// A whole number from 0 to `max`.
  [[nodiscard]] std::uint64_t count(std::uint64_t max) const;
  template <class Count>
  [[nodiscard]] Count count() const {
    return static_cast<Count>(count(std::numeric_limits<Count>::max()));
  }
  /// The value as the file has it, cut if it is long.
  [[nodiscard]] std::string shown() const;

  /// Refuses the value, with its place.
  [[noreturn]] void refuse(const std::string& found) const;

 private:
  JsonValue inner(const nlohmann::json& json, const std::string& name) const;
  [[noreturn]] void refuse_type(const char* wanted) const;

  const nlohmann::json* json_;
  const RefuseJson* refuse_;
  std::string place_;
};

}  // namespace glidar
