// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Units and up axes that model files declare. Expected numbers are those written in the files.
#include <glidar/io/model/model.hpp>
#include <glidar/io/model/model_report.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model_test_support.hpp"

namespace glidar {
namespace {

using testing::as_declared;
using ::testing::Contains;
using testing::data_folder;
using testing::gltf;
using ::testing::HasSubstr;
using testing::load;
using testing::TestFolder;

Eigen::Vector3d corner(const Model& model, std::size_t i) {
  return vertex_m(model.mesh, model.mesh.triangles.at(0)[i]);
}

/// A triangle with the corners (1, 2, 3), (4, 2, 3) and (1, 7, 9).
std::string collada(const std::string& asset) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
version="1.4.1"><asset>)" +
         asset + R"(</asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">1 2 3 4 2 3 1 7 9</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string amf(const std::string& attribute) {
  return "<?xml version=\"1.0\"?>\n<amf" + attribute +
         "><object id=\"1\"><mesh><vertices>"
         "<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>"
         "<vertex><coordinates><x>2</x><y>0</y><z>0</z></coordinates></vertex>"
         "<vertex><coordinates><x>0</x><y>4</y><z>0</z></coordinates></vertex></vertices>"
         "<volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object>"
         "</amf>\n";
}

/// A 3MF package of parts by name, written by libzip.
std::filesystem::path package(const std::filesystem::path& path,
                              const std::map<std::string, std::string>& parts) {
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  for (const auto& [name, text] : parts) {
    zip_source_t* source = zip_source_buffer(archive, text.data(), text.size(), 0);
    zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE);
  }
  EXPECT_EQ(zip_close(archive), 0) << path;
  return path;
}

/// A triangle of 2 x 4 units; `start`: what is in the file before the content of its model.
std::filesystem::path model_3mf(const TestFolder& folder, const std::string& start,
                                const std::string& part = "3D/3dmodel.model") {
  const std::string mesh =
      "<resources><object id=\"1\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>"
      "<vertex x=\"2\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"4\" z=\"0\"/></vertices><triangles>"
      "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources>"
      "<build><item objectid=\"1\"/></build></model>";
  return package(
      folder / "a.3mf",
      {{part, start + mesh},
       {"_rels/.rels",
        "<?xml version=\"1.0\"?><Relationships "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
        "<Relationship Id=\"r9\" Target=\"/Metadata/thumbnail.png\" "
        "Type=\"http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail\"/>"
        "<Relationship Target=\"/" +
            part +
            "\" Id=\"rel0\" "
            "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" "
            "/></Relationships>"},
       {"[Content_Types].xml",
        "<?xml version=\"1.0\"?><Types "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"/>"}});
}

constexpr const char* k3mf = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";

TEST(DeclaredFrame, TheUnitOf3mfIsFoundInAnyXmlNotation) {
  const std::string space = std::string(k3mf) + " ";
  const std::string big_comment = "<!-- " + std::string(70000, 'x') + " -->";
  const std::vector<std::string> starts = {
      "<model unit=\"inch\" " + space + ">",
      "<?xml version=\"1.0\"?>\n<model\n\t" + space + "\n\tunit=\"inch\"\n>",
      "<model " + space + " unit = 'inch' xml:lang=\"en-US\">",
      "<model " + space + "xml:lang=\"a &gt; > b\" unit=\"inch\">",
      "<!-- <model unit=\"meter\"> --><model " + space + "unit=\"inch\">",
      "<?xml version=\"1.0\"?>" + big_comment + "<model " + space + "unit=\"inch\">" + big_comment,
      "<?xml version=\"1.0\"?><?note <model unit=\"meter\"> ?><model " + space + "unit=\"inch\">",
      "<model " + space + "data-unit=\"meter\" unit=\"inch\">",
  };
  const TestFolder temp;
  for (const std::string& start : starts) {
    const Model model = load(model_3mf(temp, start), as_declared());
    EXPECT_EQ(model.declared.metres_per_unit, 0.0254) << start.substr(0, 200);
    EXPECT_NEAR(bounds(model.mesh).sizes().y(), 0.1016, 1e-8) << start.substr(0, 200);
  }
  EXPECT_EQ(load(model_3mf(temp, "<model " + space + ">"), as_declared()).declared.metres_per_unit,
            0.001);
}

