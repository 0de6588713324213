// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/unread_formats.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace glidar::import {
namespace {

using namespace std::string_view_literals;

constexpr const char* kBlender = "convert it to glTF or PLY: open it in Blender and export it";
constexpr const char* kCad =
    "convert it to STL, OBJ or glTF: open it in FreeCAD or a CAD program and export a mesh";
constexpr const char* kUsd = "convert it to glTF: import it in Blender and export it";
constexpr const char* kVrml =
    "convert it to PLY, OBJ or glTF: import it in MeshLab or Blender and export it";
constexpr const char* kPoints =
    "GLIDAR needs surfaces: make a mesh of the points first, such as by "
    "Poisson reconstruction in MeshLab or CloudCompare";
constexpr const char* kRobot = "name the mesh files that it lists, one by one or in a scene file";
constexpr const char* kArchive = "unpack it, and name the model in it";
constexpr const char* kScientific = "convert it to PLY or STL: open it in ParaView and save it";
constexpr const char* kMaker = "export it as glTF, OBJ or STL in the program that made it";

struct Format {
  const char* name;
  const char* remedy;
  std::string_view mark;        ///< how its files begin; empty: by the extension alone
  std::string_view extensions;  ///< separated by spaces, each with its dot
};

// Marks first, so that a file with a wrong extension is named too.
constexpr std::array kFormats = std::to_array<Format>({
    {"VRML", kVrml, "#VRML V", ".wrl .vrml .wrz"},
    {"X3D", kVrml, "", ".x3d .x3dz"},
    {"X3D (classic encoding)", kVrml, "#X3D V", ".x3dv"},
    {"X3D (binary)", kVrml, "\xE0\0\0\x01"sv, ".x3db"},
    {"USD (text)", kUsd, "#usda ", ".usda"},
    {"USD (binary)", kUsd, "PXR-USDC", ".usdc"},
    {"USD", kUsd, "", ".usd .usdz"},
    {"Blender", kBlender, "BLENDER", ".blend"},
    {"Maya (text)", kMaker, "//Maya ASCII", ".ma"},
    {"Maya (binary)", kMaker, "", ".mb"},
    {"Rhino", kMaker, "3D Geometry File Format ", ".3dm"},
    {"AutoCAD drawing", kMaker, "AC10", ".dwg"},
    {"Cinema 4D", kMaker, "QC4DC4D6", ".c4d"},
    {"SketchUp", kMaker, "\xFF\xFE\xFF\x0E", ".skp"},
    {"3ds Max", kMaker, "", ".max"},
    {"Alembic", kBlender, "Ogawa\xFF", ".abc"},
    {"OpenCTM", kVrml, "OCTM", ".ctm"},
    {"Universal 3D", kVrml, "U3D\0"sv, ".u3d"},
    {"PDF", kMaker, "%PDF-", ".pdf"},
    {"IGES", kCad, "", ".iges .igs"},
    {"STEP", kCad, "", ".step .stp .p21 .stpz"},
    {"Parasolid", kCad, "**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz**", ".x_t .x_b"},
    {"ACIS", kCad, "ACIS BinaryFile", ".sat .sab"},
    {"Open Cascade", kCad, "DBRep_DrawableShape", ".brep .brp"},
    {"JT", kCad, "Version 8.", ".jt"},
    {"FreeCAD", kCad, "", ".fcstd"},
    {"SolidWorks", kCad, "", ".sldprt .sldasm"},
    {"CATIA", kCad, "V5_CFV2", ".catpart .catproduct .cgr"},
    {"Inventor", kCad, "", ".ipt .iam"},
    {"Creo", kCad, "#UGC:2", ".prt"},
    {"OpenSCAD", "export it as STL in OpenSCAD", "", ".scad"},
    {"LAS", kPoints, "LASF", ".las .laz"},
    {"E57", kPoints, "ASTM-E57", ".e57"},
    {"PCD", kPoints, "# .PCD v", ".pcd"},
    {"PCD", kPoints, "VERSION .7\nFIELDS", ""},
    {"point list", kPoints, "", ".xyz .pts .ptx .asc"},
    {"URDF", kRobot, "", ".urdf .xacro"},
    {"SDFormat", kRobot, "", ".sdf .world"},
    {"MuJoCo", kRobot, "", ".mjcf"},
    {"VTK", kScientific, "# vtk DataFile", ".vtk .vtp .vtu"},
    {"Gmsh", kScientific, "$MeshFormat", ".msh"},
    {"HDF5", kScientific, "\x89HDF\r\n", ".h5 .hdf5"},
    {"3D Tiles", "extract the glTF in it, such as by the 3d-tiles-tools of Cesium", "b3dm",
     ".b3dm"},
    {"3D Tiles", "extract the glTF in it, such as by the 3d-tiles-tools of Cesium", "i3dm",
     ".i3dm"},
    {"3D Tiles (points)", kPoints, "pnts", ".pnts"},
    {"OpenFlight", kMaker, "", ".flt"},
    {"OpenSceneGraph", "convert it to OBJ or PLY: osgconv IN OUT.obj", "", ".osg .osgb .osgt .ive"},
    {"MagicaVoxel", kMaker, "VOX \x96\0\0\0"sv, ".vox"},
    {"OpenVDB", kMaker, "", ".vdb"},
    {"CityGML", "convert it to OBJ or glTF, such as by citygml-tools and cjio", "",
     ".gml .cityjson"},
    {"7-Zip", kArchive, "7z\xBC\xAF\x27\x1C", ".7z"},
    {"RAR", kArchive, "Rar!\x1A\x07", ".rar"},
    {"gzip", kArchive, "\x1F\x8B", ".gz .tgz"},
    {"xz", kArchive,
     "\xFD"
     "7zXZ",
     ".xz"},
    {"Zstandard", kArchive, "\x28\xB5\x2F\xFD", ".zst"},
    {"bzip2", kArchive, "BZh9", ".bz2"},
    {"ZIP", kArchive, "", ".zip"},
    {"Git LFS pointer", "fetch the file itself: git lfs pull",
     "version https://git-lfs.github.com/", ""},
    {"HTML", "this is a page of a web site: download the model itself", "<!DOCTYPE html", ".html"},
    {"HTML", "this is a page of a web site: download the model itself", "<html", ".htm"},
});

bool has_extension(const Format& format, std::string_view extension) {
  if (extension.empty()) return false;
  const std::size_t at = format.extensions.find(extension);
  const std::size_t end = at + extension.size();
  return at != std::string_view::npos &&
         (end == format.extensions.size() || format.extensions[end] == ' ');
}

/// STEP and IFC begin alike (ISO 10303-21); Assimp reads IFC.
bool is_step(std::string_view text) {
  return text.starts_with("ISO-10303-21") && text.find("IFC") == std::string_view::npos;
}

/// The first line of IGES has 80 columns: "S" and a number end it.
bool is_iges(std::string_view text) {
  constexpr std::size_t kColumn = 72;
  return text.size() > 80 && text.substr(kColumn, 8) == "S      1";
}

/// X3D in XML.
bool is_x3d(std::string_view text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  return text.substr(std::min(first, text.size())).starts_with('<') &&
         text.find("<X3D") != std::string_view::npos;
}

/// A ZIP archive whose first file is a layer of USD.
bool is_usdz(std::string_view bytes) {
  constexpr std::size_t kNameLength = 26;
  constexpr std::size_t kName = 30;
  if (!bytes.starts_with("PK\x03\x04") || bytes.size() < kName) return false;
  const std::size_t size = static_cast<unsigned char>(bytes[kNameLength]);
  return bytes.substr(kName, size).find(".usd") != std::string_view::npos;
}

const Format* by_name(std::string_view name) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                         [&](const Format& format) { return format.name == name; });
  return found == kFormats.end() ? nullptr : found;
}

