// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Wavefront OBJ (Advanced Visualizer manual, appendix B1): polygons with their materials.
#include <import/own_readers.hpp>

#include <import/face_lists.hpp>
#include <import/mtl_reader.hpp>
#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <span>
#include <tuple>

namespace glidar::import {
namespace {

/// Indices that name elements which the file has not stated yet.
struct Forward {
  std::uint32_t limit = 0;  ///< one more than the largest of them
  std::vector<std::pair<std::uint32_t, std::uint64_t>> largest;  ///< index and line, increasing

  void add(std::uint32_t index, std::uint64_t line) {
    if (index < limit) return;
    limit = index + 1;
    largest.emplace_back(index, line);
  }
  /// The first index that names none of `count` elements, and its line.
  [[nodiscard]] const std::pair<std::uint32_t, std::uint64_t>* beyond(std::size_t count) const {
    const auto found = std::find_if(largest.begin(), largest.end(),
                                    [count](const auto& one) { return one.first >= count; });
    return found == largest.end() ? nullptr : &*found;
  }
};

constexpr std::array<std::string_view, 17> kFreeForm = {
    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf", "parm",
    "trim", "hole",   "scrv", "sp",   "end",  "con",  "bzp",   "bsp"};

class ObjReader {
 public:
  ObjReader(TextCursor text, SourceModel& source) : text_(text), source_(source) {}

  void read() {
    while (text_.find_word()) {
      read_statement(text_.word());
      text_.next_line();
    }
    check_indices();
    scale_colours(lists_.colours);
    note_unused_statements();
  }

  /// The lists; the materials of parts are indices into materials().
  FileLists take_lists() { return std::move(lists_); }
  [[nodiscard]] const std::vector<std::string>& libraries() const { return libraries_; }
  [[nodiscard]] const std::vector<std::string>& materials() const { return materials_; }

 private:
  void note_unused_statements() {
    std::string others;
    std::string curves;
    for (const auto& [keyword, line] : unused_) {
      const bool is_curve =
          std::find(kFreeForm.begin(), kFreeForm.end(), keyword) != kFreeForm.end();
      std::string& list = is_curve ? curves : others;
      list += fmt::format("{}'{}' (line {})", list.empty() ? "" : ", ", shown(keyword), line);
    }
    if (!curves.empty()) {
      source_.notes.add("free-form curves and surfaces are left out: " + curves +
                        "; export the model as polygons");
    }
    if (!others.empty()) source_.notes.add("statements that are not used: " + others);
    if (more_unused_ > 0) {
      source_.notes.add(fmt::format("other statements that are not used: {}", more_unused_));
    }
  }

  void read_statement(std::string_view keyword) {
    line_ = text_.line();
    if (keyword == "v") return read_vertex();
    if (keyword == "f" || keyword == "fo") return read_face();
    if (keyword == "vt") return read_uv();
    if (keyword == "vn") return read_normal();
    if (keyword == "g") return begin_group(text_.rest());
    if (keyword == "o") return begin_object(text_.rest());
    if (keyword == "usemtl") {
      material_ = text_.rest();
      part_ = kNoIndex;
      return;
    }
    if (keyword == "mtllib") return add_library(text_.rest());
    if (keyword == "s") return read_smoothing();
    if (keyword == "l" || keyword == "p") {
      ++source_.lines_and_points;
      return;
    }
    note_unused(keyword);
  }

  /// The numbers of the line.
  std::size_t read_numbers(const char* keyword, std::size_t most) {
    std::size_t count = 0;
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      const auto number = number_in(word);
      if (!number) {
        refuse_line(line_, fmt::format("'{}' in '{}' is not a number", shown(word), keyword));
      }
      if (count == most) {
        refuse_line(line_, fmt::format("'{}' has more than {} numbers", keyword, most));
      }
      numbers_[count++] = *number;
    }
    return count;
  }

  void read_vertex() {
    const std::size_t count = read_numbers("v", 7);
    if (count < 3 || count == 5) {
      refuse_line(line_, fmt::format("'v' has {} numbers, not 3, 4, 6 or 7", count));
    }
    lists_.positions.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
    if (count == 4 && numbers_[3] != 1.0) {
      source_.notes.add("weights of vertices are not used: they belong to curves and surfaces");
    }
    if (count >= 6) {
      if (lists_.colours.empty() && lists_.positions.size() > 1) {
        source_.notes.add("vertices without a colour are white");
      }
      lists_.colours.resize(lists_.positions.size() - 1, Eigen::Vector3f::Ones());
      lists_.colours.push_back(
          Eigen::Vector3d(numbers_[3], numbers_[4], numbers_[5]).cast<float>());
      if (count == 7 && numbers_[6] != 1.0) {
        source_.notes.add("the opacity of vertices (their seventh number) is not used");
      }
    } else if (!lists_.colours.empty()) {
      lists_.colours.emplace_back(Eigen::Vector3f::Ones());
      source_.notes.add("vertices without a colour are white");
    }
  }