TEST(DeclaredFrame, ThePartNamedByThe3mfRelationshipsIsRead) {
  const TestFolder temp;
  const auto file =
      model_3mf(temp, "<model unit=\"foot\" " + std::string(k3mf) + ">", "3D/part.model");
  EXPECT_EQ(load(file, as_declared()).declared.metres_per_unit, 0.3048);
}

TEST(DeclaredFrame, UnitsOfAmfAreFoundBehindComments) {
  const TestFolder temp;
  const std::string text = amf("\n\tversion = '1.1'\n\tunit = 'inch'\n");
  std::string commented = text;
  commented.insert(text.find("<amf"),
                   "<!-- <amf unit=\"meter\"> " + std::string(70000, ' ') + "-->");
  for (const std::string& one : {text, commented}) {
    EXPECT_EQ(load(temp.write("a.amf", one), as_declared()).declared.metres_per_unit, 0.0254);
  }
}

TEST(DeclaredFrame, NumbersAndNamesOfColladaAreTrimmed) {
  const TestFolder temp;
  const Model model =
      load(temp.write(
               "a.dae",
               collada("<unit\n name='inch'\n meter = \" 0.0254 \"/><up_axis>\n Z_UP </up_axis>")),
           as_declared());
  EXPECT_EQ(model.declared.metres_per_unit, 0.0254);
  EXPECT_EQ(model.declared.up, Axis::z);
  EXPECT_LT((corner(model, 0) - 0.0254 * Eigen::Vector3d(1, 2, 3)).norm(), 1e-8);
  const Model commented = load(
      temp.write("a.dae", collada("<!-- <unit meter=\"7\"/><up_axis>X_UP</up_axis> --><contributor>"
                                  "<unit meter=\"8\"/></contributor><unit meter=\"0.5\"/>"
                                  "<up_axis><!-- X_UP -->Z_UP</up_axis>")),
      as_declared());
  EXPECT_EQ(commented.declared.metres_per_unit, 0.5);
  EXPECT_EQ(commented.declared.up, Axis::z);
}

TEST(DeclaredFrame, AnInvalidColladaUnitIsReportedAndTheUpAxisIsApplied) {
  const TestFolder temp;
  for (const char* meter : {"1e50", "-1", "nan", "inf", "one", ""}) {
    const Model model = load(temp.write("a.dae", collada("<unit meter=\"" + std::string(meter) +
                                                         "\"/><up_axis>X_UP</up_axis>")),
                             as_declared());
    EXPECT_FALSE(model.applied.metres_per_unit.has_value()) << meter;
    EXPECT_THAT(model.notes, Contains("the file declares an invalid unit of '" +
                                      std::string(meter) + "' m: 1 m is assumed"));
    EXPECT_EQ(model.applied.up, Axis::x) << meter;
    EXPECT_EQ(corner(model, 0), Eigen::Vector3d(2.0, 3.0, 1.0)) << meter;
  }
}

TEST(DeclaredFrame, AnUnknownUpAxisOfColladaIsNoted) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.dae", collada("<unit meter=\"2\"/><up_axis>UP</up_axis>")), as_declared());
  EXPECT_EQ(model.applied.metres_per_unit, 2.0);
  EXPECT_FALSE(model.applied.up.has_value());
  EXPECT_THAT(model.notes, Contains(HasSubstr("unknown up axis 'UP': its axes are kept")));
}

TEST(DeclaredFrame, ColladaInAnArchiveIsFoundByItsManifest) {
  const TestFolder temp;
  const std::string root = collada("<unit meter=\"0.25\"/><up_axis>Z_UP</up_axis>");
  const std::string other = collada("<unit meter=\"4\"/>");
  const std::string manifest =
      "<?xml version=\"1.0\"?><!-- <dae_root>a.dae</dae_root> -->\n"
      "<dae_root>./b%20c.dae</dae_root>";
  const Model named = load(
      package(temp / "a.zae", {{"a.dae", other}, {"b c.dae", root}, {"manifest.xml", manifest}}),
      as_declared());
  EXPECT_EQ(named.declared.metres_per_unit, 0.25);
  EXPECT_EQ(named.declared.up, Axis::z);
  const Model only = load(package(temp / "b.zae", {{"b c.dae", root}}), as_declared());
  EXPECT_EQ(only.declared.metres_per_unit, 0.25);
}