const Format* by_mark(std::string_view bytes) {
  if (is_step(bytes)) return by_name("STEP");
  if (is_iges(bytes)) return by_name("IGES");
  if (is_usdz(bytes)) return by_name("USD");
  if (is_x3d(bytes)) return by_name("X3D");
  for (const Format& format : kFormats) {
    if (!format.mark.empty() && bytes.starts_with(format.mark)) return &format;
  }
  return nullptr;
}

/// A file with the mark of another format that GLIDAR reads has a wrong extension, and is read.
bool is_read_by_mark(std::string_view bytes) {
  constexpr std::array<std::string_view, 3> kRead = {"ply\n", "ply\r", "glTF"};
  return std::any_of(kRead.begin(), kRead.end(),
                     [&](std::string_view mark) { return bytes.starts_with(mark); });
}

}  // namespace

std::optional<Refusal> unread_format(std::string_view extension, std::string_view first_bytes) {
  const Format* format = by_mark(first_bytes);
  for (const Format& one : kFormats) {
    if (format != nullptr || is_read_by_mark(first_bytes)) break;
    if (has_extension(one, extension)) format = &one;
  }
  if (format == nullptr) return std::nullopt;
  return Refusal{std::string("GLIDAR does not read ") + format->name, format->remedy};
}

}  // namespace glidar::import
