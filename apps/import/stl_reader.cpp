// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// STL (3D Systems, StereoLithography Interface Specification, 1989): text and binary. Normals are
// those of its facets and are not used.
#include <import/own_readers.hpp>

#include <import/face_lists.hpp>
#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

namespace glidar::import {
namespace {

constexpr std::size_t kHeader = 80;
constexpr std::size_t kData = 84;   ///< the first facet
constexpr std::size_t kFacet = 50;  ///< bytes

/// Merges vertices at the same position while facets are read: each states its own.
class PositionTable {
 public:
  explicit PositionTable(FileLists& lists) : lists_(lists), table_(1024, kNoIndex) {}

  std::uint32_t index_of(const Eigen::Vector3d& position) {
    if (2 * (lists_.positions.size() + 1) > table_.size()) grow();
    std::uint32_t& slot = slot_of(position);
    if (slot == kNoIndex) {
      slot = static_cast<std::uint32_t>(lists_.positions.size());
      lists_.positions.push_back(position);
    }
    return slot;
  }

 private:
  static bool is_same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;
  }

  std::uint32_t& slot_of(const Eigen::Vector3d& position) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // Multipliers of splitmix64 (Steele et al. 2014).
      hash = (hash ^ std::bit_cast<std::uint64_t>(position[axis])) * 0x9E37'79B9'7F4A'7C15U;
      hash ^= hash >> 32U;
    }
    std::size_t slot = (hash * 0xBF58'476D'1CE4'E5B9U) >> (64U - bits_);
    while (table_[slot] != kNoIndex && !is_same(lists_.positions[table_[slot]], position)) {
      slot = (slot + 1) & (table_.size() - 1);
    }
    return table_[slot];
  }

  void grow() {
    ++bits_;
    table_.assign(std::size_t{1} << bits_, kNoIndex);
    for (std::uint32_t i = 0; i < lists_.positions.size(); ++i) slot_of(lists_.positions[i]) = i;
  }

  FileLists& lists_;
  unsigned bits_ = 10;
  std::vector<std::uint32_t> table_;
};

class AsciiStl {
 public:
  AsciiStl(std::string_view text, FileContent& content, SourceModel& source, FileLists& lists)
      : text_(text, false, false),
        content_(content),
        source_(source),
        lists_(lists),
        positions_(lists) {}

  void read() {
    while (text_.find_word()) {
      const std::string word = next();
      if (word != "solid") refuse_word(word, "instead of 'solid'");
      read_solid();
    }
  }

 private:
  /// The next word, in small letters; empty at the end of the file.
  std::string next() { return text_.find_word() ? lower_case(text_.word()) : ""; }

  [[noreturn]] void refuse_word(const std::string& word, const std::string& why) const {
    refuse_line(text_.line(),
                word.empty() ? "the file ends too early" : "'" + shown(word) + "' " + why);
  }

  void expect(const char* wanted) {
    const std::string word = next();
    if (word != wanted) refuse_word(word, "instead of '" + std::string(wanted) + "'");
  }

  /// "endloop" or "end loop", and the like.
  void expect_end(const std::string& word, const char* of) {
    if (word == "end") return expect(of);
    if (word != std::string("end") + of) {
      refuse_word(word, "instead of 'end" + std::string(of) + "'");
    }
  }

  void read_solid() {
    const std::string name = read_name();
    const auto part = static_cast<std::uint32_t>(lists_.parts.size());
    lists_.parts.push_back({name, 0, add_node(lists_.nodes, name, 0)});
    const std::size_t before = lists_.faces.size();
    for (;;) {
      const std::string word = next();
      if (word == "facet") {
        read_facet();
        lists_.faces.parts.push_back(part);
      } else if (word == "endsolid" || word == "end") {
        if (word == "end") expect("solid");
        skip_name(name);
        break;
      } else if (word.empty()) {
        source_.notes.add("the file ends without 'endsolid': it may be cut off");
        break;
      } else {
        refuse_word(word, "instead of 'facet' or 'endsolid'");
      }
    }
    if (lists_.faces.size() == before) {
      source_.notes.add("solid '" + shown(name) + "' is empty");
    }
  }

