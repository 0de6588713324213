// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// The Stanford polygon format (Turk, "The PLY Polygon File Format", 1994) in its three encodings.
#include <import/own_readers.hpp>

#include <import/face_lists.hpp>
#include <import/ply_header.hpp>
#include <import/text_cursor.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace glidar::import {
namespace {

/// Values of binary data.
class BinaryValues {
 public:
  BinaryValues(std::string_view file, std::size_t begin, bool big_endian)
      : from_(file.data()), at_(from_ + begin), end_(from_ + file.size()), swap_(big_endian) {}

  void begin_entry(const PlyElement& element, std::uint64_t entry) {
    element_ = &element;
    entry_ = entry;
  }
  /// Whether there is more in it than the header states.
  static bool end_entry() { return false; }

  double next(PlyType type) {
    if (left() < size_of(type)) fail("the file ends too early");
    switch (type) {
      case PlyType::i8:
        return value<std::int8_t>();
      case PlyType::u8:
        return value<std::uint8_t>();
      case PlyType::i16:
        return value<std::int16_t>();
      case PlyType::u16:
        return value<std::uint16_t>();
      case PlyType::i32:
        return value<std::int32_t>();
      case PlyType::u32:
        return value<std::uint32_t>();
      case PlyType::i64:
        return static_cast<double>(value<std::int64_t>());
      case PlyType::u64:
        return static_cast<double>(value<std::uint64_t>());
      case PlyType::f32:
        return double{value<float>()};
      case PlyType::f64:
        return value<double>();
    }
    return 0.0;
  }

  /// Throws if a list of this length does not fit.
  void require(std::uint64_t count, std::uint64_t each) const {
    if (count > left() / each) fail("the file ends too early");
  }
  void require(std::uint64_t count, PlyType type) const { require(count, size_of(type)); }

  [[nodiscard]] const char* at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  [[noreturn]] void fail(const std::string& found) const {
    refuse_byte(static_cast<std::size_t>(at_ - from_),
                fmt::format("{} {}: {}", shown(element_->name), entry_, found));
  }
  [[nodiscard]] std::string rest() const {
    return left() == 0 ? "" : fmt::format("{} bytes", left());
  }

 private:
  template <class T>
  T value() {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at_, sizeof(T));
    at_ += sizeof(T);
    if (swap_ == (std::endian::native == std::endian::little)) {
      std::reverse(bytes.begin(), bytes.end());
    }
    return std::bit_cast<T>(bytes);
  }

  const char* from_;
  const char* at_;
  const char* end_;
  bool swap_;
  const PlyElement* element_ = nullptr;
  std::uint64_t entry_ = 0;
};

/// Values of text; an entry ends with its line, but may have several.
class TextValues {
 public:
  TextValues(std::string_view text, std::uint64_t lines_before)
      : text_(text, false, false), lines_before_(lines_before) {}

  void begin_entry(const PlyElement& element, std::uint64_t entry) {
    element_ = &element;
    entry_ = entry;
    has_values_ = false;
  }

  /// Whether there is more in it than the header states; it is skipped.
  bool end_entry() {
    if (!has_values_ || text_.word().empty()) return false;
    text_.rest();
    return true;
  }

  double next(PlyType) {
    std::string_view word = text_.word();
    if (word.empty()) {
      if (!text_.find_word()) fail("the file ends too early");
      word = text_.word();
    }
    has_values_ = true;
    const auto number = number_in(word);
    if (!number) fail("'" + shown(word) + "' is not a number");
    return *number;
  }

  /// A value needs a digit and a blank.
  void require(std::uint64_t count, std::uint64_t each) const {
    constexpr std::uint64_t kShortest = 2;
    if (each > 0 && count > left() / kShortest + 1) fail("the file ends too early");
  }
  void require(std::uint64_t count, PlyType) const { require(count, std::uint64_t{1}); }

  [[nodiscard]] const char* at() const { return text_.at(); }
  [[nodiscard]] std::size_t left() const { return text_.left(); }
  [[noreturn]] void fail(const std::string& found) const {
    refuse_line(text_.line() + lines_before_,
                fmt::format("{} {}: {}", shown(element_->name), entry_, found));
  }
  [[nodiscard]] std::string rest() {
    return text_.find_word() ? fmt::format("text from line {}", text_.line() + lines_before_) : "";
  }

 private:
  TextCursor text_;
  std::uint64_t lines_before_;
  const PlyElement* element_ = nullptr;
  std::uint64_t entry_ = 0;
  bool has_values_ = false;
};