TEST(DeclaredFrame, UnitAndUpAxisOfColladaAreApplied) {
  struct Case {
    const char* up;
    Axis axis;
    Eigen::Vector3d first;  ///< (1, 2, 3) in metres with this axis as z
  };
  const std::vector<Case> cases = {{"X_UP", Axis::x, {0.02, 0.03, 0.01}},
                                   {"Y_UP", Axis::y, {0.01, -0.03, 0.02}},
                                   {"Z_UP", Axis::z, {0.01, 0.02, 0.03}}};
  const TestFolder temp;
  for (const Case& one : cases) {
    const Model model =
        load(temp.write("a.dae", collada("<unit name=\"centimeter\" meter=\"0.01\"/><up_axis>" +
                                         std::string(one.up) + "</up_axis>")),
             as_declared());
    EXPECT_EQ(model.declared.metres_per_unit, 0.01) << one.up;
    EXPECT_EQ(model.declared.up, one.axis) << one.up;
    EXPECT_LT((corner(model, 0) - one.first).norm(), 1e-8) << one.up;
  }
}

TEST(DeclaredFrame, ColladaWithoutBothIsInMetresAndYUp) {
  const TestFolder temp;
  const Model model = load(temp.write("a.dae", collada("")), as_declared());
  EXPECT_EQ(model.applied.metres_per_unit, 1.0);
  EXPECT_EQ(model.applied.up, Axis::y);
  EXPECT_EQ(corner(model, 0), Eigen::Vector3d(1.0, -3.0, 2.0));
}

TEST(DeclaredFrame, OptionsOverrideTheFile) {
  const TestFolder temp;
  const auto file = temp.write("a.dae", collada("<unit meter=\"0.0254\"/><up_axis>Y_UP</up_axis>"));
  ModelOptions options = as_declared();
  options.metres_per_unit = 1.0;
  options.up = Axis::z;
  EXPECT_EQ(corner(load(file, options), 0), Eigen::Vector3d(1.0, 2.0, 3.0));
  options.metres_per_unit = 0.5;  // and not 0.5 x 0.0254
  EXPECT_EQ(corner(load(file, options), 0), Eigen::Vector3d(0.5, 1.0, 1.5));
}

TEST(DeclaredFrame, AUnitOfZeroIsNotedAndNotApplied) {
  const TestFolder temp;
  const Model model = load(temp.write("a.dae", collada("<unit meter=\"0\"/>")), as_declared());
  EXPECT_FALSE(model.applied.metres_per_unit.has_value());
  EXPECT_THAT(model.notes, Contains(HasSubstr("1 m is assumed")));
  EXPECT_EQ(bounds(model.mesh).sizes().maxCoeff(), 6.0);
}

