// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mtl_reader.hpp>

#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace glidar::import {
namespace {

constexpr float kMaxExponent = 128.0F;

/// Removes and returns the first word of the text.
std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(kWhiteSpace));
  text.remove_prefix(word.size());
  return word;
}

/// Removes and returns a number at the start of the text.
std::optional<float> next_number(std::string_view& text) {
  std::string_view rest = text;
  const auto number = number_in(next_word(rest));
  const auto value = static_cast<float>(number.value_or(kNaN));
  if (!std::isfinite(value)) return std::nullopt;
  text = rest;
  return value;
}

/// The text before a comment, which begins with a word.
std::string_view without_comment(std::string_view text) {
  if (text.starts_with('#')) return "";
  return trimmed(text.substr(0, std::min(text.find(" #"), text.find("\t#"))));
}

/// A texture statement: its options and the name of its file.
struct MapStatement {
  std::string name;
  Eigen::Vector2f scale = Eigen::Vector2f::Ones();
  Eigen::Vector2f offset = Eigen::Vector2f::Zero();
  std::optional<float> bump;
  bool clamp = false;
  std::vector<std::string> unused;  ///< options
};

/// One to three numbers; the third is for 3D textures.
void next_pair(std::string_view& text, Eigen::Vector2f& pair) {
  for (int i = 0; i < 3; ++i) {
    const auto value = next_number(text);
    if (!value) return;
    if (i < 2) pair[i] = *value;
  }
}

/// Removes an option with its values from the text. False if it is not an option.
bool parse_option(std::string_view& text, MapStatement& map) {
  // With their values where they have no effect.
  static const std::map<std::string, std::string, std::less<>> kOneWord = {
      {"-blendu", "on"}, {"-blendv", "on"}, {"-cc", "off"}, {"-texres", ""},
      {"-boost", ""},    {"-imfchan", "l"}, {"-type", ""},  {"-colorspace", ""}};
  const std::string option = lower_case(next_word(text));
  if (option == "-s") {
    next_pair(text, map.scale);
  } else if (option == "-o") {
    next_pair(text, map.offset);
  } else if (option == "-t" || option == "-mm") {
    Eigen::Vector2f values = option == "-t" ? Eigen::Vector2f(0, 0) : Eigen::Vector2f(0, 1);
    const Eigen::Vector2f without_effect = values;
    next_pair(text, values);
    if (values != without_effect) map.unused.push_back(option);
  } else if (option == "-bm") {
    map.bump = next_number(text);
  } else if (option == "-clamp") {
    map.clamp = lower_case(next_word(text)) == "on";
  } else if (const auto known = kOneWord.find(option); known != kOneWord.end()) {
    if (lower_case(next_word(text)) != known->second) map.unused.push_back(option);
  } else {
    return false;
  }
  return true;
}

/// Options are before the name, in some files after it.
void parse_options(std::string_view& text, MapStatement& map) {
  for (;;) {
    std::string_view rest = text;
    if (!parse_option(rest, map)) return;
    text = rest;
  }
}

MapStatement parse_map(std::string_view text) {
  MapStatement map;
  parse_options(text, map);
  text = trimmed(text);
  for (std::size_t at = text.find(" -"); at != std::string_view::npos;
       at = text.find(" -", at + 1)) {
    std::string_view tail = text.substr(at);
    MapStatement with_tail = map;
    parse_options(tail, with_tail);
    if (!trimmed(tail).empty()) continue;  // a part of the name
    map = std::move(with_tail);
    text = text.substr(0, at);
    break;
  }
  map.name = trimmed(trimmed(text), "\"");
  return map;
}

}  // namespace

void MtlReader::note_line(const std::string& what) {
  source_.notes.add_at(fmt::format("{}, line {}", file_, line_), what);
}

void MtlReader::begin_material(std::string_view name) {
  const auto [entry, is_new] = entries_.try_emplace(std::string(name));
  if (!is_new) note_line("material '" + shown(name) + "' is defined again: both parts count");
  current_ = &entry->second;
  if (!is_new) return;
  current_->number = source_.materials.size();
  SourceMaterial& added = source_.materials.emplace_back();
  if (!name.empty()) added.material.name = std::string(name);
}

void MtlReader::read_colour(std::string_view text, const std::string& keyword,
                            Eigen::Vector3f& colour, bool& is_given) {
  std::array<float, 3> rgb{};
  std::size_t count = 0;
  text = without_comment(text);
  const std::string line(text);
  while (count < rgb.size()) {
    const auto value = next_number(text);
    if (!value) break;
    rgb[count++] = *value;
  }
  if (!trimmed(text).empty() || count == 0 || count == 2) {
    return note_line("'" + shown(keyword + " " + line) + "' is not used: not one or three numbers");
  }
  is_given = true;
  // One number is a grey (MTL specification).
  colour = count == 1 ? Eigen::Vector3f::Constant(rgb[0]).eval()
                      : Eigen::Vector3f(rgb[0], rgb[1], rgb[2]);
  colour = colour.cwiseMax(0.0F).cwiseMin(1.0F);
}

