// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/declared_frame.hpp>

#include <import/zip_archive.hpp>

#include <glidar/core/text.hpp>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>

namespace glidar::import {
namespace {

constexpr double kCentimetre_m = 0.01;
constexpr double kMillimetre_m = 0.001;
/// Units beyond these limits are errors, and would exceed single precision.
constexpr double kMinUnit_m = 1e-18;
constexpr double kMaxUnit_m = 1e18;

bool is_usable(double metres) {
  return metres >= kMinUnit_m && metres <= kMaxUnit_m;
}

void note_useless_unit(const std::string& metres, Notes& notes) {
  notes.add("the file declares an invalid unit of " + metres + " m: 1 m is assumed");
}

void note_no_element(const char* name, const char* assumed, Notes& notes) {
  notes.add(
      fmt::format("the element <{}> of the file was not found, which declares its unit: "
                  "{} assumed",
                  name, assumed));
}

/// A decimal number of XML; nan for anything else.
double number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = problem == std::errc() && stop == text.data() + text.size();
  return is_number ? number : std::numeric_limits<double>::quiet_NaN();
}

/// The declarations in the asset of a COLLADA document, with the standard's defaults.
struct ColladaAsset {
  std::string meter = "1";
  std::string up_axis = "Y_UP";
};

/// The start of a document; the part that declares a frame is before all geometry.
constexpr std::size_t kMaxText_bytes = std::size_t{16} << 20U;

/// The elements of a text up to its first error. The text may end anywhere.
pugi::xml_document parse_xml(std::string_view text) {
  pugi::xml_document document;
  document.load_buffer(text.data(), std::min(text.size(), kMaxText_bytes));
  return document;
}

/// The name of an element without the prefix of its namespace.
std::string_view local_name(const pugi::xml_node& element) {
  const std::string_view name = element.name();
  return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

/// The first child with this name; an empty node if there is none.
pugi::xml_node child_of(const pugi::xml_node& parent, std::string_view name) {
  return parent.find_child([name](const pugi::xml_node& one) { return local_name(one) == name; });
}

/// The first asset of the document; empty: not a COLLADA document.
std::optional<ColladaAsset> collada_asset(std::string_view text) {
  const pugi::xml_document document = parse_xml(text);
  const pugi::xml_node root = document.document_element();
  if (local_name(root) != "COLLADA") return std::nullopt;
  const pugi::xml_node asset = child_of(root, "asset");
  ColladaAsset found;
  const pugi::xml_attribute meter = child_of(asset, "unit").attribute("meter");
  if (meter) found.meter = trimmed(meter.value());
  const std::string_view up_axis = trimmed(child_of(asset, "up_axis").child_value());
  if (!up_axis.empty()) found.up_axis = up_axis;
  return found;
}

std::optional<Axis> axis_named(std::string_view name) {
  constexpr std::array<std::string_view, 3> kNames = {"X_UP", "Y_UP", "Z_UP"};
  const auto* const known = std::find(kNames.begin(), kNames.end(), name);
  if (known == kNames.end()) return std::nullopt;
  return static_cast<Axis>(known - kNames.begin());
}

/// Assimp multiplies the unit and a rotation to y up into the root node, in single precision. This
/// removes both, because the user may select others.
ModelFrame extract_collada_frame(aiScene& scene, std::string_view text, Notes& notes) {
  scene.mRootNode->mTransformation = aiMatrix4x4();
  const std::optional<ColladaAsset> asset = collada_asset(text);
  if (!asset) {
    note_no_element("COLLADA", "1 m and the axes of the file are", notes);
    return {};
  }
  ModelFrame frame;
  const double metres = number_of(asset->meter);
  if (is_usable(metres)) {
    frame.metres_per_unit = metres;
  } else {
    note_useless_unit("'" + asset->meter + "'", notes);
  }
  frame.up = axis_named(asset->up_axis);
  if (!frame.up) {
    notes.add("the file declares the unknown up axis '" + asset->up_axis + "': its axes are kept");
  }
  return frame;
}

/// The document of a COLLADA file; in a .zae archive, the one named by the manifest.
std::string collada_text(std::string_view file) {
  const ZipArchive archive(file);
  const std::vector<std::string> names = archive.names();
  if (names.empty()) return std::string(file.substr(0, kMaxText_bytes));
  const pugi::xml_document manifest = parse_xml(archive.text("manifest.xml", kMaxText_bytes));
  const pugi::xml_node root =
      manifest.find_node([](const pugi::xml_node& one) { return local_name(one) == "dae_root"; });
  if (root) return archive.text(zip_name(trimmed(root.child_value())), kMaxText_bytes);
  const auto first = std::find_if(names.begin(), names.end(),
                                  [](const std::string& name) { return name.ends_with(".dae"); });
  return first == names.end() ? "" : archive.text(*first, kMaxText_bytes);
}

template <class T>
std::optional<T> metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get(key, value)) return std::nullopt;
  return value;
}

