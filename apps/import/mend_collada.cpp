// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mend_collada.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>

namespace glidar::import {
namespace {

using Node = pugi::xml_node;

constexpr const char* kExport = "export it with another setting or program, such as to glTF";

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The numbers of a list of integers. Throws Refusal for other text.
std::vector<std::uint32_t> integers_of(const Node& list) {
  std::string_view text = list.child_value();
  std::vector<std::uint32_t> all;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (text.empty()) return all;
    std::uint32_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc()) {
      throw Refusal{
          fmt::format("<{}> has '{}', which is no index", list.name(), text.substr(0, 20)),
          "repair the file"};
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    all.push_back(value);
  }
}

class Mender {
 public:
  explicit Mender(pugi::xml_document& document, Notes& notes)
      : root_(document.document_element()), notes_(notes) {
    // Explicit walks, because hostile documents are deep.
    for (Node node = root_; node; node = following(node)) strip_prefix(node);
    if (root_.name() != std::string_view("COLLADA")) {
      throw Refusal{"its XML has no element <COLLADA> around all others", kExport};
    }
    drop_libraries();
    for (Node node = root_; node; node = following(node)) elements_[node.name()].push_back(node);
  }

  void mend() {
    refuse_unreadable();
    for (const char* name : {"instance_camera", "instance_light"}) {
      for (Node node : elements_[name]) node.parent().remove_child(node);
    }
    for (const Node& node : elements_["color"]) complete_colour(node);
    for (const Node& node : elements_["accessor"]) name_parameters(node);
    drop_textures();
    for (const char* name : {"tristrips", "trifans"}) {
      for (const Node& node : elements_[name]) unfold(node, name == std::string_view("tristrips"));
    }
    for (const char* name :
         {"triangles", "polylist", "polygons", "lines", "linestrips", "vertices"}) {
      for (const Node& node : elements_[name]) mend_inputs(node);
    }
    for (const Node& node : made_) mend_inputs(node);
    note_geometries();
  }

 private:
  /// The next element of the document, parents first.
  [[nodiscard]] Node following(Node node) const {
    const auto first_element = [](Node sibling) {
      while (sibling && sibling.type() != pugi::node_element) sibling = sibling.next_sibling();
      return sibling;
    };
    if (const Node child = first_element(node.first_child())) return child;
    for (; node && node != root_; node = node.parent()) {
      if (const Node next = first_element(node.next_sibling())) return next;
    }
    return {};
  }

  static void strip_prefix(Node& node) {
    const std::string_view name = node.name();
    const std::size_t colon = name.find(':');
    if (colon < name.size() - 1) node.set_name(std::string(name.substr(colon + 1)).c_str());
  }

  void refuse_unreadable() {
    if (!elements_["ph"].empty()) throw Refusal{"it has polygons with holes (<ph>)", kExport};
    if (!elements_["skew"].empty()) throw Refusal{"it has skewed nodes (<skew>)", kExport};
    for (const char* name : {"instance_geometry", "instance_controller", "instance_node"}) {
      for (const Node& node : elements_[name]) {
        const std::string_view url = node.attribute("url").value();
        if (url.starts_with('#')) continue;
        throw Refusal{fmt::format("<{}> refers to '{}', another document", name, url.substr(0, 80)),
                      "put all parts into one file"};
      }
    }
  }

  /// What Assimp does not read, or needs for nothing that is measured.
  void drop_libraries() {
    std::string left_out;
    std::vector<Node> unused;
    for (const Node& child : root_.children()) {
      if (child.type() != pugi::node_element ||
          is_one_of(child.name(), {"asset", "library_geometries", "library_images",
                                   "library_materials", "library_effects", "library_controllers",
                                   "library_visual_scenes", "library_nodes", "scene", "extra"})) {
        continue;
      }
      unused.push_back(child);
      if (child.first_child())
        left_out += (left_out.empty() ? "" : ", ") + std::string(child.name());
    }
    for (const Node& child : unused) root_.remove_child(child);
    if (!left_out.empty())
      notes_.add("parts of the document are left out: " + left_out.substr(0, 200));
  }

