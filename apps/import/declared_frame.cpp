// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/declared_frame.hpp>

#include <import/text_source.hpp>
#include <import/xml_reader.hpp>

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

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

void note_useless_unit(const std::string& metres, std::vector<std::string>& notes) {
  notes.push_back("the file declares an invalid unit of " + metres + " m: 1 m is assumed");
}

void note_no_element(const char* name, const char* assumed, std::vector<std::string>& notes) {
  notes.push_back(
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

/// The first asset of the document; empty: not a COLLADA document.
std::optional<ColladaAsset> collada_asset(TextSource text) {
  using Kind = XmlEvent::Kind;
  const std::vector<std::string> asset = {"COLLADA", "asset"};
  ColladaAsset found;
  XmlReader reader(std::move(text));
  std::vector<std::string> path;
  std::string up_axis;
  bool is_collada = false;
  for (XmlEvent event = reader.next(); event.kind != Kind::finished; event = reader.next()) {
    if (event.kind == Kind::start) path.push_back(event.name);
    if (path.empty()) continue;
    if (path.front() != asset.front()) return std::nullopt;
    is_collada = true;
    const bool is_in_asset =
        path.size() == 3 && std::equal(asset.begin(), asset.end(), path.begin());
    if (is_in_asset && path.back() == "up_axis") up_axis += event.text;
    const auto meter = event.attributes.find("meter");
    if (is_in_asset && path.back() == "unit" && meter != event.attributes.end())
      found.meter = trimmed(meter->second);
    if (event.kind != Kind::end) continue;
    if (path == asset) break;
    path.pop_back();
  }
  if (!is_collada) return std::nullopt;
  if (!trimmed(up_axis).empty()) found.up_axis = trimmed(up_axis);
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
ModelFrame extract_collada_frame(aiScene& scene, TextSource text, std::vector<std::string>& notes) {
  scene.mRootNode->mTransformation = aiMatrix4x4();
  const std::optional<ColladaAsset> asset = collada_asset(std::move(text));
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
    notes.push_back("the file declares the unknown up axis '" + asset->up_axis +
                    "': its axes are kept");
  }
  return frame;
}

/// The document of a COLLADA file; in a .zae archive, the one named by the manifest.
TextSource collada_text(std::string_view file) {
  const std::vector<std::string> names = zip_names(file);
  if (names.empty()) return plain_text(file);
  XmlReader manifest(zip_text(file, "manifest.xml"));
  bool is_root = false;
  for (XmlEvent event = manifest.next(); event.kind != XmlEvent::Kind::finished;
       event = manifest.next()) {
    if (is_root && event.kind == XmlEvent::Kind::text)
      return zip_text(file, zip_name(trimmed(event.text)));
    is_root = event.kind == XmlEvent::Kind::start && event.name == "dae_root";
  }
  const auto first = std::find_if(names.begin(), names.end(),
                                  [](const std::string& name) { return name.ends_with(".dae"); });
  return zip_text(file, first == names.end() ? "" : *first);
}

template <class T>
std::optional<T> metadata(const aiScene& scene, const char* key) {
  T value{};
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get(key, value)) return std::nullopt;
  return value;
}

/// Assimp applies neither.
ModelFrame read_fbx(const aiScene& scene, std::vector<std::string>& notes) {
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
    notes.emplace_back("the file declares that a negative axis is up: its axes are kept");
    return frame;
  }
  frame.up = static_cast<Axis>(*axis);
  return frame;
}

/// An attribute of the document's element `name`, "" if it is missing; empty: the document has
/// another element or none.
std::optional<std::string> root_attribute(TextSource text, std::string_view name,
                                          const std::string& attribute) {
  XmlReader reader(std::move(text));
  XmlEvent event = reader.next();
  while (event.kind == XmlEvent::Kind::text) event = reader.next();
  if (event.kind != XmlEvent::Kind::start || event.name != name) return std::nullopt;
  return trimmed(event.attributes[attribute]);
}

/// A unit of 3MF and AMF. Their default is the millimetre, their up axis is z.
ModelFrame printed(TextSource text, const char* element, std::vector<std::string>& notes) {
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
  const std::optional<std::string> unit = root_attribute(std::move(text), element, "unit");
  if (!unit) {
    note_no_element(element, "1 m is", notes);
    return {std::nullopt, Axis::z};
  }
  if (unit->empty()) return {kMillimetre_m, Axis::z};
  for (const Named& known : kUnits) {
    if (known.name == *unit) return {known.metres, Axis::z};
  }
  notes.push_back("the file declares the unknown unit '" + *unit + "': 1 m is assumed");
  return {std::nullopt, Axis::z};
}

/// The model of a 3MF package: the part that its relationships name (Open Packaging Conventions).
TextSource model_of_3mf(std::string_view file) {
  constexpr std::string_view kModel = "/3dmanufacturing/2013/01/3dmodel";
  XmlReader relations(zip_text(file, "_rels/.rels"));
  for (XmlEvent event = relations.next(); event.kind != XmlEvent::Kind::finished;
       event = relations.next()) {
    if (event.kind == XmlEvent::Kind::start && event.attributes["Type"].ends_with(kModel))
      return zip_text(file, zip_name(event.attributes["Target"]));
  }
  return zip_text(file, "3D/3dmodel.model");
}

}  // namespace

ModelFrame extract_declared_frame(aiScene& scene, const std::string& format, FileContent& file,
                                  std::vector<std::string>& notes) {
  if (format.find("Collada") != std::string::npos) {
    return extract_collada_frame(scene, collada_text(file.whole()), notes);
  }
  if (format.find("FBX") != std::string::npos) return read_fbx(scene, notes);
  if (format.starts_with("glTF")) return {1.0, Axis::y};
  if (format.starts_with("3mf") || format.starts_with("3MF")) {
    return printed(model_of_3mf(file.whole()), "model", notes);
  }
  if (format.find("AMF") != std::string::npos) {
    return printed(plain_text(file.whole()), "amf", notes);
  }
  return {};
}

}  // namespace glidar::import
