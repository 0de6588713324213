// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// OBJ, PLY, STL and OFF: each statement is used, or named in a note, or refused with its place.
#include <glidar/io/model/model.hpp>
#include <glidar/io/model/model_parts.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>

#include <bit>
#include <ostream>

namespace glidar {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::load;
using testing::load_error;
using testing::TestFolder;

/// A file, and what it must become: an area, or an error; a note may be required.
struct Case {
  const char* name;
  const char* file;
  std::string text;
  std::size_t triangles;
  double area_m2;
  const char* says = "";  ///< a part of a note, or of the error if there are no triangles
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = vertex_m(mesh, t[0]);
    sum += (vertex_m(mesh, t[1]) - a).cross(vertex_m(mesh, t[2]) - a).norm() / 2.0;
  }
  return sum;
}

class OwnReaders : public ::testing::TestWithParam<Case> {};

TEST_P(OwnReaders, UseNoteOrRefuseEachStatement) {
  const Case& c = GetParam();
  const TestFolder temp;
  const auto file = temp.write(c.file, c.text);
  if (c.triangles == 0) {
    EXPECT_THAT(load_error(file.string()), HasSubstr(c.says));
    return;
  }
  const Model model = load(file);
  EXPECT_EQ(model.mesh.triangles.size(), c.triangles);
  EXPECT_NEAR(area(model.mesh), c.area_m2, 1e-6 * c.area_m2);
  if (*c.says == '\0') {
    EXPECT_THAT(model.notes, ::testing::IsEmpty());
  } else {
    EXPECT_THAT(model.notes, Contains(HasSubstr(c.says)));
  }
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<Case> obj_cases() {
  const char* f = "a.obj";
  const std::string one = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  return {
      {"dots", f, "v .0 -.0 0.\nv 1. +.0 0e0\nv 0 1e+0 00\nf 1 2 3\n", 1, 0.5},
      {"indented", f, "\tv 0 0 0\n  v 1 0 0\n v 0 1 0\n\t f 1 2 3\n", 1, 0.5},
      {"byte_order_mark", f, "\xEF\xBB\xBF" + one + "f 1 2 3\n", 1, 0.5},
      {"utf_16", f,
       std::string("\xFF\xFE", 2) +
           [&] {
             std::string wide;
             for (const char c : one + "f 1 2 3\n") wide += {c, '\0'};
             return wide;
           }(),
       1, 0.5},
      {"crlf", f, "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", 1, 0.5},
      {"cr", f, "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3", 1, 0.5},
      {"comments", f, "#a\nv 0 0 0 # b\nv 1 0 0#c\nv 0 1 0\nf 1 2 3 # d\n", 1, 0.5},
      {"continued", f, "v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\\\r\n 3\n", 1, 0.5},
      {"continued_names", f, one + "g a \\\nb\no c\\\n d\nusemtl \\\n\nf 1 2 3\n", 1, 0.5},
      {"backslash_in_a_comment", f, "# C:\\models\\\n" + one + "f 1 2 3\n", 1, 0.5},
      {"negative", f, one + "f -3 -2 -1\n", 1, 0.5},
      {"faces_first", f, "f 1 2 3\n" + one, 1, 0.5},
      {"weights", f, "v 0 0 0 .5\nv 1 0 0 .5\nv 0 1 0 .5\nf 1 2 3\n", 1, 0.5, "weights"},
      {"quad", f, kSquare + "f 1 2 3 4\n", 2, 1.0},
      {"concave", f, "v 0 0 0\nv 2 0 0\nv .5 .5 0\nv 0 2 0\nf 1 2 3 4\n", 2, 1.0},
      {"slashes", f, one + "f 1/ 2// 3\n", 1, 0.5},
      {"no_such_vt", f, one + "vn 0 0 1\nf 1/1/1 2/2/1 3/9/1\n", 1, 0.5,
       "line 5: a face names a 'vt'"},
      {"no_such_vn", f, one + "f 1//4 2//4 3//-1\n", 1, 0.5, "line 4: a face names a 'vn'"},
      {"smoothing", f, one + "s 1\nf 1 2 3\n", 1, 0.5, "smoothing groups (line 4)"},
      {"no_corners", f, one + "f\nf 1 2 3\n", 1, 0.5, "fewer than 3 corners"},
      {"smoothing_off", f, one + "s off\nf 1 2 3\n", 1, 0.5},
      {"lines", f, one + "l 1 2\np 3\nf 1 2 3\n", 1, 0.5, "2 points and lines"},
      {"curve", f, one + "curv 0 1 1 2 \\\n 3\nend\nf 1 2 3\n", 1, 0.5, "'curv' (line 4)"},
      {"unknown", f, one + "lod 3\nf 1 2 3\n", 1, 0.5, "'lod' (line 4)"},
      {"no_material", f, one + "usemtl x\nf 1 2 3\n", 1, 0.5, "'x'"},
      {"no_library", f, "mtllib b.mtl\n" + one + "f 1 2 3\n", 1, 0.5, "'b.mtl' is not read"},
      {"two_corners", f, one + "f 1 2\nf 1 2 3\n", 1, 0.5, "line 4: a face has fewer"},
      {"bad_v", f, "v 0 0 0\nv 1 0 1.0+e0\nv 0 1 0\nf 1 2 3\n", 0, 0.0, "line 2"},
      {"comma", f, "v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n", 0, 0.0, "line 2"},
      {"short_v", f, "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0, 0.0, "line 1"},
      {"five_numbers", f, "v 0 0 0 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0, 0.0, "line 1"},
      {"stray_backslash", f, "v 0 0 0 \\ 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0, 0.0, "line 1"},
      {"bad_vt", f, one + "vt x 0\nf 1 2 3\n", 0, 0.0, "line 4"},
      {"bad_vn", f, one + "vn 0 0\nf 1 2 3\n", 0, 0.0, "line 4"},
      {"index_0", f, one + "f 0 1 2\n", 0, 0.0, "line 4"},
      {"index_beyond", f, one + "\nf 1 2 3\nf 1 2 4\n", 0, 0.0, "line 6"},
      {"index_before", f, one + "f -4 -2 -1\n", 0, 0.0, "line 4"},
      {"index_word", f, one + "f 1 2 3x\n", 0, 0.0, "line 4"},
      {"only_points", f, one + "p 1 2 3\n", 0, 0.0, "no triangles"},
  };
}

std::string ply(const std::string& format, const std::string& before, const std::string& vertex,
                const std::string& after, const std::string& data) {
  return "ply\nformat " + format + " 1.0\n" + before + "element vertex 3\n" + vertex + after +
         "end_header\n" + data;
}

template <class... T>
std::string little(T... values) {
  std::string bytes;
  const auto add = [&bytes](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  (add(values), ...);
  return bytes;
}

std::vector<Case> ply_cases() {
  const char* f = "a.ply";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  const std::string bytes = little(1.4e-44F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F);
  const std::string strip = "element tristrips 1\nproperty list int int vertex_indices\n";
  return {
      {"ascii", f, ply("ascii", "", xyz, face, corners + "3 0 1 2\n"), 1, 0.5},
      {"comments", f,
       ply("ascii", "comment a\nobj_info b\n", xyz, face + "comment c\n", corners + "3 0 1 2\n"), 1,
       0.5},
      {"first_byte_is_a_line_end", f,
       ply("binary_little_endian", "", xyz, face, bytes + little(std::uint8_t{3}, 0, 1, 2)), 1,
       0.5},
      {"faces_first", f, ply("ascii", face, xyz, "", "3 0 1 2\n" + corners), 1, 0.5},
      {"unknown_elements", f,
       ply("ascii", "element a 2\nproperty list int float b\n", xyz, face,
           "1 5\n0\n" + corners + "3 0 1 2\n"),
       1, 0.5, "element 'a'"},
      {"other_types", f,
       ply("binary_little_endian", "", "property double x\nproperty int64 y\nproperty uint16 z\n",
           "element face 1\nproperty list uint64 int64 vertex_index\n",
           little(0.0, std::int64_t{0}, std::uint16_t{0}, 1.0, std::int64_t{0}, std::uint16_t{0},
                  0.0, std::int64_t{1}, std::uint16_t{0}, std::uint64_t{3}, std::int64_t{0},
                  std::int64_t{1}, std::int64_t{2})),
       1, 0.5},
      {"strips", f, ply("ascii", "", xyz, strip, corners + "7 0 1 2 -1 2 1 0\n"), 2, 1.0},
      {"unused_properties", f,
       ply("ascii", "", xyz + "property float quality\n", face,
           "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"),
       1, 0.5, "quality"},
      {"edges", f,
       ply("ascii", "", xyz, face + "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
           corners + "3 0 1 2\n0 1\n"),
       1, 0.5, "1 points and lines"},
      {"bytes_after", f,
       ply("binary_little_endian", "", xyz, face,
           bytes + little(std::uint8_t{3}, 0, 1, 2, std::uint8_t{0})),
       1, 0.5, "1 bytes"},
      {"points", f, ply("ascii", "", xyz, "", corners), 0, 0.0, "only 3 points"},
      {"index_beyond", f, ply("ascii", "", xyz, face, corners + "3 0 1 3\n"), 0, 0.0, "vertex 3"},
      {"negative_index", f, ply("ascii", "", xyz, face, corners + "3 0 1 -1\n"), 0, 0.0, "line 13"},
      {"too_many_numbers_of_vertices", f,
       ply("ascii", "", xyz, face, "0 0 0 9\n1 0 0\n0 1 0\n3 0 1 2\n"), 0, 0.0, "line 10"},
      {"cut_off", f, ply("binary_little_endian", "", xyz, face, bytes.substr(0, 30)), 0, 0.0,
       "ends too early"},
      {"huge_count", f,
       "ply\nformat ascii 1.0\nelement vertex 99999999999\n" + xyz + "end_header\n0 0 0\n", 0, 0.0,
       "ends too early"},
      {"unknown_statement", f, "ply\nformat ascii 1.0\nelem vertex 3\nend_header\n", 0, 0.0,
       "line 3"},
      {"unknown_type", f, ply("ascii", "", "property real x\n", face, ""), 0, 0.0, "line 4"},
  };
}

std::string facet(const std::string& normal) {
  return "facet " + normal +
         "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
}

std::string binary_facet() {
  return little(0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, std::uint16_t{0});
}

std::vector<Case> stl_cases() {
  const char* f = "a.stl";
  const std::string header = "solid made by a program" + std::string(57, ' ');
  const std::string one = little(1U) + binary_facet();
  return {
      {"ascii", f, "solid a\n" + facet("normal 0 0 1") + "endsolid a\n", 1, 0.5},
      {"capitals", f,
       "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
       "0\nENDLOOP\nENDFACET\nENDSOLID\n",
       1, 0.5},
      {"one_line", f,
       "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop "
       "endfacet endsolid a",
       1, 0.5},
      {"no_normal", f, "solid\n" + facet("") + "endsolid\n", 1, 0.5},
      {"nan_normal", f, "solid\n" + facet("normal nan -nan(ind) nan") + "endsolid\n", 1, 0.5},
      {"empty_solid", f,
       "solid a\n" + facet("") + "endsolid a\nsolid b\nendsolid b\nsolid c\n" + facet("") +
           "endsolid c\n",
       2, 1.0, "solid 'b' is empty"},
      {"no_end", f, "solid a\n" + facet(""), 1, 0.5, "endsolid"},
      {"binary", f, std::string(80, '\0') + one, 1, 0.5},
      {"solid_in_header", f, header + one, 1, 0.5},
      {"tail", f, header + one + "x", 1, 0.5, "1 bytes"},
      {"attributes", f,
       std::string(80, ' ') + one.substr(0, one.size() - 2) + "\1" + std::string(1, '\0'), 1, 0.5,
       "attributes"},
      {"bad_vertex", f, "solid a\nfacet\nouter loop\nvertex 0 0 x\n", 0, 0.0, "line 4"},
      {"cut_off", f, "solid a\nfacet\nouter loop\nvertex 0 0 0\n", 0, 0.0, "ends too early"},
      {"other_words", f, "solid a\n" + facet("") + "triangle\nendsolid\n", 0, 0.0, "line 9"},
      {"binary_cut_off", f, std::string(80, ' ') + little(3U) + binary_facet(), 0, 0.0, "byte 80"},
      {"nothing", f, "abc", 0, 0.0, "84 bytes"},
  };
}

std::vector<Case> off_cases() {
  const char* f = "a.off";
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  return {
      {"plain", f, "OFF\n4 1 4\n" + square + "4 0 1 2 3\n", 2, 1.0},
      {"comments", f,
       "# a\nOFF # b\n\n  # c\n4 1 0\n0 0 0\n  # d\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 # e\n", 2, 1.0},
      {"counts_in_the_first_line", f, "OFF 4 1 0\n" + square + "4 0 1 2 3\n", 2, 1.0},
      {"no_word", f, "4 1 0\n" + square + "4 0 1 2 3\n", 2, 1.0},
      {"small_letters", f, "coff\n3 1 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n", 1, 0.5},
      {"numbers_on_several_lines", f, "OFF\n4\n1\n4\n0 0\n0\n1\n0 0\n1 1 0\n0 1 0\n4 0 1\n2 3\n", 2,
       1.0},
      {"no_normals", f, "NOFF\n4 1 0\n" + square + "4 0 1 2 3\n", 0, 0.0, "line 3"},
      {"no_edges", f, "OFF\n4 1\n" + square + "4 0 1 2 3\n", 2, 1.0},
      {"normals", f, "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n", 1, 0.5},
      {"list_colours", f, "OFF\n4 1 0\n" + square + "4 0 1 2 3 7\n", 2, 1.0, "by their number"},
      {"lines", f, "OFF\n4 2 0\n" + square + "4 0 1 2 3\n2 0 1\n", 2, 1.0, "1 points and lines"},
      {"four", f, "4OFF\n1 0 0\n0 0 0 1\n", 0, 0.0, "line 1"},
      {"any_dimension", f, "nOFF\n3\n1 0 0\n0 0 0\n", 0, 0.0, "line 1"},
      {"colours_that_are_not_stated", f,
       "OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n", 1, 0.5,
       "the first line does not state"},
      {"more_numbers", f, "OFF\n4 1 0\n0 0 0 1\n" + square, 0, 0.0, "line 3"},
      {"index_beyond", f, "OFF\n4 1 0\n" + square + "4 0 1 2 4\n", 0, 0.0, "line 7"},
      {"missing_corner", f, "OFF\n4 1 0\n" + square + "4 0 1 2\n", 0, 0.0, "line 7"},
      {"more_faces", f, "OFF\n4 1 0\n" + square + "4 0 1 2 3\n4 0 1 2 3\n", 0, 0.0, "line 8"},
      {"cut_off", f, "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n", 0, 0.0, "ends before vertex 3"},
      {"huge_count", f, "OFF\n99999999999 1 0\n0 0 0\n", 0, 0.0, "ends too early"},
  };
}

const auto kName = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Obj, OwnReaders, ::testing::ValuesIn(obj_cases()), kName);
INSTANTIATE_TEST_SUITE_P(Ply, OwnReaders, ::testing::ValuesIn(ply_cases()), kName);
INSTANTIATE_TEST_SUITE_P(Stl, OwnReaders, ::testing::ValuesIn(stl_cases()), kName);
INSTANTIATE_TEST_SUITE_P(Off, OwnReaders, ::testing::ValuesIn(off_cases()), kName);

TEST(ModelPrecision, APlateFarAwayKeepsItsSize) {
  const TestFolder temp;
  const std::vector<std::pair<const char*, std::string>> files = {
      {"a.obj",
       "v 500000.1 5400000.1 100\nv 500000.3 5400000.1 100\nv 500000.1 5400000.3 100\nf 1 2 3\n"},
      {"a.off",
       "OFF\n3 1 0\n500000.1 5400000.1 100\n500000.3 5400000.1 100\n500000.1 5400000.3 100\n3 0 1 "
       "2\n"},
      {"a.stl",
       "solid\nfacet\nouter loop\nvertex 500000.1 5400000.1 100\nvertex 500000.3 5400000.1 100\n"
       "vertex 500000.1 5400000.3 100\nendloop\nendfacet\nendsolid\n"}};
  for (const auto& [name, text] : files) {
    const Model model = load(temp.write(name, text));
    const Eigen::Vector3d sides = bounds(model.mesh).sizes();
    EXPECT_NEAR(sides.x(), 0.2, 0.2e-7) << name;
    EXPECT_NEAR(sides.y(), 0.2, 0.2e-7) << name;
    EXPECT_THAT(model.notes, ::testing::IsEmpty()) << name;
  }
}

TEST(ModelPrecision, GroupsFarFromEachOtherHaveOriginsOfTheirOwn) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.obj",
                      "g near\nv 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nf 1 2 3\n"
                      "g far\nv 0 5400000.1 0\nv 0.2 5400000.1 0\nv 0 5400000.3 0\nf 4 5 6\n"));
  ASSERT_EQ(model.mesh.triangles.size(), 2U);
  const Triangle& far = model.mesh.triangles[1];
  EXPECT_NEAR(vertex_m(model.mesh, far[2]).y() - vertex_m(model.mesh, far[0]).y(), 0.2, 0.2e-7);
}

TEST(ModelParts, GroupsObjectsAndSolidsAreParts) {
  const TestFolder temp;
  const auto names = [](const Model& model) {
    std::vector<std::string> all;
    for (const ModelPart& part : model.parts) all.push_back(part.name);
    return all;
  };
  EXPECT_THAT(names(load(temp.write(
                  "a.obj", kSquare + "o a b\nf 1 2 3\ng left # x\nf 1 3 4\no c\nf 1 2 3\n"))),
              ElementsAre("a b", "left", "c"));
  EXPECT_THAT(names(load(temp.write("a.stl", "solid one\n" + facet("") + "endsolid one\nsolid\n" +
                                                 facet("") + "endsolid\n"))),
              ElementsAre("one", ""));
}

TEST(ModelParts, OfFilesAreAddressedByTheirPaths) {
  const TestFolder temp;
  const auto names = [](const Model& model) { return part_names(model.nodes); };
  EXPECT_THAT(
      names(load(temp.write("a.obj", kSquare + "usemtl red\no car\nf 1 2 3\ng door\nf 1 3 4\n"
                                               "usemtl blue\nf 1 2 3\no car/roof\nf 1 2 3\n"))),
      ElementsAre("", "car", "car/door", "car/roof"));
  EXPECT_THAT(names(load(temp.write("b.obj", kSquare + "g left\nf 1 2 3\nf 1 3 4\n"))),
              ElementsAre("", "left"));
  const std::string solid = "solid one\n" + facet("") + "endsolid one\n";
  EXPECT_THAT(
      names(load(temp.write("a.stl", solid + solid + "solid\n" + facet("") + "endsolid\n"))),
      ElementsAre("", "one", "one_2"));
  EXPECT_THAT(names(load(temp.write("b.stl", "solid\n" + facet("") + "endsolid\n"))),
              ElementsAre(""));
}

TEST(ModelParts, AllMaterialsOfAGroupAreOnePart) {
  const TestFolder temp;
  const Model model = load(temp.write(
      "a.obj", kSquare + "g a\nusemtl x\nf 1 2 3\ng b\nf 1 3 4\ng a\nusemtl y\nf 1 2 4\n"));
  const std::vector<PartSummary> parts = list_parts(model);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].triangles, 2U);
  EXPECT_THAT(parts[0].materials, ElementsAre("x", "y"));
  EXPECT_EQ(parts[1].triangles, 1U);
}