/// Assimp applies neither.
ModelFrame read_fbx(const aiScene& scene, Notes& notes) {
  ModelFrame frame;
  std::optional<double> centimetres = metadata<double>(scene, "UnitScaleFactor");
  if (const auto single = metadata<float>(scene, "UnitScaleFactor")) centimetres = double{*single};
  if (centimetres && is_usable(*centimetres)) {
    frame.metres_per_unit = *centimetres * kCentimetre_m;
  } else if (centimetres) {
    note_useless_unit(fmt::format("{:g}", *centimetres * kCentimetre_m), notes);
  }
  const auto axis = metadata<std::int32_t>(scene, "UpAxis");
  if (!axis || *axis < 0 || *axis > 2) return frame;
  if (metadata<std::int32_t>(scene, "UpAxisSign").value_or(1) < 0) {
    notes.add("the file declares that a negative axis is up: its axes are kept");
    return frame;
  }
  frame.up = static_cast<Axis>(*axis);
  return frame;
}

/// A unit of 3MF and AMF. Their default is the millimetre, their up axis is z.
ModelFrame printed(std::string_view text, const char* element, Notes& notes) {
  struct Named {
    std::string_view name;
    double metres;
  };
  constexpr std::array<Named, 7> kUnits = {{{"micron", 1e-6},
                                            {"millimeter", kMillimetre_m},
                                            {"centimeter", kCentimetre_m},
                                            {"inch", 0.0254},
                                            {"foot", 0.3048},
                                            {"feet", 0.3048},
                                            {"meter", 1.0}}};
  const pugi::xml_document document = parse_xml(text);
  const pugi::xml_node root = document.document_element();
  if (local_name(root) != element) {
    note_no_element(element, "1 m is", notes);
    return {std::nullopt, Axis::z};
  }
  const std::string_view unit = trimmed(root.attribute("unit").value());
  if (unit.empty()) return {kMillimetre_m, Axis::z};
  for (const Named& known : kUnits) {
    if (known.name == unit) return {known.metres, Axis::z};
  }
  notes.add("the file declares the unknown unit '" + std::string(unit) + "': 1 m is assumed");
  return {std::nullopt, Axis::z};
}

/// The model of a 3MF package: the part that its relationships name (Open Packaging Conventions).
std::string model_of_3mf(std::string_view file) {
  static constexpr std::string_view kModel = "/3dmanufacturing/2013/01/3dmodel";
  const ZipArchive archive(file);
  const pugi::xml_document relations = parse_xml(archive.text("_rels/.rels", kMaxText_bytes));
  const pugi::xml_node model = relations.find_node([](const pugi::xml_node& one) {
    return std::string_view(one.attribute("Type").value()).ends_with(kModel);
  });
  const std::string name = model ? zip_name(model.attribute("Target").value()) : "3D/3dmodel.model";
  return archive.text(name, kMaxText_bytes);
}

}  // namespace

ModelFrame extract_declared_frame(aiScene& scene, const std::string& format, FileContent& file,
                                  Notes& notes) {
  if (format.find("Collada") != std::string::npos) {
    return extract_collada_frame(scene, collada_text(file.whole()), notes);
  }
  if (format.find("FBX") != std::string::npos) return read_fbx(scene, notes);
  if (format.starts_with("3mf") || format.starts_with("3MF")) {
    return printed(model_of_3mf(file.whole()), "model", notes);
  }
  if (format.find("AMF") != std::string::npos) {
    return printed(file.whole(), "amf", notes);
  }
  return {};
}

}  // namespace glidar::import