/// The largest value of integers that are colours.
double full_scale(PlyType type) {
  switch (type) {
    case PlyType::u8:
      return 255.0;
    case PlyType::u16:
      return 65535.0;
    default:
      return 1.0;  // scale_colours() decides
  }
}

template <class Values>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Values& values, FileContent& file, SourceModel& source)
      : header_(header), values_(values), file_(file), source_(source) {}

  void read() {
    for (const PlyElement& element : header_.elements) {
      check_size(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        skip(element);
      }
    }
    if (!has_vertices_) {
      throw Refusal{"the PLY file has no element 'vertex'", "export the model again"};
    }
    const std::string rest = values_.rest();
    if (!rest.empty()) source_.notes.add("after the last element: " + rest + ", not used");
    finish();
  }

  FileLists take_lists() { return std::move(lists_); }
  /// TextureFile of each part.
  [[nodiscard]] const std::vector<std::size_t>& textures() const { return textures_; }

 private:
  void begin_entry(const PlyElement& element, std::uint64_t entry) {
    values_.begin_entry(element, entry);
    file_.forget_before(values_.at());
  }

  /// A count beyond the file's size, before memory is allocated for it.
  void check_size(const PlyElement& element) {
    begin_entry(element, 0);
    std::uint64_t each = 0;
    for (const PlyProperty& p : element.properties) each += size_of(p.count.value_or(p.type));
    if (each > 0) {
      values_.require(element.count, each);
    } else if (element.count > 0) {
      refuse_line(element.line, "element '" + shown(element.name) + "' has no properties");
    }
  }

  /// A list's length.
  std::uint64_t read_count(PlyType type) {
    const double count = values_.next(type);
    if (!(count >= 0.0) || count != std::floor(count) || count > 4e9) {
      values_.fail(fmt::format("a list of {:g} values", count));
    }
    return static_cast<std::uint64_t>(count);
  }

  void skip_value(const PlyProperty& property) {
    if (!property.count) {
      values_.next(property.type);
      return;
    }
    const std::uint64_t count = read_count(*property.count);
    values_.require(count, property.type);
    for (std::uint64_t i = 0; i < count; ++i) values_.next(property.type);
  }

  void skip(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      begin_entry(element, i);
      for (const PlyProperty& property : element.properties) skip_value(property);
      end_entry();
    }
    if (element.name == "edge") {
      source_.lines_and_points += element.count;
    } else {
      source_.notes.add("element '" + shown(element.name) + "' is not used");
    }
  }

  void note_unused(const PlyElement& element, const std::set<std::size_t>& used) {
    std::string names;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (!used.contains(i)) {
        names += (names.empty() ? "" : ", ") + shown(element.properties[i].name);
      }
    }
    if (!names.empty()) {
      source_.notes.add(
          fmt::format("properties of '{}' that are not used: {}", element.name, names));
    }
  }

  /// Indices of three properties, all or none.
  std::optional<std::array<std::size_t, 3>> three(const PlyElement& element,
                                                  std::array<std::size_t, 3> found,
                                                  std::set<std::size_t>& used) const {
    for (const std::size_t i : found) {
      if (i == PlyElement::kNone || element.properties[i].count) return std::nullopt;
    }
    used.insert(found.begin(), found.end());
    return found;
  }

  static std::array<std::size_t, 3> colour_properties(const PlyElement& element) {
    return {element.find({"red", "diffuse_red", "r"}),
            element.find({"green", "diffuse_green", "g"}),
            element.find({"blue", "diffuse_blue", "b"})};
  }

  void read_vertices(const PlyElement& element) {
    if (has_vertices_) refuse_line(element.line, "a second element 'vertex'");
    has_vertices_ = true;
    std::set<std::size_t> used;
    const auto xyz =
        three(element, {element.find({"x"}), element.find({"y"}), element.find({"z"})}, used);
    if (!xyz) refuse_line(element.line, "the vertices have no x, y and z");
    const auto normal =
        three(element, {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})}, used);
    const auto rgb = three(element, colour_properties(element), used);
    const std::size_t u = element.find({"s", "u", "texture_u", "tex_u", "u0"});
    const std::size_t v = element.find({"t", "v", "texture_v", "tex_v", "v0"});
    const auto uv = three(element, {u, v, v}, used);
    note_unused(element, used);
    source_.is_single_precision = element.properties[(*xyz)[0]].type == PlyType::f32 &&
                                  header_.encoding != PlyEncoding::ascii;
    lists_.positions.reserve(element.count);
    if (normal) lists_.normals.reserve(element.count);
    if (rgb) lists_.colours.reserve(element.count);
    if (uv) lists_.uvs.reserve(element.count);
    std::vector<double> entry(element.properties.size());
    const auto at = [&entry](std::size_t i) { return entry[i]; };
    for (std::uint64_t n = 0; n < element.count; ++n) {
      read_entry(element, n, entry);
      lists_.positions.emplace_back(at((*xyz)[0]), at((*xyz)[1]), at((*xyz)[2]));
      if (normal) {
        lists_.normals.push_back(
            Eigen::Vector3d(at((*normal)[0]), at((*normal)[1]), at((*normal)[2])).cast<float>());
      }
      if (rgb) lists_.colours.push_back(colour_of(element, *rgb, entry));
      if (uv) lists_.uvs.push_back(Eigen::Vector2d(at(u), at(v)).cast<float>());
    }
  }

  void read_entry(const PlyElement& element, std::uint64_t number, std::vector<double>& entry) {
    begin_entry(element, number);
    for (std::size_t i = 0; i < entry.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.count) {
        skip_value(property);
      } else {
        entry[i] = values_.next(property.type);
      }
    }
    end_entry();
  }

  void end_entry() {
    if (values_.end_entry()) values_.fail("more numbers than the header states");
  }

  static Eigen::Vector3f colour_of(const PlyElement& element, const std::array<std::size_t, 3>& rgb,
                                   const std::vector<double>& entry) {
    Eigen::Vector3d colour(entry[rgb[0]], entry[rgb[1]], entry[rgb[2]]);
    return (colour / full_scale(element.properties[rgb[0]].type)).cast<float>();
  }

  std::uint32_t index_of(double value) {
    if (!(value >= 0.0) || value != std::floor(value) || value >= double{kNoIndex}) {
      values_.fail(fmt::format("{:g} is not an index of a vertex", value));
    }
    const auto index = static_cast<std::uint32_t>(value);
    // Faces may be before the vertices.
    if (index >= limit_) {
      limit_ = index + 1;
      limit_face_ = face_;
    }
    return index;
  }

  /// A list of values.
  void read_list(const PlyProperty& property, std::vector<double>& list) {
    const std::uint64_t count = read_count(*property.count);
    values_.require(count, property.type);
    list.resize(count);
    for (double& value : list) value = values_.next(property.type);
  }

  /// The properties of faces that are used.
  struct FaceProperties {
    std::size_t indices = PlyElement::kNone;
    std::size_t uvs = PlyElement::kNone;      ///< list of u and v of each corner
    std::size_t texture = PlyElement::kNone;  ///< number of the TextureFile
    std::size_t object = PlyElement::kNone;
    std::optional<std::array<std::size_t, 3>> rgb;
  };

  FaceProperties face_properties(const PlyElement& element) {
    FaceProperties found;
    std::set<std::size_t> used;
    found.indices = element.find({"vertex_indices", "vertex_index", "vertex_indexes"});
    if (found.indices == PlyElement::kNone || !element.properties[found.indices].count) {
      refuse_line(element.line, "the faces have no list 'vertex_indices'");
    }
    used.insert(found.indices);
    const auto use = [&](std::initializer_list<std::string_view> names, bool is_list) {
      const std::size_t i = element.find(names);
      if (i == PlyElement::kNone || element.properties[i].count.has_value() != is_list) {
        return PlyElement::kNone;
      }
      used.insert(i);
      return i;
    };
    found.uvs = use({"texcoord", "texcoords"}, true);
    found.texture = use({"texnumber", "texture_number"}, false);
    found.object = use({"object_id"}, false);
    const auto rgb = colour_properties(element);
    found.rgb = three(element, rgb, used);
    note_unused(element, used);
    return found;
  }

  void read_faces(const PlyElement& element) {
    const FaceProperties wanted = face_properties(element);
    lists_.faces.vertices.reserve(3 * element.count);
    if (wanted.rgb) lists_.faces.colours.reserve(element.count);
    std::vector<double> entry(element.properties.size());
    std::vector<double> uvs;
    for (std::uint64_t n = 0; n < element.count; ++n, ++face_) {
      begin_entry(element, n);
      read_face(element, wanted, entry, uvs);
      excess_ += values_.end_entry() ? 1 : 0;
      add_face(element, wanted, entry, uvs);
    }
  }

  void read_face(const PlyElement& element, const FaceProperties& wanted,
                 std::vector<double>& entry, std::vector<double>& uvs) {
    uvs.clear();
    for (std::size_t i = 0; i < entry.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (i == wanted.indices) {
        read_corners(property);
      } else if (i == wanted.uvs) {
        read_list(property, uvs);
      } else if (property.count) {
        skip_value(property);
      } else {
        entry[i] = values_.next(property.type);
      }
    }
  }

  void read_corners(const PlyProperty& property) {
    const std::uint64_t count = read_count(*property.count);
    values_.require(count, property.type);
    corners_.resize(count);
    for (std::uint32_t& corner : corners_) corner = index_of(values_.next(property.type));
  }

  void add_face(const PlyElement& element, const FaceProperties& wanted,
                const std::vector<double>& entry, const std::vector<double>& uvs) {
    if (corners_.size() < 3) {
      ++source_.lines_and_points;
      return;
    }
    const std::size_t before = lists_.faces.vertices.size();
    lists_.faces.add(corners_);
    if (wanted.rgb) lists_.faces.colours.push_back(colour_of(element, *wanted.rgb, entry));
    if (wanted.uvs != PlyElement::kNone) add_uvs(uvs, before);
    const double texture = wanted.texture == PlyElement::kNone ? 0.0 : entry[wanted.texture];
    const double object = wanted.object == PlyElement::kNone ? -1.0 : entry[wanted.object];
    if (!std::isfinite(texture) || !std::isfinite(object)) {
      values_.fail("its texnumber or object_id is no number");
    }
    if (wanted.texture != PlyElement::kNone || wanted.object != PlyElement::kNone) {
      lists_.faces.parts.resize(lists_.faces.size() - 1, 0);
      lists_.faces.parts.push_back(part_of(texture, object, wanted.object != PlyElement::kNone));
    }
  }

  void add_uvs(const std::vector<double>& uvs, std::size_t before) {
    FaceLists& faces = lists_.faces;
    const bool fits = uvs.size() == 2 * corners_.size();
    if (!fits && !uvs.empty()) {
      values_.fail(
          fmt::format("{} texture coordinates for {} corners", uvs.size(), corners_.size()));
    }
    faces.uvs.resize(before, kNoIndex);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (!fits) {
        faces.uvs.push_back(kNoIndex);
        continue;
      }
      const Eigen::Vector2f uv = Eigen::Vector2d(uvs[2 * i], uvs[2 * i + 1]).cast<float>();
      if (lists_.corner_uvs.empty() || lists_.corner_uvs.back() != uv) {
        lists_.corner_uvs.push_back(uv);
      }
      faces.uvs.push_back(static_cast<std::uint32_t>(lists_.corner_uvs.size() - 1));
    }
  }

  std::uint32_t part_of(double texture, double object, bool has_objects) {
    const auto [known, is_new] =
        parts_.try_emplace({texture, object}, static_cast<std::uint32_t>(lists_.parts.size()));
    if (is_new) {
      FilePart& part = lists_.parts.emplace_back();
      if (has_objects) {
        part.name = fmt::format("object_id {:.17g}", object);
        part.node = node_of(part.name);
      }
      textures_.push_back(texture >= 0.0 && texture < 1e6 ? static_cast<std::size_t>(texture)
                                                          : PlyElement::kNone);
    }
    return known->second;
  }

  /// Of an object, which may have several textures.
  std::uint32_t node_of(const std::string& name) {
    const auto [known, is_new] = nodes_.try_emplace(name, 0);
    if (is_new) known->second = add_node(lists_.nodes, name, 0);
    return known->second;
  }

  /// Strips of triangles; -1 begins the next one.
  void read_strips(const PlyElement& element) {
    const std::size_t indices = element.find({"vertex_indices", "vertex_index"});
    if (indices == PlyElement::kNone || !element.properties[indices].count) {
      refuse_line(element.line, "the strips have no list 'vertex_indices'");
    }
    note_unused(element, {indices});
    std::vector<double> strip;
    for (std::uint64_t n = 0; n < element.count; ++n, ++face_) {
      begin_entry(element, n);
      read_strip(element, indices, strip);
      end_entry();
      add_strip(strip);
    }
  }

  void read_strip(const PlyElement& element, std::size_t indices, std::vector<double>& strip) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (i == indices) {
        read_list(element.properties[i], strip);
      } else {
        skip_value(element.properties[i]);
      }
    }
  }

  void add_strip(const std::vector<double>& strip) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] == -1.0) {
        begin = i + 1;
        continue;
      }
      const std::uint32_t c = index_of(strip[i]);
      if (i < begin + 2) continue;
      const std::uint32_t a = index_of(strip[i - 2]);
      const std::uint32_t b = index_of(strip[i - 1]);
      // Repeated corners join strips.
      if (a == b || b == c || a == c) continue;
      const bool is_odd = (i - begin) % 2 == 1;
      lists_.faces.add(std::array{is_odd ? b : a, is_odd ? a : b, c});
    }
  }

  void finish() {
    FaceLists& faces = lists_.faces;
    if (limit_ > lists_.positions.size()) {
      throw Refusal{fmt::format("face {} names vertex {}, but there are {} (from 0)", limit_face_,
                                limit_ - 1, lists_.positions.size()),
                    "repair the file, or export the model again"};
    }
    if (!faces.uvs.empty()) faces.uvs.resize(faces.vertices.size(), kNoIndex);
    if (!faces.parts.empty()) faces.parts.resize(faces.size(), 0);
    if (excess_ > 0) {  // MeshLab writes other colours than its header states
      source_.notes.add(fmt::format(
          "faces with more numbers than the header states: {}; their last numbers, and colours of "
          "faces, are not used",
          excess_));
      faces.colours.clear();
    }
    if (!faces.colours.empty() && !lists_.colours.empty()) {
      source_.notes.add("colours of faces are not used: the vertices have colours too");
      faces.colours.clear();
    }
    if (!faces.colours.empty()) faces.colours.resize(faces.size(), Eigen::Vector3f::Ones());
    scale_colours(lists_.colours);
    scale_colours(faces.colours);
  }

  const PlyHeader& header_;
  Values& values_;
  FileContent& file_;
  SourceModel& source_;
  FileLists lists_;
  std::vector<std::uint32_t> corners_;  ///< of the current face
  std::map<std::pair<double, double>, std::uint32_t> parts_;
  std::map<std::string, std::uint32_t> nodes_;  ///< of objects
  std::vector<std::size_t> textures_;
  std::uint64_t face_ = 0;
  std::uint64_t excess_ = 0;      ///< faces with more numbers than the header states
  std::uint32_t limit_ = 0;       ///< one more than the largest index
  std::uint64_t limit_face_ = 0;  ///< that has it
  bool has_vertices_ = false;
};