TEST(ModelReflectance, SurfacesWithoutAMaterialAreWhiteInEveryFormat) {
  const TestFolder temp;
  const std::vector<std::pair<const char*, std::string>> files = {
      {"a.obj", kSquare + "f 1 2 3\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.stl", "solid\n" + facet("") + "endsolid\n"},
      {"a.gltf", testing::gltf(R"([{"mesh":0}])")}};
  for (const auto& [name, text] : files) {
    EXPECT_EQ(load(temp.write(name, text)).materials.at(0).diffuse, Eigen::Vector3f::Ones())
        << name;
  }
  temp.write("a.mtl", "newmtl paint\nmap_Kd paint.ppm\n");
  temp.write("paint.ppm", testing::ppm(1, 1, "abc"));
  EXPECT_EQ(load(temp.write("b.obj", testing::quad_obj("a.mtl"))).materials.at(0).diffuse,
            Eigen::Vector3f::Ones());
}

TEST(ModelColours, OfVerticesAndFacesAreRead) {
  const TestFolder temp;
  const Eigen::Vector3f red(1, 0, 0);
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::vector<std::pair<const char*, std::string>> files = {
      {"a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"},
      {"b.obj", "v 0 0 0 255 0 0\nv 1 0 0 255 0 0\nv 0 1 0 255 0 0\nf 1 2 3\n"},
      {"c.obj", "v 0 0 0 1 0 0 1\nv 1 0 0 1 0 0 1\nv 0 1 0 1 0 0 1\nf 1 2 3\n"},
      {"a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3 0 1 2\n"},
      {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1.0 0.0 0.0\n"},
      {"a.ply",
       header + rgb + face + "end_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n"},
      {"b.ply", header + face + rgb + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n"},
      {"a.stl", std::string(80, ' ') + little(1U) + binary_facet().substr(0, 48) +
                    little(std::uint16_t{0xFC00})},
      {"b.stl", "COLOR=" + std::string("\xFF\0\0\xFF", 4) + std::string(70, ' ') + little(1U) +
                    binary_facet().substr(0, 48) + little(std::uint16_t{0x8000})},
      {"c.stl", "COLOR=" + std::string("\0\0\0\xFF", 4) + std::string(70, ' ') + little(1U) +
                    binary_facet().substr(0, 48) + little(std::uint16_t{0x001F})}};
  for (const auto& [name, text] : files) {
    const Model model = load(temp.write(name, text));
    ASSERT_FALSE(model.mesh.colours.empty()) << name;
    for (const Eigen::Vector3f& colour : model.mesh.colours) EXPECT_EQ(colour, red) << name;
  }
}

TEST(ModelUvs, OfPlyFacesAreReadWithTheirTextures) {
  const TestFolder temp;
  temp.write("a.ppm", testing::ppm(1, 1, "abc"));
  temp.write("b.ppm", testing::ppm(1, 1, "def"));
  const Model model = load(temp.write("a.ply", R"(ply
format ascii 1.0
comment TextureFile a.ppm
comment TextureFile b.ppm
element vertex 3
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
property list uchar float texcoord
property int texnumber
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2 6 0 0 1 0 0 1 1
3 0 2 1 6 0 0 1 0 0 1 0
)"));
  ASSERT_EQ(model.mesh.triangles.size(), 2U);
  const auto texture_of = [&](std::uint32_t triangle) {
    const Material& m = model.materials.at(material_slot(model.mesh, triangle));
    return model.textures.at(static_cast<std::size_t>(m.diffuse_texture.texture)).name;
  };
  EXPECT_EQ(texture_of(0), "b.ppm");
  EXPECT_EQ(texture_of(1), "a.ppm");
  EXPECT_EQ(model.mesh.uvs[0].at(model.mesh.triangles[0][1]), Eigen::Vector2f(1, 0));
}

TEST(ModelMtl, OptionsAndOddLines) {
  const TestFolder temp;
  temp.write("my paint.ppm", testing::ppm(1, 1, "abc"));
  temp.write("a b.mtl",
             "# C:\\work\\\nnewmtl paint # gold\nKd 0.5\nKs 1 \\\n x 1\naniso 0.7\nNi 1.5\n"
             "map_Ks -s 1e300 my paint.ppm\n"
             "map_Kd -mm 0 1 -s 2 2 -clamp on my paint.ppm # the first\n");
  temp.write("c.mtl", "newmtl other\nKd 0 1 0\n");
  const Model model =
      load(temp.write("a.obj", "mtllib a b.mtl c.mtl\n" + kSquare +
                                   "usemtl paint\nf 1 2 3\nusemtl other\nf 1 3 4\n"));
  ASSERT_EQ(model.materials.size(), 2U);
  EXPECT_EQ(model.materials[0].diffuse, Eigen::Vector3f::Constant(0.5F));
  EXPECT_EQ(model.materials[0].diffuse_texture.wrap_u, Wrap::clamp);
  EXPECT_EQ(model.textures.at(0).name, "my paint.ppm");
  EXPECT_EQ(model.missing_textures.size(), 1U);  // of Ks, whose name begins with a number
  EXPECT_EQ(model.materials[1].diffuse, Eigen::Vector3f(0, 1, 0));
  EXPECT_THAT(model.notes, Contains(HasSubstr("a b.mtl, line 4")));
  EXPECT_THAT(model.notes, Contains(HasSubstr("Ni, aniso")));
}

TEST(ModelParts, EveryObjectIdOfAPlyFileIsAPart) {
  const TestFolder temp;
  const Model model = load(
      temp.write("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                 "property uint object_id\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1234567\n"
                 "3 0 2 1 1234568\n"));
  EXPECT_THAT(part_names(model.nodes),
              ::testing::ElementsAre("", "object_id 1234567", "object_id 1234568"));
}

TEST(ModelParts, NodesThatAreNestedTooDeeplyAreNoted) {
  const TestFolder temp;
  std::string nodes;
  constexpr int kDepth = 70;
  for (int i = 0; i < kDepth; ++i) {
    nodes += i + 1 < kDepth ? "{\"name\":\"n\",\"children\":[" + std::to_string(i + 1) + "]},"
                            : "{\"name\":\"n\",\"mesh\":0}";
  }
  const Model model = load(temp.write(
      "a.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" +
                    nodes +
                    R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                    R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
                    R"("min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
                    R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                    R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"));
  EXPECT_EQ(model.nodes.size(), 1U + kMaxPartDepth);
  EXPECT_THAT(model.notes, Contains(HasSubstr("belong to the part above them")));
}

TEST(ModelNotes, RepeatedOnesAreCountedAndTheirNumberIsLimited) {
  const TestFolder temp;
  std::string lines;
  for (int i = 0; i < 100'000; ++i) lines += "f 1 2\n";
  const Model model = load(temp.write("a.obj", kSquare + "f 1 2 3 4\n" + lines));
  EXPECT_THAT(
      model.notes,
      Contains("line 6: a face has fewer than 3 corners: left out; 99999 more such places"));
  EXPECT_LT(model.notes.size(), 4U);
  std::string header = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 100'000; ++i) header += "x" + std::to_string(i) + "\n";
  const Model other =
      load(temp.write("a.ply", header + "element vertex 3\nproperty float x\nproperty float "
                                        "y\nproperty float z\nelement face 1\nproperty list "
                                        "uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n"
                                        "0 1 0\n3 0 1 2\n"));
  ASSERT_EQ(other.notes.size(), 11U);
  EXPECT_THAT(other.notes.front(), HasSubstr("line 3: 'x0'"));
  EXPECT_EQ(other.notes.back(), "and 99990 more notes");
}

TEST(ModelContents, WhatIsMissingIsNamed) {
  const TestFolder temp;
  const Model model =
      load(temp.write("a.obj", kSquare + "v 7 7 7\nv nan 0 0\nf 1 2 3 4\nf 1 2 6\n"));
  EXPECT_EQ(content_difference(model.stated, model.loaded),
            "vertices 6 stated, 5 loaded; faces 2 stated, 1 loaded; size 7 x 7 x 7 stated, 1 x 1 x "
            "0 loaded");
  EXPECT_EQ(content_difference(model.stated, model.stated), "");
}

}  // namespace
}  // namespace glidar
