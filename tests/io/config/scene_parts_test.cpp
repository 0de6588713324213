// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_plan.hpp>
#include <glidar/io/model/model_parts.hpp>

#include "io/yaml_files.hpp"

#include <gmock/gmock.h>

#include <map>
#include <variant>

namespace glidar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Pose at(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

/// A robot: triangle 0 is its body, 1 its arm, 2 its hand, which is below the arm, 3 and 4 its
/// wheels, which have the same name. The arm begins at (0, 0, 1), the hand 2 m in front of it.
Model robot() {
  Model model;
  model.mesh.name = "robot";
  for (std::uint32_t t = 0; t < 5; ++t) {
    const auto x = static_cast<float>(t);
    for (const auto& corner :
         {Eigen::Vector3f(x, 0, 1), Eigen::Vector3f(x + 0.5F, 0, 1), Eigen::Vector3f(x, 0.5F, 1)}) {
      model.mesh.positions_m.push_back(corner);
    }
    model.mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  model.mesh.material_slots = {0, 0, 1, 2, 2};
  for (const char* name : {"steel", "glass", "rubber"}) {
    model.materials.emplace_back().name = name;
  }
  model.nodes = {{},
                 {"body", 0, at(0, 0, 0)},
                 {"arm", 1, at(0, 0, 1)},
                 {"hand", 2, at(2, 0, 1)},
                 {"wheel", 1, at(3, 0, 0)},
                 {"wheel", 1, at(4, 0, 0)}};
  model.parts = {{"", 0, 1, 1}, {"", 1, 1, 2}, {"", 2, 1, 3}, {"", 3, 1, 4}, {"", 4, 1, 5}};
  return model;
}

SceneFile build(const std::string& content, const Model& all = robot(), Scene into = {}) {
  const TestFolder folder;
  const ScenePlan plan = read_scene_plan(folder.write("scene.yaml", content), {});
  const auto load = [&all](const std::string& source, const ModelOptions&) {
    Model model = all;
    model.source = source;
    return model;
  };
  return build_scene(plan, load, std::move(into));
}

std::string error_of_scene(const std::string& content, Scene into = {}) {
  try {
    build(content, robot(), std::move(into));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Instance& instance : scene.instances) names.push_back(instance.name);
  return names;
}

const Instance& instance_of(const Scene& scene, const std::string& name) {
  for (const Instance& instance : scene.instances) {
    if (instance.name == name) return instance;
  }
  throw std::runtime_error("no instance " + name);
}

/// The names of the materials of an instance, in its order.
std::vector<std::string> materials_of(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const std::uint32_t index : instance_of(scene, name).materials) {
    names.push_back(scene.materials[index].name);
  }
  return names;
}

std::string class_of(const Scene& scene, const std::string& name) {
  return scene.class_names[instance_of(scene, name).class_id];
}

/// The first corner of a triangle of the instance in the world.
Eigen::Vector3d corner(const Scene& scene, const Instance& instance, std::size_t triangle = 0) {
  const Mesh& mesh = scene.meshes[instance.mesh];
  return instance.world_from_object *
         (instance.scale * vertex_m(mesh, mesh.triangles.at(triangle)[0]));
}

TEST(ModelParts, HaveUniquePaths) {
  EXPECT_THAT(part_names(robot().nodes),
              ElementsAre("", "body", "body/arm", "body/arm/hand", "body/wheel", "body/wheel_2"));
}

TEST(ModelParts, AreListedWithWhatIsBelowThem) {
  const std::vector<PartSummary> parts = list_parts(robot());
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_EQ(parts[0].triangles, 5U);
  EXPECT_THAT(parts[0].materials, ElementsAre("steel", "glass", "rubber"));
  EXPECT_EQ(parts[1].name, "body/arm");
  EXPECT_EQ(parts[1].parent, "body");
  EXPECT_EQ(parts[1].triangles, 2U);
  EXPECT_THAT(parts[1].materials, ElementsAre("steel", "glass"));
  EXPECT_EQ(parts[1].box_m.min(), Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(parts[1].box_m.max(), Eigen::Vector3d(2.5, 0.5, 1));
  EXPECT_EQ(parts[2].parent_from_part.translation(), Eigen::Vector3d(2, 0, 0));
}

TEST(ModelParts, PatternsMatchAnyCharacters) {
  EXPECT_TRUE(matches_pattern("arm/*", "arm/hand/finger"));
  EXPECT_TRUE(matches_pattern("*", ""));
  EXPECT_TRUE(matches_pattern("*a?c*", "xxabbabc"));
  EXPECT_TRUE(matches_pattern("arm", "arm"));
  EXPECT_FALSE(matches_pattern("arm", "arm/hand"));
  EXPECT_FALSE(matches_pattern("arm/*", "arm"));
  EXPECT_FALSE(matches_pattern("a?", "a"));
}

TEST(SceneParts, ASceneWithoutThemIsNotCut) {
  const Scene scene = build("models: [{model: a}]\n").scene;
  ASSERT_EQ(scene.instances.size(), 1U);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 5U);
}

TEST(SceneParts, GetClassIdAndMaterialWithAllBelowThem) {
  const Scene scene = build(R"(
models:
  - model: a
    class: robot
    id: 7
    parts:
      body/arm: {class: arm, id: 20, materials: {steel: {shininess: 5}}}
      body/arm/hand: {class: hand}
)")
                          .scene;
  EXPECT_THAT(names_of(scene), ElementsAre("a", "a/body/arm", "a/body/arm/hand"));
  EXPECT_EQ(scene.meshes.size(), 3U);
  EXPECT_EQ(class_of(scene, "a"), "robot");
  EXPECT_EQ(class_of(scene, "a/body/arm"), "arm");
  EXPECT_EQ(class_of(scene, "a/body/arm/hand"), "hand");
  EXPECT_EQ(instance_of(scene, "a").id, 7U);
  EXPECT_EQ(instance_of(scene, "a/body/arm").id, 20U);
  EXPECT_EQ(instance_of(scene, "a/body/arm/hand").id, 21U);  // the next one above all
  const Instance& arm = instance_of(scene, "a/body/arm");
  EXPECT_EQ(material_of(scene, arm, 0).shininess, 5.0F);
  EXPECT_NE(material_of(scene, instance_of(scene, "a"), 0).shininess, 5.0F);
  EXPECT_EQ(scene.meshes[instance_of(scene, "a").mesh].triangles.size(), 3U);
  EXPECT_EQ(corner(scene, instance_of(scene, "a"), 2), Eigen::Vector3d(4, 0, 1));
}

TEST(SceneParts, PatternsAndMaterialsSelectThem) {
  const Scene scene = build(R"(
models:
  - model: a
    parts: {"*/wheel*": {class: wheel}, "material:gl*": {class: window}}
)")
                          .scene;
  EXPECT_THAT(names_of(scene), ElementsAre("a", "a/material:gl*", "a/*/wheel*"));
  EXPECT_EQ(class_of(scene, "a/*/wheel*"), "wheel");
  EXPECT_EQ(class_of(scene, "a/material:gl*"), "window");
  EXPECT_EQ(scene.meshes[instance_of(scene, "a/*/wheel*").mesh].triangles.size(), 2U);
}

TEST(SceneParts, HaveOnlyTheMaterialsOfTheirTriangles) {
  const std::string model =
      "{model: a, parts: {body/arm: {class: arm}, body/wheel: {class: wheel}}";
  const Scene scene = build("models: [" + model + "}, " + model +
                            ", id: 20, name: b, materials: {rubber: {shininess: 5}}}]\n")
                          .scene;
  for (const std::string name : {"a", "b"}) {
    EXPECT_THAT(materials_of(scene, name), ElementsAre("steel", "rubber"));
    EXPECT_THAT(materials_of(scene, name + "/body/arm"), ElementsAre("steel", "glass"));
    EXPECT_THAT(materials_of(scene, name + "/body/wheel"), ElementsAre("rubber"));
    EXPECT_EQ(material_of(scene, instance_of(scene, name), 0).name, "steel");
    EXPECT_EQ(material_of(scene, instance_of(scene, name), 1).name, "rubber");
    EXPECT_EQ(material_of(scene, instance_of(scene, name + "/body/arm"), 1).name, "glass");
    EXPECT_EQ(material_of(scene, instance_of(scene, name + "/body/wheel"), 0).name, "rubber");
  }
  EXPECT_EQ(scene.meshes.size(), 3U);
  EXPECT_EQ(material_of(scene, instance_of(scene, "b/body/wheel"), 0).shininess, 5.0F);
  EXPECT_NE(material_of(scene, instance_of(scene, "a/body/wheel"), 0).shininess, 5.0F);
}

TEST(SceneParts, LaterEntriesOverrideEarlierOnes) {
  const Scene scene = build(R"(
models:
  - model: a
    parts: {body/arm/hand: {class: first}, "*": {class: second}}
)")
                          .scene;
  EXPECT_EQ(class_of(scene, "a/*"), "second");
  EXPECT_EQ(class_of(scene, "a/*_2"), "second");
}

TEST(SceneParts, SplitGivesEachPartAClassAndAnId) {
  const Scene scene = build("models: [{model: a, split: parts}, {model: builtin:b}]\n").scene;
  ASSERT_EQ(scene.instances.size(), 6U);
  std::map<std::string, std::uint32_t> ids;
  for (const Instance& instance : scene.instances) {
    ids[scene.class_names[instance.class_id]] = instance.id;
  }
  // id 2 is that of the other model
  EXPECT_EQ(ids, (std::map<std::string, std::uint32_t>{{"body", 3},
                                                       {"body/arm", 4},
                                                       {"body/arm/hand", 5},
                                                       {"body/wheel", 6},
                                                       {"body/wheel_2", 7},
                                                       {"unlabelled", 2}}));
}

TEST(SceneParts, SplitByMaterialCountsFromTheIdOfTheModel) {
  const Scene scene = build("models: [{model: a, id: 40, split: materials}]\n").scene;
  EXPECT_THAT(names_of(scene), ElementsAre("a/steel", "a/glass", "a/rubber"));
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.instances[i].id, 40 + i);
    EXPECT_EQ("a/" + scene.class_names[scene.instances[i].class_id], scene.instances[i].name);
  }
}