  /// Whether an image names a file or has data.
  static bool has_content(const Node& image) {
    for (const char* name : {"init_from", "data", "create_2d"}) {
      const Node child = image.child(name);
      if (!trimmed(child.child_value()).empty()) return true;
      for (const Node& inner : child.children()) {  // COLLADA 1.5: <ref>, <hex>, <init_from>
        if (!trimmed(inner.child_value()).empty() || inner.first_child()) return true;
      }
    }
    return false;
  }

  /// The image of a texture: its own, or by a sampler and a surface of the effect.
  static std::string image_of(const Node& texture) {
    std::string name = texture.attribute("texture").value();
    Node effect = texture;
    while (effect && std::string_view(effect.name()) != "effect") effect = effect.parent();
    for (int step = 0; step < 2; ++step) {
      const Node parameter = effect.find_node([&](const Node& node) {
        return std::string_view(node.name()) == "newparam" && node.attribute("sid").value() == name;
      });
      const Node sampler = parameter.child("sampler2D");
      const std::string_view url = sampler.child("instance_image").attribute("url").value();
      if (url.starts_with('#')) return std::string(url.substr(1));
      const Node next =
          sampler ? sampler.child("source") : parameter.child("surface").child("init_from");
      if (!next) break;
      name = trimmed(next.child_value());
    }
    return name;
  }

  /// Textures without an image, and images without a file: Assimp refuses documents with them.
  void drop_textures() {
    std::set<std::string> images;
    for (Node image : elements_["image"]) {
      if (has_content(image)) {
        images.insert(image.attribute("id").value());
      } else {
        image.parent().remove_child(image);
      }
    }
    for (Node texture : elements_["texture"]) {
      Node property = texture.parent();
      // Beside a texture, the colour is white (COLLADA 1.4.1, "common_color_or_texture_type").
      const bool has_image = images.contains(image_of(texture));
      if (!has_image) {
        notes_.add(fmt::format("a texture without a file is left out: '{}'",
                               std::string(texture.attribute("texture").value()).substr(0, 80)));
        property.remove_child(texture);
      }
      const bool is_colour = is_one_of(property.name(), {"diffuse", "specular"});
      if (is_colour && !property.child("color")) {
        property.append_child("color").append_child(pugi::node_pcdata).set_value("1 1 1 1");
      } else if (!property.first_child()) {
        property.parent().remove_child(property);
      }
    }
  }

  /// Assimp refuses documents with colours of three numbers.
  static void complete_colour(const Node& colour) {
    const std::string text(trimmed(colour.child_value()));
    std::size_t numbers = 0;
    for (std::size_t at = 0; at < text.size(); ++numbers) {
      at = text.find_first_not_of(kWhiteSpace,
                                  std::min(text.find_first_of(kWhiteSpace, at), text.size()));
    }
    if (numbers == 3) colour.text().set((text + " 1").c_str());
  }

  /// Assimp reads parameters without names as the first one.
  void name_parameters(const Node& accessor) {
    std::vector<Node> parameters;
    for (const Node& parameter : accessor.children("param")) {
      if (*parameter.attribute("name").value() != '\0') return;
      parameters.push_back(parameter);
    }
    if (parameters.size() < 2 || parameters.size() > 4) return;
    notes_.add("parameters without names are read in their order");
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const char* const name = std::array{"X", "Y", "Z", "W"}[i];
      parameters[i].remove_attribute("name");
      parameters[i].append_attribute("name").set_value(name);
    }
  }