  void read_uv() {
    const std::size_t count = read_numbers("vt", 3);
    if (count == 0) refuse_line(line_, "'vt' has no numbers");
    const Eigen::Vector2d uv(numbers_[0], count > 1 ? numbers_[1] : 0.0);
    lists_.corner_uvs.push_back(uv.cast<float>());
    if (count == 3 && numbers_[2] != 0.0) {
      source_.notes.add("the third texture coordinate is not used");
    }
  }

  void read_normal() {
    const std::size_t count = read_numbers("vn", 3);
    if (count != 3) refuse_line(line_, fmt::format("'vn' has {} numbers, not 3", count));
    lists_.corner_normals.push_back(
        Eigen::Vector3d(numbers_[0], numbers_[1], numbers_[2]).cast<float>());
  }

  void begin_group(std::string_view name) {
    group_ = without_comment(name);
    part_ = kNoIndex;
  }

  void begin_object(std::string_view name) {
    object_ = without_comment(name);
    group_.clear();
    part_ = kNoIndex;
  }

  void add_library(std::string_view name) {
    constexpr std::size_t kMost = 1000;
    if (name.empty()) return note_line(line_, "'mtllib' names no file");
    const std::string text(name);
    if (std::find(libraries_.begin(), libraries_.end(), text) != libraries_.end()) return;
    if (libraries_.size() == kMost) {
      refuse_line(line_, fmt::format("'mtllib': more than {} material files", kMost));
    }
    libraries_.push_back(text);
  }

  void read_smoothing() {
    const std::string_view group = text_.word();
    if (smoothing_line_ == 0 && group != "off" && group != "0") smoothing_line_ = line_;
  }

  /// Counts kinds of statements; the first of them by name.
  void note_unused(std::string_view keyword) {
    const bool is_text = std::all_of(keyword.begin(), keyword.end(),
                                     [](unsigned char c) { return c >= 0x20 && c != 0x7F; });
    if (!is_text) refuse_line(line_, "'" + shown(keyword) + "' is not text: not an OBJ file");
    constexpr std::size_t kNamed = 12;
    const std::string name(keyword);
    if (unused_.contains(name)) return;
    if (unused_.size() < kNamed) {
      unused_.emplace(name, line_);
    } else {
      ++more_unused_;
    }
  }

  void note_line(std::uint64_t line, const std::string& what) {
    source_.notes.add_at(fmt::format("line {}", line), what);
  }

  /// An index of a corner, from 1, negative ones from the end. Removes it from the word.
  std::int64_t read_index(std::string_view& word, std::string_view whole) const {
    std::int64_t index = 0;
    const char* from = word.data();
    if (!word.empty() && *from == '+') ++from;
    const auto [stop, problem] = std::from_chars(from, word.data() + word.size(), index);
    if (problem != std::errc() || index == 0) {
      refuse_line(line_, "'" + shown(whole) + "' in 'f' is not an index from 1, or from -1");
    }
    word.remove_prefix(static_cast<std::size_t>(stop - word.data()));
    return index;
  }

  /// From 0; kNoIndex: it cannot name an element.
  std::uint32_t resolved(std::int64_t index, std::size_t count, Forward& forward) const {
    const std::int64_t from_0 = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
    if (from_0 < 0 || from_0 >= std::int64_t{kNoIndex}) return kNoIndex;
    const auto result = static_cast<std::uint32_t>(from_0);
    if (result >= count) forward.add(result, line_);
    return result;
  }

  void note_missing(const char* what, std::uint64_t line) {
    note_line(line, fmt::format("a face names a '{}' that is missing: read without", what));
  }