TEST(SceneParts, SplitGivesTrianglesWithoutANameTheClassOfTheModel) {
  Model nameless = robot();
  nameless.parts.erase(nameless.parts.begin());  // the body
  nameless.materials[0].name.clear();
  for (const std::string split : {"parts", "materials"}) {
    const std::string model = "models: [{model: a, split: " + split;
    const Scene with_class = build(model + ", class: robot}]\n", nameless).scene;
    EXPECT_EQ(class_of(with_class, "a/a"), "robot");
    EXPECT_EQ(class_of(build(model + "}]\n", nameless).scene, "a/a"), "a");
  }
  const Scene scene = build("models: [{model: a, name: body/arm, split: parts}]\n", nameless).scene;
  EXPECT_EQ(scene.instances.size(), 5U);  // no part has the triangles without one
}

TEST(SceneParts, NeedNoNumbersAboveTheirIds) {
  const std::string model = "models: [{model: a, id: 4294967294, parts: {body/arm: ";
  const Scene scene = build(model + "{id: 3}}}]\n").scene;
  EXPECT_EQ(instance_of(scene, "a").id, 4294967294U);
  EXPECT_EQ(instance_of(scene, "a/body/arm").id, 3U);
  EXPECT_THAT(error_of_scene(model + "{class: arm}}}]\n"), HasSubstr("no ids are left"));
}