  /// Assimp counts the indices of a corner by the inputs that it knows, and refuses tangents
  /// without binormals. A set of texture coordinates beyond its last one is read and left out.
  void mend_inputs(const Node& primitive) {
    bool has_tangents = false;
    bool has_binormals = false;
    for (const Node& input : primitive.children("input")) {
      const std::string_view semantic = input.attribute("semantic").value();
      has_tangents = has_tangents || is_one_of(semantic, {"TEXTANGENT", "TANGENT"});
      has_binormals = has_binormals || is_one_of(semantic, {"TEXBINORMAL", "BINORMAL"});
    }
    std::vector<Node> unused;
    for (const Node& input : primitive.children("input")) {
      const std::string_view semantic = input.attribute("semantic").value();
      const bool is_frame =
          is_one_of(semantic, {"TEXTANGENT", "TANGENT", "TEXBINORMAL", "BINORMAL"});
      const bool is_read =
          is_one_of(semantic, {"VERTEX", "POSITION", "NORMAL", "TEXCOORD", "COLOR"}) ||
          (is_frame && has_tangents && has_binormals);
      if (is_read) continue;
      if (!is_frame) notes_.add("inputs are left out: " + std::string(semantic.substr(0, 80)));
      unused.push_back(input);
    }
    for (Node input : unused) {
      if (!input.attribute("offset")) {
        input.parent().remove_child(input);
        continue;
      }
      input.attribute("semantic").set_value("TEXCOORD");
      if (!input.attribute("set")) input.append_attribute("set");
      input.attribute("set").set_value("99");
    }
  }

  /// Writes the indices of the triangles of a strip or a fan, `stride` for each corner; returns
  /// their number.
  static std::size_t append_triangles(const std::vector<std::uint32_t>& indices, std::size_t stride,
                                      bool is_strip, std::string& text) {
    const std::size_t corners = indices.size() / stride;
    std::size_t count = 0;
    for (; count + 2 < corners; ++count) {
      const std::size_t first = is_strip ? count : 0;
      const std::size_t odd = is_strip ? count % 2 : 0;
      for (const std::size_t corner : {first, count + 1 + odd, count + 2 - odd}) {
        const auto begin = indices.begin() + static_cast<std::ptrdiff_t>(corner * stride);
        text +=
            fmt::format("{} ", fmt::join(begin, begin + static_cast<std::ptrdiff_t>(stride), " "));
      }
    }
    return count;
  }

  /// Triangles instead of strips or fans, of which Assimp leaves out the latter.
  void unfold(Node from, bool is_strip) {
    std::size_t stride = 1;
    for (const Node& input : from.children("input")) {
      stride = std::max<std::size_t>(stride, input.attribute("offset").as_uint() + 1);
    }
    std::string text;
    std::size_t count = 0;
    for (const Node& list : from.children("p")) {
      count += append_triangles(integers_of(list), stride, is_strip, text);
    }
    while (Node list = from.child("p")) from.remove_child(list);
    from.set_name("triangles");
    from.remove_attribute("count");
    from.append_attribute("count").set_value(static_cast<unsigned>(count));
    from.append_child("p").append_child(pugi::node_pcdata).set_value(text.c_str());
    made_.push_back(from);
  }

  void note_geometries() {
    for (const char* name : {"spline", "brep", "convex_mesh"}) {
      const std::size_t count = elements_[name].size();
      if (count > 0) notes_.add(fmt::format("{} geometries are <{}>: left out", count, name));
    }
    const std::size_t morphs = elements_["morph"].size();
    if (morphs > 0)
      notes_.add(fmt::format("{} meshes are morphed: shown in their base shape", morphs));
    const std::size_t scenes = elements_["visual_scene"].size();
    if (scenes > 1) notes_.add(fmt::format("one of {} visual scenes is loaded", scenes));
  }

  Node root_;
  Notes& notes_;
  std::map<std::string, std::vector<Node>> elements_;  ///< by their local names
  std::vector<Node> made_;
};

}  // namespace

void mend_collada(pugi::xml_document& document, Notes& notes) {
  Mender(document, notes).mend();
}

}  // namespace glidar::import
