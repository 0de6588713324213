// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// The Object File Format of Geomview (manual, "OFF: Object File Format"), text and binary.
#include <import/own_readers.hpp>

#include <import/face_lists.hpp>
#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace glidar::import {
namespace {

/// What the first word states about vertices: [ST][C][N][4][n]OFF.
struct OffKind {
  bool uvs = false;
  bool colours = false;
  bool normals = false;
  bool is_header = false;  ///< the word is one
};

OffKind kind_of(std::string_view word, std::uint64_t line) {
  OffKind kind;
  const bool is_small = word.ends_with("off");
  if (!is_small && !word.ends_with("OFF")) return kind;
  const std::string_view whole = word;
  word.remove_suffix(3);
  const auto take = [&word, is_small](std::string_view prefix) {
    if (!word.starts_with(is_small ? lower_case(prefix) : prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
  };
  kind.uvs = take("ST");
  kind.colours = take("C");
  kind.normals = take("N");
  if (word == "4" || word == "n" || word == "4n") {
    refuse_line(line, "'" + shown(whole) + "' has vertices of other than three dimensions");
  }
  kind.is_header = word.empty();
  return kind;
}

/// Of the file: vertices and faces.
struct OffCounts {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

class OffText {
 public:
  OffText(OffKind kind, TextCursor text, SourceModel& source, FileLists& lists)
      : kind_(kind), text_(text), source_(source), lists_(lists) {}

  void read() {
    const OffCounts counts = read_counts();
    // Lower bounds: a vertex takes at least 4 bytes, a face 2.
    const std::uint64_t left = text_.left();
    if (counts.vertices > left / 4 + 1 || counts.faces > left / 2 + 1) {
      refuse_line(text_.line(),
                  fmt::format("the file states {} vertices and {} faces, and ends too "
                              "early for them",
                              counts.vertices, counts.faces));
    }
    lists_.positions.reserve(counts.vertices);
    for (std::uint64_t i = 0; i < counts.vertices; ++i) read_vertex(i);
    for (std::uint64_t i = 0; i < counts.faces; ++i) read_face(i);
    if (text_.find_word()) {
      refuse_line(text_.line(), "'" + shown(text_.word()) + "' after the last face");
    }
  }

 private:
  [[noreturn]] void refuse_count(std::string_view word) const {
    refuse_line(text_.line(),
                "'" + shown(word) + "' instead of the counts of vertices, faces and edges");
  }

  OffCounts read_counts() {
    std::array<std::int64_t, 3> counts{};
    std::size_t found = 0;
    // The number of edges is often missing, but not if each has a line of its own.
    for (std::size_t needed = 2; found < needed;) {
      if (!text_.find_word()) refuse_line(text_.line(), "the file ends too early");
      for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
        const auto count = integer_in(word);
        if (!count || *count < 0 || found == counts.size()) refuse_count(word);
        counts[found++] = *count;
      }
      if (found == 1) needed = 3;
    }
    return {static_cast<std::uint64_t>(counts[0]), static_cast<std::uint64_t>(counts[1])};
  }

  void append_line() {
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      const auto value = number_in(word);
      if (!value) refuse_line(text_.line(), "'" + shown(word) + "' is not a number");
      numbers_.push_back(*value);
    }
  }

  /// The numbers of the next line that has some.
  void read_line(const char* what, std::uint64_t number) {
    if (!text_.find_word()) {
      refuse_line(text_.line(), fmt::format("the file ends before {} {}", what, number));
    }
    line_ = text_.line();
    numbers_.clear();
    append_line();
  }

  /// Appends the numbers of further lines if there are fewer than `needed`.
  void read_further_lines(double needed) {
    while (static_cast<double>(numbers_.size()) < needed && text_.find_word()) append_line();
  }

  void read_vertex(std::uint64_t number) {
    read_line("vertex", number);
    const std::size_t fixed = 3 + (kind_.normals ? 3U : 0U) + (kind_.uvs ? 2U : 0U);
    if (numbers_.size() < 3) read_further_lines(static_cast<double>(fixed));
    const std::size_t colour = numbers_.size() - std::min(fixed, numbers_.size());
    const bool is_colour = colour == 3 || colour == 4;
    const bool fits = numbers_.size() >= fixed && (is_colour || (!kind_.colours && colour == 0));
    if (!fits) {
      refuse_line(line_, fmt::format("vertex {} has {} numbers", number, numbers_.size()));
    }
    if (is_colour && !kind_.colours) {
      source_.notes.add(
          "numbers of vertices that the first line does not state are not used: colours, or "
          "normals");
    }
    std::size_t at = 0;
    const auto next = [&] { return numbers_[at++]; };
    const auto next3 = [&] {
      const double x = next();
      const double y = next();
      return Eigen::Vector3d(x, y, next());
    };
    lists_.positions.push_back(next3());
    if (kind_.normals) lists_.normals.push_back(next3().cast<float>());
    if (kind_.colours) {
      lists_.colours.push_back(next3().cast<float>());
      if (colour == 4) ++at;
    }
    if (kind_.uvs) {
      const double u = next();
      lists_.uvs.push_back(Eigen::Vector2d(u, next()).cast<float>());
    }
  }

  /// A triangle or polygon with nothing after its corners, which most lines state. False for
  /// others, of which nothing is read.
  bool read_plain_face() {
    TextCursor ahead = text_;
    const std::uint32_t count = ahead.digits().value_or(0);
    if (count < 3) return false;
    corners_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::optional<std::uint32_t> index = ahead.digits();
      if (!index || *index >= lists_.positions.size()) return false;
      corners_.push_back(*index);
    }
    if (!ahead.is_line_read()) return false;
    text_ = ahead;
    lists_.faces.add(corners_);
    return true;
  }

  void read_face(std::uint64_t number) {
    if (text_.find_word() && read_plain_face()) return;
    read_line("face", number);
    const double count = numbers_[0];
    read_further_lines(count + 1.0);
    if (!(count >= 0.0) || count != std::floor(count) ||
        count + 1.0 > static_cast<double>(numbers_.size())) {
      refuse_line(line_, fmt::format("face {} has {} numbers after its count {:g}", number,
                                     numbers_.size() - 1, count));
    }
    const auto corners = static_cast<std::size_t>(count);
    corners_.clear();
    for (std::size_t i = 1; i <= corners; ++i) {
      const double index = numbers_[i];
      if (!(index >= 0.0) || index != std::floor(index) ||
          index >= static_cast<double>(lists_.positions.size())) {
        refuse_line(line_, fmt::format("face {} names vertex {:g} of {} (from 0)", number, index,
                                       lists_.positions.size()));
      }
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    if (corners < 3) {
      ++source_.lines_and_points;
      return;
    }
    lists_.faces.add(corners_);
    add_colour(number, corners + 1);
  }

  void add_colour(std::uint64_t number, std::size_t first) {
    const std::size_t count = numbers_.size() - first;
    if (count == 1 || count == 2) {
      source_.notes.add("colours of faces by their number in a list are not used");
    } else if (count > 4) {
      refuse_line(line_, fmt::format("face {} has {} numbers too many", number, count - 4));
    }
    auto& colours = lists_.faces.colours;
    if (count < 3 && colours.empty()) return;
    colours.resize(lists_.faces.size() - 1, Eigen::Vector3f::Constant(-1.0F));
    colours.push_back(
        count < 3 ? Eigen::Vector3f::Constant(-1.0F).eval()
                  : Eigen::Vector3d(numbers_[first], numbers_[first + 1], numbers_[first + 2])
                        .cast<float>());
  }

  OffKind kind_;
  TextCursor text_;
  SourceModel& source_;
  FileLists& lists_;
  std::vector<double> numbers_;  ///< of the current vertex or face
  std::uint64_t line_ = 0;       ///< where it begins
  std::vector<std::uint32_t> corners_;
};

/// Big-endian 32-bit numbers.
class OffBinary {
 public:
  OffBinary(std::string_view file, std::size_t begin, OffKind kind, SourceModel& source,
            FileLists& lists)
      : file_(file), at_(begin), kind_(kind), source_(source), lists_(lists) {}

  void read() {
    const std::uint32_t vertices = next_word();
    const std::uint32_t faces = next_word();
    next_word();  // edges
    const std::uint64_t each =
        12U + (kind_.normals ? 12U : 0U) + (kind_.colours ? 16U : 0U) + (kind_.uvs ? 8U : 0U);
    require(vertices * each + faces * std::uint64_t{8});
    for (std::uint32_t i = 0; i < vertices; ++i) read_vertex();
    for (std::uint32_t i = 0; i < faces; ++i) read_face();
    if (at_ < file_.size()) {
      source_.notes.add(
          fmt::format("{} bytes after the last face are not used", file_.size() - at_));
    }
  }

 private:
  void require(std::uint64_t bytes) const {
    if (bytes > file_.size() - at_) refuse_byte(at_, "the file ends too early");
  }

  std::uint32_t next_word() {
    require(4);
    std::uint32_t word = 0;
    for (int i = 0; i < 4; ++i) word = word << 8U | static_cast<unsigned char>(file_[at_++]);
    return word;
  }

  float next_number() { return std::bit_cast<float>(next_word()); }

  Eigen::Vector3f next3() {
    const float x = next_number();
    const float y = next_number();
    return {x, y, next_number()};
  }

  void read_vertex() {
    lists_.positions.push_back(next3().cast<double>());
    if (kind_.normals) lists_.normals.push_back(next3());
    if (kind_.colours) {
      lists_.colours.push_back(next3());
      next_number();
    }
    if (kind_.uvs) {
      const float u = next_number();
      lists_.uvs.emplace_back(u, next_number());
    }
  }

  void read_face() {
    const std::uint32_t count = next_word();
    require(std::uint64_t{4} * count);
    std::vector<std::uint32_t> corners(count);
    for (std::uint32_t& corner : corners) {
      corner = next_word();
      if (corner >= lists_.positions.size()) {
        refuse_byte(at_ - 4, fmt::format("a face names vertex {} of {} (from 0)", corner,
                                         lists_.positions.size()));
      }
    }
    const std::uint32_t colour = next_word();
    require(std::uint64_t{4} * colour);
    Eigen::Vector3f rgb = Eigen::Vector3f::Constant(-1.0F);
    for (std::uint32_t i = 0; i < colour; ++i) {
      const float value = next_number();
      if (colour >= 3 && i < 3) rgb[static_cast<int>(i)] = value;
    }
    if (count < 3) {
      ++source_.lines_and_points;
      return;
    }
    lists_.faces.add(corners);
    auto& colours = lists_.faces.colours;
    if (colour < 3 && colours.empty()) return;
    colours.resize(lists_.faces.size() - 1, Eigen::Vector3f::Constant(-1.0F));
    colours.push_back(rgb);
  }

  std::string_view file_;
  std::size_t at_;
  OffKind kind_;
  SourceModel& source_;
  FileLists& lists_;
};

/// Colours of faces: -1 marks those without one.
void finish_colours(SourceModel& source, FileLists& lists) {
  auto& faces = lists.faces.colours;
  if (!faces.empty() && !lists.colours.empty()) {
    source.notes.add("colours of faces are not used: the vertices have colours too");
    faces.clear();
  }
  if (!faces.empty()) faces.resize(lists.faces.size(), Eigen::Vector3f::Constant(-1.0F));
  scale_colours(lists.colours);
  scale_colours(faces);
  for (Eigen::Vector3f& colour : faces) {
    if (colour.minCoeff() < 0.0F) colour = Eigen::Vector3f::Ones();
  }
}

}  // namespace

SourceModel read_off(const ReaderInput& input) {
  SourceModel source;
  source.budget.add_input(input.content().size());
  source.format = "Object File Format (OFF)";
  source.materials.emplace_back();
  std::string storage;
  TextCursor text = input.text(storage, false);
  FileLists lists;
  if (!text.find_word()) refuse_line(1, "the file is empty");
  TextCursor ahead = text;
  const std::string_view word = ahead.word();
  OffKind kind = kind_of(word, ahead.line());
  if (word.size() > 3 && word.starts_with("OFF") && integer_in(word.substr(3))) {  // "OFF8 6 12"
    kind.is_header = true;
    ahead = text;
    ahead.skip(3);
  }
  // The word may be missing.
  if (kind.is_header) text = ahead;
  if (kind.is_header && storage.empty() && ahead.word() == "BINARY") {
    ahead.next_line();
    const char* const begin = ahead.at();
    const std::string_view file = input.bytes();
    OffBinary(file, static_cast<std::size_t>(begin - file.data()), kind, source, lists).read();
    source.is_single_precision = true;
  } else {
    OffText(kind, text, source, lists).read();
  }
  input.release();
  finish_colours(source, lists);
  add_meshes(std::move(lists), source);
  return source;
}

}  // namespace glidar::import
