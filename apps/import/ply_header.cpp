// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/ply_header.hpp>

#include <import/own_readers.hpp>
#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <array>
#include <map>
#include <utility>

namespace glidar::import {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  static const std::map<std::string_view, PlyType> kTypes = {
      {"char", PlyType::i8},      {"int8", PlyType::i8},      {"uchar", PlyType::u8},
      {"uint8", PlyType::u8},     {"short", PlyType::i16},    {"int16", PlyType::i16},
      {"ushort", PlyType::u16},   {"uint16", PlyType::u16},   {"int", PlyType::i32},
      {"int32", PlyType::i32},    {"uint", PlyType::u32},     {"uint32", PlyType::u32},
      {"long", PlyType::i64},     {"int64", PlyType::i64},    {"ulong", PlyType::u64},
      {"uint64", PlyType::u64},   {"float", PlyType::f32},    {"float32", PlyType::f32},
      {"double", PlyType::f64},   {"float64", PlyType::f64},  {"long64", PlyType::i64},
      {"longlong", PlyType::i64}, {"ulonglong", PlyType::u64}};
  const auto found = kTypes.find(name);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

/// Reads the lines up to 'end_header'.
class HeaderReader {
 public:
  explicit HeaderReader(std::string_view file) : file_(file) {
    const std::size_t end = file.find_first_of("\r\n");
    const bool has_both = end != std::string_view::npos && file.substr(end, 2) == "\r\n";
    line_end_ = end == std::string_view::npos ? "" : file.substr(end, has_both ? 2 : 1);
  }

  PlyHeader read() {
    if (trimmed(next_line()) != "ply") refuse_line(1, "not 'ply': not a PLY file");
    for (;;) {
      const std::string_view line = trimmed(next_line());
      if (line == "end_header") break;
      read_line(line);
    }
    if (!has_format_) refuse_line(header_.lines, "the header has no line 'format'");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  /// The end of every line is that of the first one, because the first byte of binary data may look
  /// like an end.
  std::string_view next_line() {
    const std::size_t end = file_.find_first_of("\r\n", at_);
    if (end == std::string_view::npos) {
      throw Refusal{"the header of the PLY file has no line 'end_header': the file ends too early",
                    "the file is damaged; copy or export it again"};
    }
    const std::string_view line = file_.substr(at_, end - at_);
    ++header_.lines;
    const bool has_both = file_.substr(end, 2) == "\r\n" && line_end_ != "\r";
    at_ = end + (has_both ? 2 : 1);
    return line;
  }

  void read_line(std::string_view line) {
    TextCursor words(line, false, false);
    const std::string_view keyword = words.word();
    if (keyword == "comment") {
      if (words.word() == "TextureFile") header_.textures.emplace_back(words.rest());
    } else if (keyword == "format") {
      read_format(words);
    } else if (keyword == "element") {
      read_element(words);
    } else if (keyword == "property") {
      read_property(words);
    } else if (keyword != "obj_info" && !keyword.empty()) {
      note_or_refuse(keyword);
    }
  }

  /// Some programs begin a comment without its keyword; a misspelt keyword would shift the data.
  void note_or_refuse(std::string_view keyword) {
    const std::string found = fmt::format("'{}' is no statement of a PLY header", shown(keyword));
    const std::string small = lower_case(keyword);
    for (const char* start : {"el", "pr", "fo", "end", "list"}) {
      if (small.starts_with(start)) refuse_line(header_.lines, found);
    }
    header_.notes.add_at(fmt::format("line {}", header_.lines), found + ": not used");
  }

  void read_format(TextCursor& words) {
    const std::string_view name = words.word();
    const std::string_view version = words.word();
    if (name == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyEncoding::little;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyEncoding::big;
    } else {
      refuse_line(header_.lines, "unknown format '" + shown(name) + "'");
    }
    if (version != "1.0") refuse_line(header_.lines, "unknown version '" + shown(version) + "'");
    has_format_ = true;
  }

  void read_element(TextCursor& words) {
    PlyElement element;
    element.name = words.word();
    element.line = header_.lines;
    const std::string_view number = words.word();
    const auto count = integer_in(number);
    if (element.name.empty() || !count || *count < 0 || !words.word().empty()) {
      refuse_line(header_.lines, "'element' has no name and count from 0");
    }
    element.count = static_cast<std::uint64_t>(*count);
    header_.elements.push_back(std::move(element));
  }

  PlyType read_type(TextCursor& words) const {
    const std::string_view name = words.word();
    const auto type = type_named(name);
    if (!type) refuse_line(header_.lines, "unknown type '" + shown(name) + "'");
    return *type;
  }

  void read_property(TextCursor& words) {
    if (header_.elements.empty()) refuse_line(header_.lines, "'property' before 'element'");
    PlyProperty property;
    TextCursor ahead = words;
    if (ahead.word() == "list") {
      words = ahead;
      property.count = read_type(words);
    }
    property.type = read_type(words);
    property.name = words.word();
    if (property.name.empty() || !words.word().empty()) {
      refuse_line(header_.lines, "'property' has no type and name");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view file_;
  std::string_view line_end_;
  std::size_t at_ = 0;
  bool has_format_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view wanted : names) {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == wanted) return i;
    }
  }
  return kNone;
}

PlyHeader read_ply_header(std::string_view file) {
  return HeaderReader(file).read();
}

}  // namespace glidar::import
