// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/declared_frame.hpp>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <zip.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace glidar::import {
namespace {

constexpr double kCentimetre_m = 0.01;
constexpr double kMillimetre_m = 0.001;
constexpr std::size_t kHead = 65536;  ///< bytes in which the first element of a file is looked for

bool is_usable(double metres) {
  return std::isfinite(metres) && metres > 0.0;
}

void note_useless_unit(double metres, std::vector<std::string>& notes) {
  notes.push_back(
      fmt::format("the file declares a unit of {:g} m, which cannot be: 1 m is assumed", metres));
}

/// Assimp multiplies the unit and a rotation that makes y up into the root node. There they are
/// read, and taken away, since whoever loads the model may choose others.
ModelFrame take_collada(aiScene& scene, std::vector<std::string>& notes) {
  ModelFrame frame;
  aiMatrix4x4& root = scene.mRootNode->mTransformation;
  const std::array<float, 3> to_y = {root.b1, root.b2, root.b3};
  for (std::size_t axis = 0; axis < to_y.size(); ++axis) {
    if (!(to_y[axis] > 0.0F)) continue;
    // the decimal number that was rounded to single precision
    frame.metres_per_unit = std::stod(fmt::format("{}", to_y[axis]));
    frame.up = static_cast<Axis>(axis);
  }
  if (!frame.metres_per_unit) note_useless_unit(double{root.b2}, notes);
  root = aiMatrix4x4();
  return frame;
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
    note_useless_unit(*centimetres * kCentimetre_m, notes);
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

/// The value of the attribute `unit` of the first element `name`; empty: it has none.
std::string unit_attribute(const std::string& xml, const std::string& name) {
  const std::size_t start = xml.find("<" + name);
  if (start == std::string::npos) return "";
  const std::string element = xml.substr(start, xml.find('>', start) - start);
  for (const std::string quote : {"\"", "'"}) {
    const std::size_t at = element.find(" unit=" + quote);
    if (at == std::string::npos) continue;
    const std::size_t first = at + std::string_view(" unit=\"").size();
    return element.substr(first, element.find(quote, first) - first);
  }
  return "";
}

/// A unit of 3MF and AMF. Their default is the millimetre, their up axis is z.
ModelFrame printed(const std::string& unit, std::vector<std::string>& notes) {
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
  if (unit.empty()) return {kMillimetre_m, Axis::z};
  for (const Named& known : kUnits) {
    if (known.name == unit) return {known.metres, Axis::z};
  }
  notes.push_back("the file declares the unknown unit '" + unit + "': 1 m is assumed");
  return {std::nullopt, Axis::z};
}

struct CloseZip {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* part) const { zip_fclose(part); }
};

/// The first bytes of the model part of a 3MF package; empty when there is none.
std::string head_of_3mf(std::string_view package) {
  zip_source_t* source = zip_source_buffer_create(package.data(), package.size(), 0, nullptr);
  if (source == nullptr) return "";
  const std::unique_ptr<zip_t, CloseZip> archive(zip_open_from_source(source, ZIP_RDONLY, nullptr));
  if (archive == nullptr) zip_source_free(source);
  if (archive == nullptr) return "";
  const std::unique_ptr<zip_file_t, CloseZip> part(zip_fopen(archive.get(), "3D/3dmodel.model", 0));
  if (part == nullptr) return "";
  std::string text(kHead, '\0');
  const zip_int64_t read = zip_fread(part.get(), text.data(), text.size());
  text.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
  return text;
}

}  // namespace

ModelFrame take_declared_frame(aiScene& scene, const std::string& format, FileContent& file,
                               std::vector<std::string>& notes) {
  if (format.find("Collada") != std::string::npos) return take_collada(scene, notes);
  if (format.find("FBX") != std::string::npos) return read_fbx(scene, notes);
  if (format.starts_with("glTF")) return {1.0, Axis::y};
  if (format.starts_with("3mf") || format.starts_with("3MF")) {
    return printed(unit_attribute(head_of_3mf(file.whole()), "model"), notes);
  }
  if (format.find("AMF") != std::string::npos) {
    return printed(unit_attribute(std::string(file.head(kHead)), "amf"), notes);
  }
  return {};
}

}  // namespace glidar::import