  /// The words after "solid", up to the end of the line or a facet in the same line.
  std::string read_name() {
    TextCursor from = text_;
    const std::string whole = from.rest();
    std::string name;
    for (;;) {
      TextCursor ahead = text_;
      const std::string_view word = ahead.word();
      TextCursor beyond = ahead;
      const std::string after = lower_case(beyond.word());
      const bool is_facet = lower_case(word) == "facet" && (after == "normal" || after == "outer");
      if (is_facet) return name;
      if (word.empty()) return whole;
      name += (name.empty() ? "" : " ") + std::string(word);
      text_ = ahead;
    }
  }

  /// The name after "endsolid", which may be missing, up to another solid in the same line.
  void skip_name(const std::string& name) {
    TextCursor ahead = text_;
    if (ahead.rest() == name) {
      text_ = ahead;
      return;
    }
    for (;;) {
      ahead = text_;
      const std::string_view word = ahead.word();
      if (word.empty() || lower_case(word) == "solid") return;
      text_ = ahead;
    }
  }

  void read_facet() {
    content_.forget_before(text_.at());
    std::string word = next();
    // The normal may be missing, incomplete or nan.
    if (word == "normal") {
      do {
        word = next();
      } while (!word.empty() && word != "outer" && is_number(word));
    }
    if (word != "outer") refuse_word(word, "instead of 'outer loop'");
    expect("loop");
    corners_.clear();
    for (word = next(); word == "vertex"; word = next()) read_vertex();
    expect_end(word, "loop");
    if (corners_.size() < 3) refuse_line(text_.line(), "a facet with fewer than 3 vertices");
    lists_.faces.add(corners_);
    expect_end(next(), "facet");
  }

  static bool is_number(const std::string& word) { return number_in(word).has_value(); }

  void read_vertex() {
    Eigen::Vector3d position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string word = next();
      const auto number = number_in(word);
      if (!number) refuse_word(word, "in 'vertex' is not a number");
      position[axis] = *number;
    }
    corners_.push_back(positions_.index_of(position));
  }

  TextCursor text_;
  FileContent& content_;
  SourceModel& source_;
  FileLists& lists_;
  PositionTable positions_;
  std::vector<std::uint32_t> corners_;
};