  void read_corner(std::string_view word) {
    const std::string_view whole = word;
    const std::int64_t vertex = read_index(word, whole);
    corners_.push_back(resolved(vertex, lists_.positions.size(), forward_));
    if (corners_.back() == kNoIndex) {
      refuse_line(line_,
                  fmt::format("a face names vertex {} of {}", vertex, lists_.positions.size()));
    }
    uvs_.push_back(kNoIndex);
    normals_.push_back(kNoIndex);
    if (!word.starts_with('/')) return end_corner(word, whole);
    word.remove_prefix(1);
    if (!word.empty() && !word.starts_with('/')) {
      uvs_.back() = resolved(read_index(word, whole), lists_.corner_uvs.size(), forward_uvs_);
      if (uvs_.back() == kNoIndex) note_missing("vt", line_);
    }
    if (!word.starts_with('/')) return end_corner(word, whole);
    word.remove_prefix(1);
    if (!word.empty()) {
      normals_.back() =
          resolved(read_index(word, whole), lists_.corner_normals.size(), forward_normals_);
      if (normals_.back() == kNoIndex) note_missing("vn", line_);
    }
    end_corner(word, whole);
  }

  void end_corner(std::string_view left, std::string_view whole) const {
    if (!left.empty())
      refuse_line(line_, "'" + shown(whole) + "' in 'f' is not v, v/vt, v//vn or v/vt/vn");
  }

  void read_face() {
    corners_.clear();
    uvs_.clear();
    normals_.clear();
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      read_corner(word);
    }
    if (corners_.size() < 3) {
      ++source_.lines_and_points;
      return note_line(line_, "a face has fewer than 3 corners: left out");
    }
    FaceLists& faces = lists_.faces;
    append(uvs_, faces.uvs);
    append(normals_, faces.normals);
    faces.add(corners_);
    const std::uint32_t part = current_part();
    if (faces.parts.empty() && part != 0) faces.parts.resize(faces.size() - 1, 0);
    if (!faces.parts.empty() || part != 0) faces.parts.push_back(part);
  }

  /// The list stays empty until a corner has an index.
  void append(const std::vector<std::uint32_t>& added, std::vector<std::uint32_t>& list) const {
    const bool any =
        std::any_of(added.begin(), added.end(), [](std::uint32_t i) { return i != kNoIndex; });
    if (list.empty() && !any) return;
    list.resize(lists_.faces.vertices.size(), kNoIndex);
    list.insert(list.end(), added.begin(), added.end());
  }

  std::uint32_t current_part() {
    if (part_ != kNoIndex) return part_;
    const auto [known, is_new] =
        parts_.try_emplace({object_, group_, material_}, lists_.parts.size());
    if (is_new) {
      const auto [used, is_first] = material_numbers_.try_emplace(material_, materials_.size());
      if (is_first) materials_.push_back(material_);
      lists_.parts.push_back({group_.empty() ? object_ : group_, used->second, current_node()});
    }
    part_ = static_cast<std::uint32_t>(known->second);
    return part_;
  }

  /// The group below its object; both may have several materials.
  std::uint32_t current_node() {
    const auto node_of = [this](const std::string& object, const std::string& group,
                                std::uint32_t parent) {
      const auto [known, is_new] = nodes_.try_emplace({object, group}, parent);
      if (is_new) known->second = add_node(lists_.nodes, group.empty() ? object : group, parent);
      return known->second;
    };
    const std::uint32_t object = node_of(object_, "", 0);
    return group_.empty() ? object : node_of(object_, group_, object);
  }

  static std::string without_comment(std::string_view name) {
    const std::size_t comment = std::min(name.find(" #"), name.find("\t#"));
    return std::string(trimmed(name.starts_with('#') ? "" : name.substr(0, comment)));
  }

  /// Sets indices beyond the list to kNoIndex.
  void drop_beyond(const char* what, const Forward& forward, std::size_t count,
                   std::vector<std::uint32_t>& indices) {
    const auto* missing = forward.beyond(count);
    if (missing == nullptr) return;
    note_missing(what, missing->second);
    for (std::uint32_t& index : indices) index = index >= count ? kNoIndex : index;
  }

