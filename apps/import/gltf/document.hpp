// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidar::import::gltf {

using Json = nlohmann::json;

/// Throws Refusal: "PATH: FOUND".
[[noreturn]] void refuse(const std::string& path, const std::string& found,
                         const std::string& remedy = "repair the file, or export it again");

/// Text of the file for a message: short, and quoted.
std::string in_quotes(std::string_view text);

/// A value of the document, with its path for errors ("meshes[0].primitives[1].indices"). Reading a
/// value of another type throws Refusal with the path.
class Value {
 public:
  Value() = default;
  Value(const Json& json, std::string path) : json_(&json), path_(std::move(path)) {}

  explicit operator bool() const { return json_ != nullptr; }  ///< it exists
  [[nodiscard]] const std::string& path() const { return path_; }
  /// A member of an object; one that does not exist if it is absent.
  Value operator[](const char* key) const;
  /// A member that must exist.
  [[nodiscard]] Value required(const char* key) const;
  /// Throws Refusal if it does not exist.
  void require() const;
  /// An element of an array.
  [[nodiscard]] Value at(std::size_t index) const;
  /// Elements of an array; 0 if it is absent.
  [[nodiscard]] std::size_t size() const;
  /// An extension of an object; one that does not exist if it is absent.
  [[nodiscard]] Value extension(const char* name) const;
  /// Names and values of an object's members; none if it is absent.
  [[nodiscard]] std::vector<std::pair<std::string, Value>> members() const;

  [[nodiscard]] double number() const;  ///< finite
  [[nodiscard]] double number_or(double fallback) const;
  [[nodiscard]] std::size_t count() const;  ///< an integer from 0 to 2^53
  [[nodiscard]] std::size_t count_or(std::size_t fallback) const;
  [[nodiscard]] bool flag_or(bool fallback) const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string text_or(const char* fallback) const;
  /// Exactly `count` numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
  /// The same; `fallback` if it is absent.
  [[nodiscard]] std::vector<double> numbers_or(const std::vector<double>& fallback) const;

  [[noreturn]] void refuse(const std::string& found) const { gltf::refuse(path_, found); }

 private:
  const Json* json_ = nullptr;
  std::string path_;
};

/// A glTF 2.0 document (Khronos Group, glTF 2.0 Specification, 2.0.1).
struct Document {
  Json json;
  std::string_view chunk;  ///< the binary chunk of a .glb file, a part of the file's bytes
  bool has_chunk = false;
  Notes notes;

  [[nodiscard]] Value root() const { return {json, ""}; }
  /// The element of a top-level list that `index` names.
  [[nodiscard]] Value target(const char* list, const Value& index) const;
  /// The number of that element, which exists.
  [[nodiscard]] std::size_t number(const char* list, const Value& index) const;
};

/// Reads the container and the JSON of a .gltf or .glb file, whose bytes must outlive the document;
/// checks version and extensions. What GLIDAR does not use is named in notes.
/// Throws Refusal for a file that is not glTF 2.0, or that requires another extension.
Document parse(std::string_view file);

}  // namespace glidar::import::gltf