TEST(SceneParts, SharesTheMeshesOfAPartThatIsLoadedTwice) {
  const std::string parts = "parts: {body/arm: {class: arm}}";
  const Scene scene =
      build("models: [{model: a, " + parts + "}, {model: a, scale: 2, " + parts + "}]\n").scene;
  ASSERT_EQ(scene.instances.size(), 4U);
  EXPECT_EQ(scene.meshes.size(), 2U);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[3].mesh);
}

TEST(SceneParts, PoseReplacesTheOneInTheFileAndMovesPartsBelow) {
  const Scene scene = build(R"(
models:
  - model: a
    pose: {position: [10, 0, 0]}
    parts:
      body/arm: {pose: {position: [0, 0, 5], euler_deg: {yaw: 90}}}
      body/arm/hand: {pose: {position: [3, 0, 0]}}
)")
                          .scene;
  // At rest the arm's corner is (1, 0, 0) from the arm, the hand's (0, 0, 0) from the hand.
  EXPECT_TRUE(
      corner(scene, instance_of(scene, "a/body/arm")).isApprox(Eigen::Vector3d(10, 1, 5), 1e-14));
  EXPECT_TRUE(corner(scene, instance_of(scene, "a/body/arm/hand"))
                  .isApprox(Eigen::Vector3d(10, 3, 5), 1e-14));
  EXPECT_EQ(corner(scene, instance_of(scene, "a")), Eigen::Vector3d(10, 0, 1));
}