  /// Faces whose corners have no normals, or not all, get a part beside those with normals, because
  /// its normals are made by the crease angle.
  void part_without_normals() {
    FaceLists& faces = lists_.faces;
    if (faces.normals.empty()) return;
    const auto normals_of = [&faces](std::size_t f) {
      return std::span(faces.normals)
          .subspan(faces.begin_of(f), faces.end_of(f) - faces.begin_of(f));
    };
    std::vector<bool> lacks(faces.size());
    std::vector<bool> has_some(lists_.parts.size(), false);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto normals = normals_of(f);
      const auto missing = std::count(normals.begin(), normals.end(), kNoIndex);
      lacks[f] = missing > 0;
      if (missing == 0) has_some[faces.parts.empty() ? 0 : faces.parts[f]] = true;
      if (missing == 0 || missing == static_cast<std::ptrdiff_t>(normals.size())) continue;
      source_.notes.add("normals of faces that name them for some corners only are not used");
      std::fill(normals.begin(), normals.end(), kNoIndex);
    }
    std::map<std::uint32_t, std::uint32_t> others;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const std::uint32_t part = faces.parts.empty() ? 0 : faces.parts[f];
      if (!lacks[f] || !has_some[part]) continue;
      const auto [other, is_new] =
          others.try_emplace(part, static_cast<std::uint32_t>(lists_.parts.size()));
      if (is_new) lists_.parts.push_back(FilePart(lists_.parts[part]));
      faces.parts.resize(faces.size(), 0);
      faces.parts[f] = other->second;
    }
  }

  void check_indices() {
    if (const auto* missing = forward_.beyond(lists_.positions.size())) {
      refuse_line(missing->second, fmt::format("a face names vertex {} of {}", missing->first + 1,
                                               lists_.positions.size()));
    }
    FaceLists& faces = lists_.faces;
    drop_beyond("vt", forward_uvs_, lists_.corner_uvs.size(), faces.uvs);
    drop_beyond("vn", forward_normals_, lists_.corner_normals.size(), faces.normals);
    if (!faces.uvs.empty()) faces.uvs.resize(faces.vertices.size(), kNoIndex);
    if (!faces.normals.empty()) faces.normals.resize(faces.vertices.size(), kNoIndex);
    part_without_normals();
    const bool lacks_normals =
        faces.normals.empty() ||
        std::find(faces.normals.begin(), faces.normals.end(), kNoIndex) != faces.normals.end();
    if (smoothing_line_ != 0 && lacks_normals) {
      source_.notes.add(
          fmt::format("smoothing groups (line {}) are not used: normals follow the crease "
                      "angle",
                      smoothing_line_));
    }
  }

  TextCursor text_;
  SourceModel& source_;
  std::uint64_t line_ = 0;
  FileLists lists_;
  std::array<double, 8> numbers_{};
  std::vector<std::uint32_t> corners_;  ///< of the current face
  std::vector<std::uint32_t> uvs_;
  std::vector<std::uint32_t> normals_;
  Forward forward_;
  Forward forward_uvs_;
  Forward forward_normals_;
  std::string object_;
  std::string group_;
  std::string material_;
  std::uint32_t part_ = kNoIndex;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> parts_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> nodes_;  ///< by object and group
  std::map<std::string, std::size_t> material_numbers_;
  std::vector<std::string> materials_;
  std::vector<std::string> libraries_;
  std::uint64_t smoothing_line_ = 0;
  std::map<std::string, std::uint64_t> unused_;  ///< keyword: line of the first one
  std::uint64_t more_unused_ = 0;
};

/// The files of a 'mtllib' statement: one whose name may have spaces, or several.
void read_library(const std::string& names, const ReaderInput& input, MtlReader& materials) {
  std::string_view all = trimmed(names);
  const std::size_t comment = std::min(all.find(" #"), all.find("\t#"));
  const bool is_file = confine(std::string(all), input.folder).access == Access::granted;
  if (!is_file) all = trimmed(all.substr(0, comment));
  all = trimmed(all, "\"");
  std::vector<std::string> files;
  const bool is_one = confine(std::string(all), input.folder).access == Access::granted;
  while (!is_one && !all.empty()) {
    // A name ends at its extension.
    const std::string small = lower_case(all);
    std::size_t end = small.find(".mtl ");
    end = end == std::string::npos ? all.size() : end + 4;
    files.emplace_back(all.substr(0, end));
    all = trimmed(all.substr(end));
  }
  if (is_one) files.emplace_back(all);
  for (const std::string& name : files) {
    if (const auto content = input.companion(name)) materials.read(content->whole(), name);
  }
}

}  // namespace

SourceModel read_obj(const ReaderInput& input) {
  SourceModel source;
  source.budget.add_input(input.content().size());
  source.format = "Wavefront Object";
  std::string storage;
  ObjReader reader(input.text(storage, true), source);
  reader.read();
  free_memory(storage);
  input.release();
  MtlReader materials(source);
  for (const std::string& library : reader.libraries()) read_library(library, input, materials);
  FileLists lists = reader.take_lists();
  std::vector<std::size_t> numbers;
  for (const std::string& name : reader.materials()) numbers.push_back(materials.number_of(name));
  for (FilePart& part : lists.parts) part.material = numbers.at(part.material);
  materials.finish();
  add_meshes(std::move(lists), source);
  return source;
}

}  // namespace glidar::import
