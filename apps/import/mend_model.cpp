// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/mend_model.hpp>

#include <import/mend_collada.hpp>
#include <import/source_model.hpp>
#include <import/zip_archive.hpp>

#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

namespace glidar::import {
namespace {

constexpr std::size_t kHead = 4096;  // formats show themselves in so many bytes

bool is_utf16(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") ||
         bytes.starts_with("<\0"sv) || bytes.starts_with("\0<"sv);
}

pugi::xml_document parsed_xml(std::string_view text, const std::string& what,
                              unsigned options = pugi::parse_default) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size(), options);
  if (!result) {
    throw Refusal{
        fmt::format("{} cannot be read: {} at byte {}", what, result.description(), result.offset),
        "the file is damaged or cut off: export it again"};
  }
  return document;
}

std::string as_utf8(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw, pugi::encoding_utf8);
  return std::move(text).str();
}

using NodeNames = std::map<std::string, std::string>;

void add_names(const pugi::xml_node& root, std::string_view element, const std::string& prefix,
               NodeNames& names) {
  root.find_node([&](const pugi::xml_node& node) {
    if (node.name() != element) return false;
    const std::string id = node.attribute(node.attribute("id") ? "id" : "sid").value();
    const std::string name = node.attribute("name").value();
    if (!id.empty() && !name.empty()) names.try_emplace(prefix + id, name);
    return false;  // visits all
  });
}

std::string mended_collada(std::string_view text, Notes& notes, NodeNames& names) {
  // Assimp does not skip white space before the first number of some lists.
  pugi::xml_document document =
      parsed_xml(text, "its XML", pugi::parse_default | pugi::parse_trim_pcdata);
  mend_collada(document, notes);
  add_names(document, "node", "", names);
  return as_utf8(document);
}

bool is_collada(std::string_view extension, std::string_view head) {
  using namespace std::string_view_literals;
  return extension == ".dae" || head.find("<COLLADA") != std::string_view::npos ||
         head.find("<\0C\0O\0L\0L\0A\0D\0A"sv) != std::string_view::npos;
}

/// The document of a .zae archive, as Assimp selects it: the one that the manifest names, else the
/// first one; none in other archives.
std::optional<std::string> document_of_zae(const ZipArchive& archive,
                                           const std::vector<std::string>& names) {
  const bool has_manifest = std::find(names.begin(), names.end(), "manifest.xml") != names.end();
  if (has_manifest) {
    const pugi::xml_document manifest =
        parsed_xml(archive.content("manifest.xml"), "the XML of manifest.xml");
    std::string name = zip_name(trimmed(manifest.child("dae_root").child_value()));
    if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  }
  const auto first = std::find_if(names.begin(), names.end(), [](const std::string& name) {
    return lower_case(name).ends_with(".dae");
  });
  return first == names.end() ? std::nullopt : std::optional(*first);
}

std::map<std::string, std::string> unpacked(const ZipArchive& archive,
                                            const std::vector<std::string>& names) {
  std::map<std::string, std::string> files;
  for (const std::string& name : names) {
    if (!name.ends_with('/')) files[name] = archive.content(name);
  }
  return files;
}

// 3MF (3D Manufacturing Format, Core Specification 1.3).

bool is_picture(const std::string& name) {
  const std::string lower = lower_case(name);
  return lower.ends_with(".png") || lower.ends_with(".jpg") || lower.ends_with(".jpeg");
}

/// Extensions whose elements Assimp reads, or that state nothing about the shape.
bool is_read(std::string_view name_space) {
  return name_space.find("/core/") != std::string_view::npos ||
         name_space.find("/material/") != std::string_view::npos ||
         name_space.find("/production/") != std::string_view::npos ||  // without paths
         name_space.find("/trianglesets/") != std::string_view::npos;
}

