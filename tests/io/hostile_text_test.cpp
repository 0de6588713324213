// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Small files that would take the program's memory, stack or time: every reader has a budget.
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/config/scene_file.hpp>
#include <glidar/io/config/sensor_file.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/paths.hpp>
#include <glidar/io/formats/sidecar.hpp>
#include <tests/support/error_text.hpp>
#include <tests/support/test_folder.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glidar {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::size_t kDeep = 100'000;

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(HostileJson, DepthAndNumberOfValuesHaveLimits) {
  using Json = nlohmann::json;
  const auto parse = [](const std::string& text) {
    return error_text([&] { parse_json<Json>("f", text); });
  };
  EXPECT_EQ(parse(nested(64)), "no error");
  EXPECT_EQ(parse(nested(kDeep)), "f: JSON nested too deeply; allowed: at most 64 levels");
  EXPECT_THAT(parse(repeated("{\"a\":", kDeep)), HasSubstr("nested too deeply"));
  const auto many = [] { parse_json<Json>("f", "[1,2,3,4]", {.max_depth = 4, .max_values = 4}); };
  EXPECT_EQ(error_text(many), "f: JSON of too many values; allowed: at most 4");
  EXPECT_THAT(shown_json(Json(std::string(10'000, 'x'))), SizeIs(63));
}

TEST(HostileJson, NestedSidecarsAreRejected) {
  const testing::TestFolder folder;
  folder.write("a.glidar.json", R"({"glidar":"x","command":null,"frame":)" + nested(kDeep) + "}");
  EXPECT_THAT(error_text([&] { read_sidecar(folder / "a.pcd"); }), HasSubstr("nested too deeply"));
  folder.write(
      "b.glidar.json",
      R"({"glidar":"x","command":null,"instances":[],"files":[{"file":"b.pcd","rows":1,"cols":1}],)"
      R"("frame":")" +
          std::string(100'000, 'x') + "\"}");
  const std::string error = error_text([&] { read_sidecar(folder / "b.pcd"); });
  EXPECT_THAT(error, HasSubstr("is not a count"));
  EXPECT_LT(error.size(), 600U);
}

TEST(HostileJson, NestedSensorMetadataIsRejected) {
  const testing::TestFolder folder;
  folder.write("ou.json", R"({"beam_altitude_angles":)" + nested(kDeep) + "}");
  const auto path = folder.write("s.yaml", "optics: {type: ouster, file: ou.json}\n");
  EXPECT_THAT(error_text([&] { load_sensor_file(path); }), HasSubstr("nested too deeply"));
}

TEST(HostileSidecar, FoldersAndArgumentsHaveNoControlCharacters) {
  const testing::TestFolder folder;
  const auto error_of = [&](const std::string& folder_text, const std::string& argument) {
    folder.write("a.glidar.json", R"({"glidar":"x","command":{"arguments":["render",")" + argument +
                                      R"("],"folder":")" + folder_text + R"("},"frame":0})");
    return error_text([&] { read_sidecar(folder / "a.pcd"); });
  };
  for (const char* text : {"", "a\\u0000b", "a\\nb", "\\u001b[2J"})
    EXPECT_THAT(error_of(text, "x"), HasSubstr("folder: '")) << text;
  EXPECT_THAT(error_of(repeated("a/", 3000), "x"), HasSubstr("1 to 4096 bytes"));
  for (const char* text : {"a\\u0000b", "a\\nb"})
    EXPECT_THAT(error_of(".", text), HasSubstr("an argument of its command: '")) << text;
  EXPECT_THAT(error_of(".", ""), HasSubstr("'instances' is missing"));  // both are right
}

TEST(HostileYaml, AliasesWrittenOutHaveALimit) {
  std::string bomb = "a0: &a0 [x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" +
            repeated(before + ",", 9) + before + "]\n";
  }
  EXPECT_THAT(error_text([&] { check_yaml_budget("f", bomb); }),
              HasSubstr("values with aliases written out; allowed: 1000000 values and 2 more"));
}

TEST(HostileYaml, RecursiveAliasesAreRejected) {
  for (const char* text : {"a: &a [1, *a]", "&a {b: {c: *a}}", "a: &a\n  - x\n  - {b: *a}\n"})
    EXPECT_THAT(error_text([&] { check_yaml_budget("f", text); }), HasSubstr("that it is in"))
        << text;
  EXPECT_EQ(error_text([] { check_yaml_budget("f", "a: &a\nb: *a\nc: &a [1]\nd: [*a, *a]\n"); }),
            "no error");
}

TEST(HostileYaml, ValuesHaveALimit) {
  const std::string most = "[" + repeated("1,", 999'998) + "1]";
  EXPECT_EQ(error_text([&] { check_yaml_budget("f", most); }), "no error");
  EXPECT_THAT(error_text([&] { check_yaml_budget("f", "[1," + most + "]"); }),
              HasSubstr("more than 1000000 values"));
}

TEST(HostileYaml, DocumentsHaveALimit) {
  EXPECT_EQ(error_text([] { check_yaml_budget("f", repeated("---\n1\n", 100)); }), "no error");
  EXPECT_THAT(error_text([] { check_yaml_budget("f", repeated("---\n1\n", 101)); }),
              HasSubstr("more than 100 YAML documents; allowed: one"));
}

TEST(HostileYaml, ManyMaterialsOfManyAliasedModelsAreRejected) {
  std::string text = "models:\n- &a\n  model: builtin:box\n  materials:\n";
  for (int i = 0; i < 3000; ++i) text += "    m" + std::to_string(i) + ": {opacity: 1}\n";
  text += repeated("- *a\n", 3000);
  const testing::TestFolder folder;
  const auto path = folder.write("scene.yaml", text);
  EXPECT_THAT(error_text([&] { load_scene_file(path, {}, {}); }), HasSubstr("aliases written out"));
}

TEST(HostileYaml, FilesThatAreNotUtf8AreRefusedWithTheirLine) {
  const testing::TestFolder folder;
  const auto path = folder.write("s.yaml", "# fine\nname: caf\xE9\n");
  EXPECT_THAT(error_text([&] { load_sensor_file(path); }),
              HasSubstr("s.yaml:2: bytes that are not UTF-8"));
}

TEST(ManyInstances, UnnamedOnesAreNamedInOrderAroundGivenNames) {
  const testing::TestFolder folder;
  const auto path = folder.write("scene.yaml", R"(models:
- {model: "builtin:box"}
- {model: "builtin:box", name: box_3}
- {model: "builtin:box"}
- {model: "builtin:box"}
- {model: "builtin:sphere", name: box}
- {model: "builtin:sphere"}
)");
  std::vector<std::string> names;
  for (const Instance& instance : load_scene_file(path, {}, {}).scene.instances)
    names.push_back(instance.name);
  EXPECT_THAT(names, ::testing::ElementsAre("box_2", "box_3", "box_4", "box_5", "box", "sphere"));
}

/// At quadratic time this would take an hour.
TEST(ManyInstances, UnnamedOnesOfOneModelLoadInLinearTime) {
  const testing::TestFolder folder;
  constexpr std::size_t kCount = 200'000;
  const auto path = folder.write(
      "scene.yaml", "models:\n- &a {model: 'builtin:box'}\n" + repeated("- *a\n", kCount - 1));
  const Scene scene = load_scene_file(path, {}, {}).scene;
  ASSERT_THAT(scene.instances, SizeIs(kCount));
  EXPECT_EQ(scene.instances.back().name, "box_200000");
  EXPECT_EQ(scene.instances.back().id, kCount);
}

}  // namespace
}  // namespace glidar