TEST(DeclaredFrame, GltfIsInMetresAndYUpByItsStandard) {
  const TestFolder temp;
  const auto file = temp.write("a.gltf", gltf(R"([{"mesh":0,"translation":[1,2,3]}])"));
  EXPECT_EQ(corner(load(file, as_declared()), 0), Eigen::Vector3d(1.0, -3.0, 2.0));
  ModelOptions options = as_declared();
  options.up = Axis::z;
  EXPECT_EQ(corner(load(file, options), 0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(DeclaredFrame, UnitsOfAmfAreApplied) {
  const TestFolder temp;
  const auto size = [&](const std::string& attribute) -> Eigen::Vector3d {
    return bounds(load(temp.write("a.amf", amf(attribute)), as_declared()).mesh).sizes();
  };
  EXPECT_LT((size(" unit=\"inch\"") - Eigen::Vector3d(0.0508, 0.1016, 0.0)).norm(), 1e-8);
  EXPECT_LT((size("") - Eigen::Vector3d(0.002, 0.004, 0.0)).norm(), 1e-9);
  EXPECT_THAT(testing::load_error(temp.write("a.amf", amf(" unit='ell'")), as_declared()),
              HasSubstr("\"ell\" in node <unit> has incorrect value"));
}

TEST(DeclaredFrame, FormatsWithoutDeclarationsAreUnchanged) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.obj", "v 1 2 3\nv 4 2 3\nv 1 7 9\nf 1 2 3\n"), as_declared());
  EXPECT_FALSE(model.applied.metres_per_unit.has_value());
  EXPECT_FALSE(model.applied.up.has_value());
  EXPECT_EQ(corner(model, 0), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(DeclaredFrame, ReportsStateTheSourceOfUnitAndUpAxis) {
  const TestFolder temp;
  const auto file = temp.write("a.dae", collada("<unit meter=\"0.01\"/><up_axis>Y_UP</up_axis>"));
  const ModelReport declared = inspect(load(file, as_declared()));
  EXPECT_EQ(declared.unit_guess, "0.01 m, declared by the file or its format");
  EXPECT_EQ(declared.up, "y of the file is z here, declared by the file or its format");
  ModelOptions options = as_declared();
  options.metres_per_unit = 1.0;
  EXPECT_EQ(inspect(load(file, options)).unit_guess, "1 m, as specified; the file declares 0.01 m");
  const auto obj = temp.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(inspect(load(obj, as_declared())).unit_guess,
            "1 m assumed, the file declares none; plausible as metres: 1 m across");
}

TEST(DeclaredFrame, AreCorrectForRealFiles) {
  GLIDAR_NEEDS_DATA();
  struct Case {
    const char* path;
    double metres_per_unit;
    Axis up;
  };
  // as written in the files, read with a text editor
  for (const Case& one :
       std::vector<Case>{{"textured/assimp/Collada/duck.dae", 0.01, Axis::y},
                         {"textured/assimp/Collada/cube_with_2UVs.DAE", 0.0254, Axis::z},
                         {"textured/assimp/Collada/duck.zae", 0.01, Axis::y},
                         {"textured/assimp/Collada/cube_UTF8BOM.dae", 0.01, Axis::y},
                         {"textured/dae/CesiumMilkTruck/CesiumMilkTruck.dae", 1.0, Axis::y},
                         {"scenes/turtlebot3_world/meshes/wall.dae", 0.0254, Axis::y},
                         {"textured/assimp/FBX/cubes_with_names.fbx", 0.01, Axis::y},
                         {"textured/assimp/FBX/cubes_with_mirroring_and_pivot.fbx", 1.0, Axis::y},
                         {"textured/assimp/FBX/embedded_ascii/box.FBX", 1.0, Axis::z},
                         {"textured/assimp/3MF/box.3mf", 0.001, Axis::z},
                         {"textured/gltf/Box/glTF/Box.gltf", 1.0, Axis::y},
                         {"textured/assimp/AMF/test_with_mat.amf", 0.0254, Axis::z}}) {
    const Model model = load(data_folder() / one.path, as_declared());
    EXPECT_EQ(model.declared.metres_per_unit, one.metres_per_unit) << one.path;
    EXPECT_EQ(model.declared.up, one.up) << one.path;
    // the numbers of the file alone, times the unit, in the other axes
    const Eigen::Vector3d size = bounds(load(data_folder() / one.path).mesh).sizes();
    Eigen::Vector3d expected = one.metres_per_unit * size;
    if (one.up == Axis::y) std::swap(expected.y(), expected.z());
    const Eigen::Vector3d found = bounds(model.mesh).sizes();
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << one.path;
  }
}

TEST(DeclaredFrame, SizesOfRealFilesAreThoseThatTheyDeclare) {
  GLIDAR_NEEDS_DATA();
  const auto size = [](const char* path) -> Eigen::Vector3d {
    return bounds(load(data_folder() / path, as_declared()).mesh).sizes();
  };
  // vertices of 10 x 20 x 30 mm
  EXPECT_LT((size("textured/assimp/3MF/box.3mf") - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-8);
  // a pyramid of 1 inch
  EXPECT_LT(
      (size("textured/assimp/AMF/test_with_mat.amf") - Eigen::Vector3d::Constant(0.0254)).norm(),
      1e-8);
}

}  // namespace
}  // namespace glidar