/// One material for each texture file.
void add_materials(const PlyHeader& header, const std::vector<std::size_t>& textures,
                   FileLists& lists, SourceModel& source) {
  for (const std::string& name : header.textures) {
    SourceMaterial& material = source.materials.emplace_back();
    material.diffuse.emplace().name = name;
    material.material.name = name;
  }
  if (source.materials.empty()) source.materials.emplace_back();
  for (std::size_t i = 0; i < lists.parts.size(); ++i) {
    if (textures[i] < source.materials.size()) {
      lists.parts[i].material = textures[i];
      continue;
    }
    if (!header.textures.empty()) {
      source.notes.add("faces name textures that no line TextureFile names: they are white");
    }
    lists.parts[i].material = source.materials.size();
    source.materials.emplace_back();
  }
}

template <class Values>
void read_body(const ReaderInput& input, const PlyHeader& header, Values values,
               SourceModel& source) {
  source.notes.add(header.notes);
  PlyReader<Values> reader(header, values, input.content(), source);
  reader.read();
  input.release();
  FileLists lists = reader.take_lists();
  if (lists.faces.vertices.empty()) {
    throw no_triangles(fmt::format(", only {} points", lists.positions.size()));
  }
  const bool has_uvs = !lists.uvs.empty() || !lists.faces.uvs.empty();
  if (!header.textures.empty() && !has_uvs) {
    source.notes.add("the file names a texture but has no texture coordinates");
  }
  add_materials(header, reader.textures(), lists, source);
  add_meshes(std::move(lists), source);
}

}  // namespace

SourceModel read_ply(const ReaderInput& input) {
  SourceModel source;
  source.budget.add_input(input.content().size());
  source.format = "Stanford Polygon Library (PLY)";
  std::string_view file = input.bytes();
  if (file.starts_with("\xEF\xBB\xBF")) file.remove_prefix(3);
  const PlyHeader header = read_ply_header(file);
  if (header.encoding == PlyEncoding::ascii) {
    read_body(input, header, TextValues(file.substr(header.size), header.lines), source);
  } else {
    read_body(input, header, BinaryValues(file, header.size, header.encoding == PlyEncoding::big),
              source);
  }
  return source;
}

}  // namespace glidar::import