TEST(SceneParts, ThePoseOfTheFileMovesNothing) {
  const Scene scene =
      build("models: [{model: a, parts: {body/arm: {pose: {position: [0, 0, 1]}}}}]\n").scene;
  EXPECT_EQ(corner(scene, instance_of(scene, "a/body/arm")), Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(corner(scene, instance_of(scene, "a/body/arm"), 1), Eigen::Vector3d(2, 0, 1));
}

TEST(SceneParts, PoseIsScaledAndMirroredWithTheModel) {
  const auto corner_with = [](const std::string& scale) {
    const Scene scene = build("models: [{model: a, scale: " + scale +
                              ", parts: {body/arm: {pose: {position: [0, 2, 1], euler_deg: {yaw: "
                              "90}}}}}]\n")
                            .scene;
    return corner(scene, instance_of(scene, "a/body/arm"));
  };
  EXPECT_TRUE(corner_with("1").isApprox(Eigen::Vector3d(0, 3, 1), 1e-14));
  EXPECT_TRUE(corner_with("2").isApprox(Eigen::Vector3d(0, 6, 2), 1e-14));
  EXPECT_TRUE(corner_with("[2, -2, 2]").isApprox(Eigen::Vector3d(0, -6, 2), 1e-14));
  EXPECT_TRUE(corner_with("-1").isApprox(Eigen::Vector3d(0, -3, -1), 1e-14));
  EXPECT_THAT(error_of_scene("models: [{model: a, scale: [1, 2, 1], parts: {body/arm: {pose: "
                             "{position: [0, 2, 1]}}}}]\n"),
              HasSubstr("factors of equal size"));
}

TEST(SceneParts, MoveWithTheModel) {
  const SceneFile file = build(R"(
models:
  - model: a
    motion: {twist: {velocity_m_s: [1, 0, 0]}}
    parts: {body/arm: {pose: {position: [0, 2, 1]}}}
  - {model: builtin:still}
)");
  ASSERT_EQ(file.world_from_instance.size(), 3U);
  const std::int64_t second_ns = 1'000'000'000;
  EXPECT_EQ(pose_at(file.world_from_instance[0], second_ns).translation(),
            Eigen::Vector3d(1, 0, 0));
  EXPECT_TRUE(pose_at(file.world_from_instance[1], second_ns)
                  .translation()
                  .isApprox(Eigen::Vector3d(1, 2, 0), 1e-14));
  EXPECT_TRUE(std::holds_alternative<ConstantPose>(file.world_from_instance[2]));
}

TEST(SceneParts, SensorsByNameSeeThemOrNot) {
  const Scene scene = build(R"(
models:
  - model: a
    hidden_from: [front]
    parts:
      body/arm: {visible_to: [rear]}
      body/wheel: {hidden_from: [front, rear]}
sensors: [{name: front, sensor: VLP-16}, {name: rear, sensor: VLP-16}]
)")
                          .scene;
  const auto sees = [&](std::uint32_t sensor, const std::string& name) {
    return is_visible(instance_of(scene, name), sensor);
  };
  EXPECT_FALSE(sees(0, "a"));
  EXPECT_TRUE(sees(1, "a"));
  EXPECT_FALSE(sees(0, "a/body/arm"));
  EXPECT_TRUE(sees(1, "a/body/arm"));
  EXPECT_FALSE(sees(2, "a/body/arm"));
  EXPECT_FALSE(sees(0, "a/body/wheel"));
  EXPECT_FALSE(sees(1, "a/body/wheel"));
}

TEST(SceneParts, TheOnlySensorOfASceneIsCalledSensor) {
  const std::string models = "models: [{model: a, hidden_from: [sensor]}, {model: b, id: 9}]\n";
  for (const std::string sensor : {"", "sensor: VLP-16\n"}) {
    const Scene scene = build(models + sensor).scene;
    EXPECT_FALSE(is_visible(instance_of(scene, "a"), 0));
    EXPECT_TRUE(is_visible(instance_of(scene, "a"), 1));
    EXPECT_TRUE(is_visible(instance_of(scene, "b"), 0));
    EXPECT_THAT(error_of_scene("models: [{model: a, visible_to: [lidar]}]\n" + sensor),
                HasSubstr("the scene has no sensor 'lidar'; allowed: 'sensor', its only one; list "
                          "several in 'sensors', with names"));
  }
  EXPECT_THAT(error_of_scene(models + "sensors: [{name: front, sensor: VLP-16}]\n"),
              HasSubstr("the rig has no sensor 'sensor'; allowed: 'front'"));
}

TEST(SceneParts, AnIdIsThatOfOneObject) {
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {body: {id: 20}, '*': {class: x}}}]\n"),
              HasSubstr("models[0].parts.body.id: later entries select all of it; allowed: an id "
                        "of an object; give it to the last of these entries"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {material:glass: {class: window}, "
                             "body/arm: {id: 20}}}]\n"),
              HasSubstr("models[0].parts.body/arm.id: an id for 2 objects; allowed: an id of one "
                        "object; give the others entries after this one"));
  EXPECT_THAT(error_of_scene("models: [{model: a, split: parts, parts: {body/arm: {id: 20}}}]\n"),
              HasSubstr("an id for 2 objects"));
  const Scene scene =
      build("models: [{model: a, split: parts, parts: {body/arm: {id: 20}, body/arm/hand: {}}}]\n")
          .scene;
  EXPECT_EQ(instance_of(scene, "a/body/arm").id, 20U);
}