void MtlReader::read_number(std::string_view text, const std::string& keyword, float& number,
                            float most) {
  text = without_comment(text);
  const std::string line(text);
  if (text.starts_with("-halo")) {
    unused_.insert("d -halo");
    text.remove_prefix(5);
  }
  const auto value = next_number(text);
  if (!value || !trimmed(text).empty()) {
    return note_line("'" + shown(keyword + " " + line) + "' is not used: not a number");
  }
  number = std::clamp(*value, 0.0F, most);
}

/// False if the keyword names no texture that is used.
bool MtlReader::read_map(const std::string& keyword, std::string_view text) {
  SourceMaterial& m = source_.materials[current_->number];
  const std::map<std::string_view, std::optional<NamedTexture>*> uses = {
      {"map_kd", &m.diffuse},   {"map_ks", &m.specular}, {"map_d", &m.opacity},
      {"map_bump", &m.normals}, {"bump", &m.normals},    {"norm", &m.normals},
      {"map_kn", &m.normals}};
  const auto use = uses.find(keyword);
  if (use == uses.end()) return false;
  MapStatement map = parse_map(text);
  if (map.name.empty()) {
    note_line("'" + shown(keyword) + "' names no file");
    return true;
  }
  for (const std::string& option : map.unused) {
    unused_.insert(std::string(keyword).append(" ").append(option));
  }
  // A normal map has precedence over heights.
  const bool is_heights = keyword.ends_with("bump");
  if (is_heights && m.normals && has_normal_map_.contains(current_->number)) {
    unused_.insert(keyword + " beside norm");
    return true;
  }
  if (use->second == &m.normals && !is_heights) has_normal_map_.insert(current_->number);
  NamedTexture& texture = use->second->emplace();
  texture.name = map.name;
  texture.bump = map.bump;
  texture.use.uv_scale_rotate = map.scale.asDiagonal();
  texture.use.uv_offset = map.offset;
  if (map.clamp) texture.use.wrap_u = texture.use.wrap_v = Wrap::clamp;
  return true;
}

void MtlReader::read_statement(std::string_view word, std::string_view text) {
  if (lower_case(word) == "newmtl") return begin_material(text);
  if (current_ == nullptr) return note_line("'" + shown(word) + "' before 'newmtl' is not used");
  const std::string keyword = lower_case(word);
  Material& m = source_.materials[current_->number].material;
  bool is_given = false;
  if (keyword == "kd") {
    read_colour(text, keyword, m.diffuse, current_->has_diffuse);
  } else if (keyword == "ka") {
    read_colour(text, keyword, m.ambient, current_->has_ambient);
  } else if (keyword == "ks") {
    read_colour(text, keyword, m.specular, is_given);
  } else if (keyword == "ns") {
    read_number(text, keyword, m.shininess, kMaxExponent);
  } else if (keyword == "d") {
    read_number(text, keyword, m.opacity, 1.0F);
  } else if (keyword == "tr") {
    float transparency = 1.0F - m.opacity;
    read_number(text, keyword, transparency, 1.0F);
    m.opacity = 1.0F - transparency;
  } else if (keyword == "illum") {
    float model = 2.0F;
    read_number(text, keyword, model, 100.0F);
    current_->illumination = static_cast<int>(model);
  } else if (!read_map(keyword, text)) {
    constexpr std::size_t kNamed = 30;
    if (unused_.size() < kNamed) unused_.insert(shown(word));
  }
}

void MtlReader::read(std::string_view file, const std::string& name) {
  file_ = shown(name);
  current_ = nullptr;
  std::string storage;
  TextCursor text(utf8_text(file, storage), true, false);
  while (text.find_word()) {
    line_ = text.line();
    const std::string_view keyword = text.word();
    if (keyword.starts_with('#')) {
      text.skip_comment();
    } else {
      read_statement(keyword, text.rest());
    }
    text.next_line();
  }
}

std::size_t MtlReader::number_of(const std::string& name) {
  for (const std::string& tried : {name, std::string(without_comment(name))}) {
    if (const auto known = entries_.find(tried); known != entries_.end()) {
      return known->second.number;
    }
  }
  const std::string plain(without_comment(name));
  // Some files comment the names in the material file only.
  for (const auto& [full, entry] : entries_) {
    if (!plain.empty() && without_comment(full) == plain) return entry.number;
  }
  const std::size_t number = source_.materials.size();
  SourceMaterial& added = source_.materials.emplace_back();
  if (!plain.empty()) {
    added.material.name = plain;
    missing_ += fmt::format("{}'{}'", missing_.empty() ? "" : ", ", shown(plain));
  }
  entries_[plain].number = number;
  return number;
}

void MtlReader::finish() {
  for (auto& [name, entry] : entries_) {
    SourceMaterial& source = source_.materials[entry.number];
    Material& m = source.material;
    if (!entry.has_ambient || m.ambient.isZero(0.0F)) m.ambient = m.diffuse;
    if (entry.illumination < 2) m.specular.setZero();
    if (entry.has_diffuse && m.diffuse.isZero(0.0F) && source.diffuse) {
      source_.notes.add("material '" + shown(name) + "': its Kd 0 0 0 makes its texture black");
    }
  }
  if (!missing_.empty()) {
    source_.notes.add("materials that no material file has are white: " + missing_);
  }
  std::string words;
  for (const std::string& word : unused_) words += (words.empty() ? "" : ", ") + word;
  if (!words.empty()) source_.notes.add("words of material files that are not used: " + words);
}

}  // namespace glidar::import