void check_extensions(const pugi::xml_node& model, Notes& notes) {
  const std::string required =
      std::string(" ") + model.attribute("requiredextensions").value() + " ";
  for (const pugi::xml_attribute& attribute : model.attributes()) {
    const std::string_view name = attribute.name();
    if (!name.starts_with("xmlns:") || is_read(attribute.value())) continue;
    const std::string prefix(name.substr(6));
    if (required.find(" " + prefix + " ") == std::string::npos) continue;
    throw Refusal{fmt::format("it requires the extension '{}' of 3MF, which GLIDAR does not read",
                              std::string_view(attribute.value()).substr(0, 120)),
                  "export it without that extension, or as STL or glTF"};
  }
  const auto lattice = model.find_node([](const pugi::xml_node& node) {
    return std::string_view(node.name()).ends_with(":beamlattice");
  });
  if (lattice) notes.add("a lattice of beams (3MF) is left out");
}

/// Parts in other files (the production extension) would be left out.
void check_paths(const pugi::xml_node& model) {
  const auto elsewhere = model.find_node([](const pugi::xml_node& node) {
    const std::string_view name = node.name();
    if (name != "component" && name != "item") return false;
    return std::any_of(node.attributes_begin(), node.attributes_end(),
                       [](const pugi::xml_attribute& attribute) {
                         return std::string_view(attribute.name()).ends_with(":path");
                       });
  });
  if (!elsewhere) return;
  throw Refusal{
      "its parts are in models of their own (the production extension of 3MF), which "
      "GLIDAR does not read",
      "export it without that extension, or as STL or glTF"};
}

/// Assimp's time grows with the square of the instances that an object or the build places.
void check_instances(const pugi::xml_node& model) {
  constexpr std::size_t kMost = 20'000;
  const auto full = model.find_node([](const pugi::xml_node& node) {
    const std::string_view name = node.name();
    if (name != "components" && name != "build") return false;
    const auto children = node.children();
    return static_cast<std::size_t>(std::distance(children.begin(), children.end())) > kMost;
  });
  if (!full) return;
  throw Refusal{fmt::format("its element '{}' places more than {} objects", full.name(), kMost),
                "place them by a scene file"};
}

/// A group of materials or colours (3MF) and an index into it.
using Property = std::pair<std::string, std::string>;

/// Of a triangle; where it has none, that of its object.
Property property_of(const pugi::xml_node& triangle, const pugi::xml_node& object) {
  const pugi::xml_node& group = triangle.attribute("pid") ? triangle : object;
  const pugi::xml_attribute index = triangle.attribute("p1");
  return {group.attribute("pid").value(), (index ? index : object.attribute("pindex")).value()};
}

using Triangles = std::vector<pugi::xml_node>;

std::map<Property, Triangles> triangles_by_property(const pugi::xml_node& object, Notes& notes) {
  std::map<Property, Triangles> found;
  for (const pugi::xml_node& triangle : object.child("mesh").child("triangles").children()) {
    if (std::string_view(triangle.name()) != "triangle") continue;
    found[property_of(triangle, object)].push_back(triangle);
    for (const char* other : {"p2", "p3"}) {
      const pugi::xml_attribute index = triangle.attribute(other);
      if (!index || index.value() == std::string_view(triangle.attribute("p1").value())) continue;
      notes.add("colours that vary within triangles (3MF) are not used, but those of their p1");
    }
  }
  return found;
}

/// Adds an object before another one, with some of its triangles.
void add_object(pugi::xml_node whole, unsigned id, const Property& property,
                const Triangles& triangles) {
  pugi::xml_node part = whole.parent().insert_child_before("object", whole);
  part.append_attribute("id").set_value(id);
  pugi::xml_node mesh = part.append_child("mesh");
  mesh.append_copy(whole.child("mesh").child("vertices"));
  pugi::xml_node list = mesh.append_child("triangles");
  for (const pugi::xml_node& triangle : triangles) {
    pugi::xml_node copy = list.append_copy(triangle);
    for (const char* name : {"pid", "p1", "p2", "p3"}) copy.remove_attribute(name);
    if (property.first.empty()) continue;
    copy.append_attribute("pid").set_value(property.first.c_str());
    copy.append_attribute("p1").set_value(property.second.c_str());
  }
}

