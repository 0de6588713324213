// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/document.hpp>

#include <import/gltf/schema.hpp>
#include <import/source_model.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <set>
#include <utility>

namespace glidar::import::gltf {
namespace {

constexpr std::size_t kMaxDepth = 64;  // of the JSON; the standard's own objects have 8

/// Version 1 (2015) has other objects and shaders.
[[noreturn]] void refuse_version(const std::string& version, const std::string& member = "") {
  throw Refusal{member + "glTF version " + version + ": GLIDAR reads version 2",
                "convert it to version 2: gltf-pipeline -i MODEL -o NEW.glb, or import it in "
                "Blender and export it"};
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// Takes a chunk of a .glb file (glTF 2.0, 4.4.3) off `rest`; its type is `type`.
std::string_view take_chunk(std::string_view& rest, std::uint32_t& type) {
  constexpr std::size_t kHead = 8;
  if (rest.size() < kHead) refuse("chunk", "it is cut off: the file ends in its header");
  const std::size_t size = word_at(rest, 0);
  type = word_at(rest, 4);
  rest.remove_prefix(kHead);
  if (size > rest.size()) {
    refuse("chunk", fmt::format("it is cut off: {} bytes are stated, {} are left in the file", size,
                                rest.size()));
  }
  const std::string_view chunk = rest.substr(0, size);
  rest.remove_prefix(size);
  return chunk;
}

/// The text of a .glb file; sets the binary chunk.
std::string_view open_binary(std::string_view file, Document& document) {
  constexpr std::size_t kHead = 12;
  constexpr std::uint32_t kJson = 0x4E4F'534A;
  constexpr std::uint32_t kBinary = 0x004E'4942;
  if (file.size() < kHead) refuse("header", "it is cut off: a .glb file has at least 12 bytes");
  const std::uint32_t version = word_at(file, 4);
  if (version != 2) refuse_version(std::to_string(version));
  const std::size_t size = word_at(file, 8);
  if (size < kHead || size > file.size()) {
    refuse("header", fmt::format("its length is {} bytes, the file has {}", size, file.size()));
  }
  if (size < file.size()) {
    document.notes.add(
        fmt::format("{} bytes after the end of the .glb data are left out", file.size() - size));
  }
  std::string_view rest = file.substr(kHead, size - kHead);
  std::uint32_t type = 0;
  const std::string_view text = take_chunk(rest, type);
  if (type != kJson) refuse("chunk", "the first one is not of the type JSON");
  for (bool is_second = true; !rest.empty(); is_second = false) {
    const std::string_view chunk = take_chunk(rest, type);
    if (type == kJson) refuse("chunk", "there are two of the type JSON");
    if (type == kBinary && !is_second) refuse("chunk", "a binary one is not the second");
    if (type == kBinary) {
      document.chunk = chunk;
      document.has_chunk = true;
    } else {
      document.notes.add(fmt::format("a chunk of the unknown type {:#010x} is left out", type));
    }
  }
  return text;
}

/// Rejects deep nesting, and names that occur twice in an object, of which one would be dropped.
class StrictObjects {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    const auto level = static_cast<std::size_t>(depth);
    if (level > kMaxDepth) refuse("JSON", fmt::format("more than {} levels", kMaxDepth));
    if (event == Json::parse_event_t::object_start) {
      names_.resize(std::max(names_.size(), level + 2));
      names_[level + 1].clear();
    } else if (event == Json::parse_event_t::key) {
      const std::string& name = parsed.get_ref<const std::string&>();
      if (!names_.at(level).insert(name).second) {
        refuse("JSON", "an object has the name " + in_quotes(name) + " twice");
      }
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> names_;  ///< of the open object at each level
};

Json parse_json(std::string_view text) {
  StrictObjects strict;
  try {
    return Json::parse(text, std::ref(strict));
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
    throw Refusal{fmt::format("its JSON cannot be read: an error in line {}, at byte {}", line, at),
                  "the file is damaged or cut off: export it again"};
  } catch (const Json::exception&) {
    throw Refusal{"its JSON cannot be read: a number is too large", "export the file again"};
  }
}

void check_version(const Document& document) {
  if (!document.json.is_object()) refuse("JSON", "it is not an object");
  const Value asset = document.root()["asset"];
  const Json& all = document.json;
  const bool is_first = all.contains("meshes") && all["meshes"].is_object();  // lists by name
  if (is_first) refuse_version("1.0");
  const std::string version = asset ? asset.required("version").text() : "";
  if (!asset) refuse("asset", "it is missing, so the version of glTF is unknown");
  if (!version.starts_with("2.")) refuse_version(in_quotes(version));
  const std::string least = asset["minVersion"].text_or("2.0");
  if (least != "2.0") refuse_version(in_quotes(least), "asset.minVersion: ");
}

}  // namespace

void refuse(const std::string& path, const std::string& found, const std::string& remedy) {
  throw Refusal{(path.empty() ? "JSON" : path) + ": " + found, remedy};
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  const bool is_longer = text.size() > kLongest;
  return fmt::format("'{}{}'", text.substr(0, kLongest), is_longer ? "..." : "");
}

void Value::require() const {
  if (json_ == nullptr) refuse("it is missing");
}

Value Value::operator[](const char* key) const {
  const std::string path = path_.empty() ? key : path_ + "." + key;
  Value member;
  member.path_ = path;
  if (json_ == nullptr) return member;
  if (!json_->is_object()) refuse("it is not an object");
  const auto found = json_->find(key);
  return found == json_->end() ? member : Value(*found, path);
}

Value Value::required(const char* key) const {
  Value member = (*this)[key];
  member.require();
  return member;
}

Value Value::at(std::size_t index) const {
  if (index >= size()) refuse(fmt::format("it has no element {}", index));
  return {(*json_)[index], fmt::format("{}[{}]", path_, index)};
}

std::size_t Value::size() const {
  if (json_ == nullptr) return 0;
  if (!json_->is_array()) refuse("it is not an array");
  return json_->size();
}

Value Value::extension(const char* name) const {
  return (*this)["extensions"][name];
}

std::vector<std::pair<std::string, Value>> Value::members() const {
  std::vector<std::pair<std::string, Value>> all;
  if (json_ == nullptr) return all;
  if (!json_->is_object()) refuse("it is not an object");
  for (const auto& [name, value] : json_->items()) {
    all.emplace_back(name, Value(value, path_ + "." + name.substr(0, 80)));
  }
  return all;
}

double Value::number() const {
  require();
  if (!json_->is_number()) refuse("it is not a number");
  return json_->get<double>();
}

double Value::number_or(double fallback) const {
  return json_ == nullptr ? fallback : number();
}

std::size_t Value::count() const {
  constexpr double kLargest = 9'007'199'254'740'992.0;
  const double value = number();
  if (!(value >= 0.0) || value > kLargest || value != std::floor(value)) {
    refuse(fmt::format("{} is not an integer from 0", value));
  }
  return static_cast<std::size_t>(value);
}

std::size_t Value::count_or(std::size_t fallback) const {
  return json_ == nullptr ? fallback : count();
}

bool Value::flag_or(bool fallback) const {
  if (json_ == nullptr) return fallback;
  if (!json_->is_boolean()) refuse("it is neither true nor false");
  return json_->get<bool>();
}

std::string Value::text() const {
  require();
  if (!json_->is_string()) refuse("it is not a text");
  return json_->get<std::string>();
}

std::string Value::text_or(const char* fallback) const {
  return json_ == nullptr ? fallback : text();
}

std::vector<double> Value::numbers(std::size_t count) const {
  require();
  if (size() != count) refuse(fmt::format("{} numbers, {} are needed", size(), count));
  std::vector<double> all;
  for (std::size_t i = 0; i < count; ++i) {
    const Json& number = (*json_)[i];
    if (!number.is_number()) refuse(fmt::format("element {} is not a number", i));
    all.push_back(number.get<double>());
  }
  return all;
}

std::vector<double> Value::numbers_or(const std::vector<double>& fallback) const {
  return json_ == nullptr ? fallback : numbers(fallback.size());
}

std::size_t Document::number(const char* list, const Value& index) const {
  const std::size_t wanted = index.count();
  const std::size_t size = root()[list].size();
  if (wanted >= size) {
    index.refuse(fmt::format("there is no {}[{}], the file has {}", list, wanted, size));
  }
  return wanted;
}

Value Document::target(const char* list, const Value& index) const {
  return root()[list].at(number(list, index));
}

Document parse(std::string_view file) {
  Document document;
  const bool is_binary = file.starts_with("glTF");
  document.json = parse_json(is_binary ? open_binary(file, document) : file);
  check_version(document);
  check_extensions(document);
  note_unused(document);
  return document;
}

}  // namespace glidar::import::gltf