template <class T>
T little(std::string_view file, std::size_t at) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), file.data() + at, sizeof(T));
  if (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// A colour of 5 bits each, red in the lowest (Materialise) or the highest (VisCAM).
Eigen::Vector3f colour_of(std::uint16_t word, bool red_is_lowest) {
  const auto part = [word](unsigned shift) {
    return static_cast<float>((word >> shift) & 31U) / 31.0F;
  };
  return red_is_lowest ? Eigen::Vector3f(part(0), part(5), part(10))
                       : Eigen::Vector3f(part(10), part(5), part(0));
}

/// The colour of the object that Materialise's programs write into the header; none: VisCAM.
std::optional<Eigen::Vector3f> colour_of_object(std::string_view header) {
  constexpr std::string_view kMark = "COLOR=";
  const std::size_t at = header.find(kMark);
  if (at == std::string_view::npos || at + kMark.size() + 4 > header.size()) return std::nullopt;
  const auto byte = [&](std::size_t i) {
    return static_cast<float>(static_cast<unsigned char>(header[at + kMark.size() + i])) / 255.0F;
  };
  return Eigen::Vector3f(byte(0), byte(1), byte(2));
}

class BinaryStl {
 public:
  BinaryStl(std::string_view file, FileContent& content, SourceModel& source, FileLists& lists)
      : file_(file),
        content_(content),
        source_(source),
        lists_(lists),
        object_(colour_of_object(file.substr(0, kHeader))) {}

  void read() {
    const auto stated = little<std::uint32_t>(file_, kHeader);
    const std::size_t room = (file_.size() - kData) / kFacet;
    if (stated > room || (stated == 0 && room > 0)) {
      refuse_byte(kHeader, fmt::format("the file states {} facets and has {}", stated, room));
    }
    const std::size_t end = kData + kFacet * std::size_t{stated};
    if (end < file_.size()) {
      source_.notes.add(
          fmt::format("{} bytes after the last facet are not used", file_.size() - end));
    }
    const bool has_colours = find_colours(stated);
    PositionTable positions(lists_);
    lists_.faces.vertices.reserve(3 * std::size_t{stated});
    for (std::size_t at = kData; at < end; at += kFacet) {
      content_.forget_before(file_.data() + at);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t from = at + 12 * (corner + 1);
        corners[corner] = positions.index_of({double{little<float>(file_, from)},
                                              double{little<float>(file_, from + 4)},
                                              double{little<float>(file_, from + 8)}});
      }
      lists_.faces.add(corners);
      if (has_colours) lists_.faces.colours.push_back(colour_at(at));
    }
  }

 private:
  [[nodiscard]] std::uint16_t word_at(std::size_t facet) const {
    return little<std::uint16_t>(file_, facet + kFacet - 2);
  }

  /// Bit 15: the facet has a colour of its own (VisCAM), or has none (Materialise).
  [[nodiscard]] Eigen::Vector3f colour_at(std::size_t facet) const {
    const std::uint16_t word = word_at(facet);
    const bool is_marked = (word >> 15U) == 1;
    if (object_) return is_marked ? *object_ : colour_of(word, true);
    return is_marked ? colour_of(word, false) : Eigen::Vector3f::Ones().eval();
  }

  bool find_colours(std::uint32_t facets) {
    if (object_) return true;
    bool any = false;
    bool others = false;
    for (std::uint32_t i = 0; i < facets; ++i) {
      const std::uint16_t word = word_at(kData + kFacet * std::size_t{i});
      any = any || (word >> 15U) == 1;
      others = others || (word != 0 && (word >> 15U) == 0);
    }
    if (others) source_.notes.add("attributes of facets that are no colours are not used");
    return any;
  }

  std::string_view file_;
  FileContent& content_;
  SourceModel& source_;
  FileLists& lists_;
  std::optional<Eigen::Vector3f> object_;
};

bool has_size_of_binary(std::string_view file) {
  if (file.size() < kData) return false;
  const auto stated = little<std::uint32_t>(file, kHeader);
  return stated > 0 && file.size() == kData + kFacet * std::size_t{stated};
}

/// Some programs begin the header of binary files with "solid".
bool is_ascii(std::string_view file) {
  TextCursor text(file, false, false);
  if (!text.find_word() || lower_case(text.word()) != "solid") return false;
  constexpr std::size_t kSearched = 4096;
  const std::string head = lower_case(file.substr(0, kSearched));
  const bool is_text = head.find('\0') == std::string::npos;
  return is_text && (file.size() < kData || head.find("facet") != std::string::npos ||
                     head.find("endsolid") != std::string::npos);
}

}  // namespace

SourceModel read_stl(const ReaderInput& input) {
  SourceModel source;
  source.budget.add_input(input.content().size());
  source.format = "Stereolithography (STL)";
  source.materials.emplace_back();
  std::string storage;
  const std::string_view file = input.bytes();
  const std::string_view text = has_size_of_binary(file) ? "" : utf8_text(file, storage);
  FileLists lists;
  if (is_ascii(text)) {
    AsciiStl(text, input.content(), source, lists).read();
  } else if (file.size() < kData) {
    throw Refusal{
        "neither text that begins with 'solid' nor binary STL, which has at least 84 bytes",
        "export the model again"};
  } else {
    BinaryStl(file, input.content(), source, lists).read();
    source.is_single_precision = true;
  }
  input.release();
  add_meshes(std::move(lists), source);
  return source;
}

}  // namespace glidar::import