/// Assimp gives all triangles of an object the material of the last one. Replaces objects with
/// several materials by components, one for each.
void split_materials(const pugi::xml_node& model, Notes& notes) {
  constexpr std::ptrdiff_t kMostVertices = 4'000'000;  // each part has those of the object
  std::vector<pugi::xml_node> objects;
  std::ptrdiff_t vertices_left = kMostVertices;
  unsigned last_id = 0;
  for (const pugi::xml_node& resource : model.child("resources").children()) {
    last_id = std::max(last_id, resource.attribute("id").as_uint());
    if (std::string_view(resource.name()) == "object") objects.push_back(resource);
  }
  for (pugi::xml_node& object : objects) {
    const std::map<Property, Triangles> parts = triangles_by_property(object, notes);
    if (parts.size() < 2) continue;
    const auto vertices = object.child("mesh").child("vertices").children();
    vertices_left -=
        static_cast<std::ptrdiff_t>(parts.size()) * std::distance(vertices.begin(), vertices.end());
    if (vertices_left < 0) {
      return notes.add("triangles of an object have too many materials (3MF): they have one");
    }
    pugi::xml_node components = object.append_child("components");
    for (const auto& [property, triangles] : parts) {
      add_object(object, ++last_id, property, triangles);
      components.append_child("component").append_attribute("objectid").set_value(last_id);
    }
    object.remove_child("mesh");
  }
}

/// The pictures that the resources of a model refer to.
void add_pictures(const pugi::xml_node& model, std::set<std::string>& pictures) {
  for (const pugi::xml_node& resource : model.child("resources")) {
    const pugi::xml_attribute path = resource.attribute("path");
    if (path) pictures.insert(zip_name(path.value()));
  }
}

std::string mended_3mf(const ZipArchive& archive, const std::vector<std::string>& names,
                       Notes& notes, NodeNames& node_names) {
  std::map<std::string, std::string> kept;
  std::set<std::string> pictures;
  for (const std::string& name : names) {
    if (is_picture(name) || name.ends_with('/')) continue;
    std::string content = archive.content(name);
    if (name.ends_with(".model")) {
      const pugi::xml_document document = parsed_xml(content, "the XML of " + name);
      split_materials(document.document_element(), notes);
      check_extensions(document.document_element(), notes);
      check_paths(document.document_element());
      check_instances(document.document_element());
      add_pictures(document.document_element(), pictures);
      add_names(document, "object", "Object_", node_names);
      content = as_utf8(document);
    }
    kept.emplace(name, std::move(content));
  }
  for (const std::string& name : names) {
    if (is_picture(name) && pictures.contains(zip_name(name))) kept[name] = archive.content(name);
  }
  return make_zip(kept);
}

/// Nothing for an archive of another kind.
std::optional<std::string> mended_archive(std::string_view file, Notes& notes,
                                          NodeNames& node_names) {
  const ZipArchive archive(file);
  const std::vector<std::string> names = archive.names();
  const bool is_3mf = std::any_of(names.begin(), names.end(),
                                  [](const std::string& name) { return name.ends_with(".model"); });
  if (is_3mf) return mended_3mf(archive, names, notes, node_names);
  const auto collada = document_of_zae(archive, names);
  if (!collada) return std::nullopt;
  std::map<std::string, std::string> files = unpacked(archive, names);
  files[*collada] = mended_collada(files[*collada], notes, node_names);
  return make_zip(files);
}

}  // namespace

NodeNames mend_model(const std::filesystem::path& model, ModelFiles& files, Notes& notes) {
  NodeNames names;
  const auto file = files.content(model.string());
  if (file == nullptr) return names;
  const std::string extension = lower_case(model.extension().string());
  const std::string_view head = file->head(kHead);
  if (head.starts_with("PK\x03\x04")) {
    auto archive = mended_archive(file->whole(), notes, names);
    if (archive) files.replace(model.string(), std::move(*archive));
  } else if (is_collada(extension, head)) {
    files.replace(model.string(), mended_collada(file->whole(), notes, names));
  } else if (is_utf16(head)) {
    files.replace(model.string(), as_utf8(parsed_xml(file->whole(), "its XML")));
  }
  return names;
}

}  // namespace glidar::import