TEST(SceneParts, NamesAndIdsOfTheSceneAreNotGivenAgain) {
  Scene scene = build("models: [{model: a, name: robot, id: 7}]\n").scene;
  EXPECT_THAT(error_of_scene("models: [{model: b, name: robot}]\n", scene),
              HasSubstr("models[0].model: the name 'robot', which another object has"));
  EXPECT_THAT(error_of_scene("models: [{model: b, id: 7}]\n", scene),
              HasSubstr("models[0].model: id 7, which another object has"));
  scene = build("models: [{model: b}]\n", robot(), std::move(scene)).scene;
  EXPECT_THAT(names_of(scene), ElementsAre("robot", "b"));
}

TEST(SceneParts, MaterialsOfAnEntryAreThoseOfItsTriangles) {
  const std::string model = "models: [{model: a, parts: {body/arm/hand: {materials: ";
  EXPECT_THAT(error_of_scene(model + "{steel: {shininess: 5}}}}}]\n"),
              HasSubstr("materials.steel: the part 'body/arm/hand' has no material 'steel'; "
                        "allowed: 'glass', or '*' for all"));
  EXPECT_THAT(error_of_scene(model + "{glas: {shininess: 5}}}}}]\n"),
              HasSubstr("did you mean 'glass'?"));
  const Scene scene = build(model + "{glass: {shininess: 5}}}}}]\n").scene;
  EXPECT_EQ(material_of(scene, instance_of(scene, "a/body/arm/hand"), 0).shininess, 5.0F);
}

TEST(SceneParts, ErrorsNameWhatIsKnown) {
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {'': {class: x}}}]\n"),
              HasSubstr("an empty name; allowed: names and patterns of parts, 'material:NAME'; '*' "
                        "selects the whole model"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {body/arn: {class: x}}}]\n"),
              HasSubstr("the model has no part 'body/arn'; allowed: 'body', 'body/arm', "
                        "'body/arm/hand', 'body/wheel', 'body/wheel_2', 'material:steel', "
                        "'material:glass', 'material:rubber'; did you mean 'body/arm'?"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {material:gold: {class: x}}}]\n"),
              HasSubstr("no part 'material:gold'"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {body/wheel*: {pose: {position: [0, 0, "
                             "0]}}}}]\n"),
              HasSubstr("a pose for 2 parts"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {material:glass: {pose: {position: [0, "
                             "0, 0]}}}}]\n"),
              HasSubstr("a pose for 0 parts"));
  EXPECT_THAT(error_of_scene("models: [{model: a, parts: {body: {id: 2}}}, {model: builtin:b}]\n"),
              HasSubstr("id 2, which another has"));
  EXPECT_THAT(error_of_scene("models: [{model: a, hidden_from: [left]}]\n"),
              HasSubstr("the scene has no sensor 'left'"));
  EXPECT_THAT(error_of_scene("models: [{model: a, hidden_from: [fornt]}]\nsensors: [{name: front, "
                             "sensor: VLP-16}]\n"),
              HasSubstr("the rig has no sensor 'fornt'; allowed: 'front'; did you mean 'front'?"));
  EXPECT_THAT(error_of_scene("models: [{model: a, visible_to: []}]\n"), HasSubstr("an empty list"));
  EXPECT_THAT(error_of_scene("models: [{model: a, scale: [1, 0, 1]}]\n"),
              HasSubstr("models[0].scale: a factor of 0"));
}

}  // namespace
}  // namespace glidar
