// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/scene_file.hpp>

#include <glidar/io/builtin_models.hpp>
#include <glidar/io/scene_builder.hpp>

#include "yaml_files.hpp"

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kPi = std::numbers::pi;

/// Built-in models as if they came from files, and the sources asked for.
struct Loader {
  std::vector<std::string> asked;
  std::vector<ModelOptions> options;

  Model operator()(const std::string& source, const ModelOptions& with) {
    asked.push_back(source);
    options.push_back(with);
    Model model = make_builtin_model("box");
    model.source = source;
    model.mesh.material_slots.assign(model.mesh.triangles.size(), 0);
    model.mesh.material_slots.back() = 2;
    Material panels = model.materials[0];
    panels.name = "Panels";
    Material bus = model.materials[0];
    bus.name = "Bus";
    model.materials = {bus, panels, bus};
    return model;
  }
};

ScenePlan plan(const TestFolder& folder, const std::string& content) {
  return read_scene_plan(folder.write("scene.yaml", content), {});
}

Scene build(const std::string& content, Loader& loader) {
  const TestFolder folder;
  return build_scene(plan(folder, content), std::ref(loader));
}

Scene build(const std::string& content) {
  Loader loader;
  return build(content, loader);
}

Pose pose(const std::string& content) {
  const TestFolder folder;
  return plan(folder, "models: [{model: a.ply, pose: {" + content + "}}]\n")
      .instances[0]
      .world_from_object;
}

Pose sensor_pose(const std::string& content) {
  const TestFolder folder;
  return *plan(folder, "models: [{model: a.ply}]\nsensor_pose: {" + content + "}\n")
              .world_from_sensor;
}

TEST(SceneFile, ReadsEveryKeyOfAModel) {
  const TestFolder folder;
  const ScenePlan scene = plan(folder, R"(
models:
  - model: sub/rock.obj
    name: big rock
    unit: mm
    up: y
    scale: 2.5
    pose: {position: [1, -2, 3e6], orientation: {w: 0, x: 0, y: 0, z: 2}}
    id: 70
    class: asteroid
    materials:
      Panels: {ambient: [0, 0.5, 1], diffuse: [1, 0, 0], specular: [0, 0, 1], shininess: 128, opacity: 0.25}
)");
  ASSERT_EQ(scene.instances.size(), 1U);
  const PlannedInstance& rock = scene.instances[0];
  EXPECT_EQ(rock.source, (folder.path() / "sub/rock.obj").string());
  EXPECT_EQ(rock.name, "big rock");
  EXPECT_EQ(rock.options.metres_per_unit, 0.001);
  EXPECT_EQ(rock.options.up, Axis::y);
  EXPECT_EQ(rock.scale, 2.5);
  EXPECT_EQ(rock.world_from_object.translation(), Eigen::Vector3d(1, -2, 3e6));
  EXPECT_EQ(rock.world_from_object.linear(),
            Eigen::Vector3d(-1, -1, 1).asDiagonal().toDenseMatrix());
  EXPECT_EQ(rock.id, 70U);
  EXPECT_EQ(rock.class_name, "asteroid");
  ASSERT_EQ(rock.overrides.size(), 1U);
  EXPECT_EQ(rock.overrides[0].material, "Panels");
  EXPECT_EQ(rock.overrides[0].ambient, Eigen::Vector3f(0.0F, 0.5F, 1.0F));
  EXPECT_EQ(rock.overrides[0].diffuse, Eigen::Vector3f(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(rock.overrides[0].specular, Eigen::Vector3f(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(rock.overrides[0].shininess, 128.0F);
  EXPECT_EQ(rock.overrides[0].opacity, 0.25F);
  EXPECT_FALSE(scene.sensor.has_value());
  EXPECT_FALSE(scene.world_from_sensor.has_value());
}

TEST(SceneFile, DefaultsOfAModel) {
  ModelOptions defaults;
  defaults.metres_per_unit = 0.01;
  defaults.up = Axis::x;
  defaults.use_cache = false;
  const TestFolder folder;
  const auto file = folder.write("s.yaml", "models: [{model: rock.obj}, {model: /a/b.ply}]\n");
  const ScenePlan scene = read_scene_plan(file, defaults);
  EXPECT_EQ(scene.instances[0].options.metres_per_unit, 0.01);
  EXPECT_EQ(scene.instances[0].options.up, Axis::x);
  EXPECT_FALSE(scene.instances[0].options.use_cache);
  EXPECT_EQ(scene.instances[0].scale, 1.0);
  EXPECT_TRUE(scene.instances[0].world_from_object.isApprox(Pose::Identity(), 0.0));
  EXPECT_EQ(scene.instances[0].id, 1U);
  EXPECT_EQ(scene.instances[1].id, 2U);
  EXPECT_EQ(scene.instances[1].source, "/a/b.ply");
}

TEST(SceneFile, UnitsAreMetresPerUnit) {
  const TestFolder folder;
  const ScenePlan scene = plan(folder,
                               "models: [{model: a, unit: mm}, {model: a, unit: cm}, "
                               "{model: a, unit: m}, {model: a, unit: in}]\n");
  const std::array<double, 4> expected = {0.001, 0.01, 1.0, 0.0254};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(scene.instances[i].options.metres_per_unit, expected[i]);
  }
}

TEST(SceneFile, NamesComeFromTheFilesAndStayUnique) {
  const TestFolder folder;
  const ScenePlan scene = plan(folder,
                               "models: [{model: a/rock.obj}, {model: b/rock.ply}, "
                               "{model: builtin:box}, {model: x, name: rock_2}, {model: rock}]\n");
  std::vector<std::string> names;
  for (const PlannedInstance& instance : scene.instances) names.push_back(instance.name);
  EXPECT_EQ(names, (std::vector<std::string>{"rock", "rock_3", "box", "rock_2", "rock_4"}));
}

TEST(SceneFile, RotationsAgreeInEveryNotation) {
  EXPECT_TRUE(pose("").isApprox(Pose::Identity(), 0.0));
  EXPECT_TRUE(pose("rotation_vector: [0, 0, 0]").isApprox(Pose::Identity(), 0.0));
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const std::string quarter = std::to_string(kPi / 2.0);
  EXPECT_TRUE((pose("orientation: {w: 1, x: 0, y: 0, z: 1}") * Eigen::Vector3d::UnitX())
                  .isApprox(y, 1e-15));
  EXPECT_TRUE((pose("rotation_vector: [0, 0, " + quarter + "]") * Eigen::Vector3d::UnitX())
                  .isApprox(y, 1e-6));
  EXPECT_TRUE((pose("euler_deg: {yaw: 90}") * Eigen::Vector3d::UnitX()).isApprox(y, 1e-15));
}

// REP-103: roll about the fixed x, then pitch about the fixed y, then yaw about the fixed z.
TEST(SceneFile, EulerAnglesTurnAboutFixedAxesXThenYThenZ) {
  const Pose turned = pose("euler_deg: {roll: 90, pitch: 90, yaw: 0}");
  EXPECT_TRUE((turned * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX(), 1e-15));
  const Pose yawed = pose("euler_deg: {roll: 0, pitch: 90, yaw: 90}");
  EXPECT_TRUE((yawed * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

TEST(SceneFile, QuaternionsOfAnyLengthAreNormalised) {
  const Pose plain = pose("orientation: {w: 1, x: 2, y: 3, z: 4}");
  EXPECT_TRUE(pose("orientation: {w: 1e300, x: 2e300, y: 3e300, z: 4e300}").isApprox(plain, 1e-15));
  EXPECT_TRUE(
      pose("orientation: {w: 1e-300, x: 2e-300, y: 3e-300, z: 4e-300}").isApprox(plain, 1e-15));
}

TEST(SceneFile, SensorPoseTakesLookAt) {
  const Pose expected = look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0});
  EXPECT_TRUE(sensor_pose("look_at: {eye: [1, 2, 3], target: [0, 0, 0], up: [0, 1, 0]}")
                  .isApprox(expected, 0.0));
  EXPECT_TRUE(sensor_pose("look_at: {eye: [1, 2, 3], target: [0, 0, 0]}")
                  .isApprox(look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 1}), 0.0));
  EXPECT_EQ(sensor_pose("position: [1, 2, 3]").translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(SceneFile, SensorStandsInAFileOrInTheScene) {
  const TestFolder folder;
  (void)folder.write("sensors/c.yaml", "name: far\noptics: {width: 4, height: 2, fov_deg: 20}\n");
  EXPECT_EQ(plan(folder, "models: [{model: a}]\nsensor: sensors/c.yaml\n").sensor->name, "far");
  EXPECT_EQ(plan(folder,
                 "models: [{model: a}]\n"
                 "sensor: {name: near, optics: {width: 4, height: 2, fov_deg: 20}}\n")
                .sensor->name,
            "near");
}

TEST(SceneFile, EachFileIsLoadedOnceForAllItsInstances) {
  Loader loader;
  const Scene scene = build(
      "models: [{model: a.ply}, {model: b.ply}, {model: ./a.ply, scale: 3, id: 9}]\n", loader);
  EXPECT_EQ(loader.asked.size(), 2U);
  EXPECT_EQ(scene.meshes.size(), 2U);
  ASSERT_EQ(scene.instances.size(), 3U);
  EXPECT_EQ(scene.instances[2].mesh, scene.instances[0].mesh);
  EXPECT_EQ(scene.instances[2].materials, scene.instances[0].materials);
  EXPECT_EQ(scene.instances[2].scale, 3.0);
  EXPECT_EQ(scene.instances[2].id, 9U);
  EXPECT_EQ(scene.instances[2].name, "a_2");
}

TEST(SceneFile, AnotherUnitOrUpAxisIsAnotherMesh) {
  Loader loader;
  const Scene scene =
      build("models: [{model: a}, {model: a, unit: mm}, {model: a, up: z}, {model: a, unit: mm}]\n",
            loader);
  EXPECT_EQ(loader.asked.size(), 3U);
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[3].mesh);
}

TEST(SceneFile, LinksToOneFileAreOneMesh) {
  const TestFolder folder;
  (void)folder.write("a.ply", "");
  std::filesystem::create_symlink(folder.path() / "a.ply", folder.path() / "b.ply");
  Loader loader;
  const ScenePlan two = plan(folder, "models: [{model: a.ply}, {model: b.ply}]\n");
  EXPECT_EQ(build_scene(two, std::ref(loader)).meshes.size(), 1U);
}

TEST(SceneFile, ClassNamesAreCollectedInOrder) {
  const Scene scene = build(
      "models: [{model: a, class: rock}, {model: a}, {model: a, class: ship}, "
      "{model: a, class: rock}, {model: a, class: unlabelled}]\n");
  EXPECT_EQ(scene.class_names, (std::vector<std::string>{"unlabelled", "rock", "ship"}));
  std::vector<std::uint32_t> ids;
  for (const Instance& instance : scene.instances) ids.push_back(instance.class_id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{1, 0, 2, 1, 0}));
}

TEST(SceneFile, OverridesChangeOnlyTheirInstance) {
  const Scene scene = build(R"(
models:
  - {model: a, materials: {Bus: {diffuse: [1, 0, 0], opacity: 0.5}}}
  - {model: a}
)");
  const Instance& changed = scene.instances[0];
  const Instance& plain = scene.instances[1];
  for (const std::size_t slot : {0U, 2U}) {  // both slots of that name
    const Material& bus = scene.materials[changed.materials[slot]];
    const Material& was = scene.materials[plain.materials[slot]];
    EXPECT_EQ(bus.diffuse, Eigen::Vector3f(1, 0, 0));
    EXPECT_EQ(bus.opacity, 0.5F);
    EXPECT_EQ(bus.specular, was.specular);
    EXPECT_EQ(was.diffuse, Eigen::Vector3f::Constant(0.8F));
    EXPECT_EQ(was.opacity, 1.0F);
  }
  EXPECT_EQ(changed.materials[1], plain.materials[1]);
}

TEST(SceneFile, AnOverrideByNameWinsOverTheOneForAll) {
  const Scene scene = build(R"(
models:
  - model: a
    materials:
      Panels: {shininess: 1}
      "*": {shininess: 2, ambient: [0, 0, 0]}
)");
  const std::vector<std::uint32_t>& slots = scene.instances[0].materials;
  EXPECT_EQ(scene.materials[slots[0]].shininess, 2.0F);
  EXPECT_EQ(scene.materials[slots[1]].shininess, 1.0F);
  EXPECT_EQ(scene.materials[slots[1]].ambient, Eigen::Vector3f::Zero());
}

TEST(SceneFile, UnknownMaterialIsToldWithThoseOfTheModel) {
  const TestFolder folder;
  const ScenePlan scene =
      plan(folder, "models:\n  - model: a\n    materials:\n      Pannels: {opacity: 1}\n");
  EXPECT_EQ(error_of(folder, [&] { build_scene(scene, Loader{}); }),
            "scene.yaml:4:16: models[0].materials.Pannels: the model has no material 'Pannels'; "
            "allowed: 'Bus', 'Panels', or '*' for all; did you mean 'Panels'?");
}

TEST(SceneFile, ErrorsOfAModelAreToldWithTheirPlaceInTheScene) {
  const TestFolder folder;
  const ScenePlan scene = plan(folder, "models:\n  - model: builtin:astroid\n");
  const auto load = [](const std::string& source, const ModelOptions&) {
    return make_builtin_model(source.substr(8));
  };
  EXPECT_EQ(error_of(folder, [&] { build_scene(scene, load); }),
            "scene.yaml:2:12: models[0].model: builtin:astroid: no built-in model of this name; "
            "allowed: asteroid, sphere, box, torus, plane; did you mean 'builtin:asteroid'?");
}

TEST(SceneFile, ExampleLoads) {
  const SceneFile file = load_scene_file(
      std::filesystem::path(GLIDAR_SOURCE_FOLDER) / "examples/two_rocks.yaml", {}, {});
  ASSERT_EQ(file.scene.instances.size(), 3U);
  EXPECT_EQ(file.scene.meshes.size(), 2U);
  EXPECT_EQ(file.scene.instances[0].mesh, file.scene.instances[1].mesh);
  EXPECT_EQ(file.scene.class_names,
            (std::vector<std::string>{"unlabelled", "asteroid", "calibration target"}));
  ASSERT_TRUE(file.sensor && file.world_from_sensor);
  EXPECT_EQ(file.sensor->name, "paper camera");
  // The whole scene lies in the cone of the camera's 20 degrees.
  const Eigen::AlignedBox3d box = bounds(file.scene);
  const Eigen::Vector3d centre = file.world_from_sensor->inverse() * box.center();
  EXPECT_LT((centre.head<2>().norm() + 0.5 * box.diagonal().norm()) / centre.z(),
            std::tan(kPi / 18.0) * 1.3);
}

class SceneFileError : public testing::TestWithParam<BadFile> {};

TEST_P(SceneFileError, NamesPlaceFieldAndCure) {
  const TestFolder folder;
  const auto file = folder.write("s.yaml", GetParam().content);
  EXPECT_EQ(error_of(folder, [&] { read_scene_plan(file, {}); }), GetParam().error);
}

std::string model(const std::string& rest) {
  return "models:\n  - model: a\n    " + rest + "\n";
}
std::string with_model(const std::string& rest) {
  return "models: [{model: a}]\n" + rest + "\n";
}

const std::string kPoseKeys = "position, orientation, rotation_vector, euler_deg";

const BadFile kBadScenes[] = {
    {"NoModels", "sensor: c.yaml\n", "s.yaml:1:1: the key 'models' is missing; add 'models: ...'"},
    {"UnknownTopKey", with_model("sensr: c.yaml"),
     "s.yaml:2:1: sensr: unknown key 'sensr'; allowed: models, sensor, sensor_pose; did you mean "
     "'sensor'?"},
    {"ModelsIsAMap", "models: {model: a}\n", "s.yaml:1:9: models: a map; allowed: a list"},
    {"ModelsIsEmpty", "models: []\n",
     "s.yaml:1:9: models: an empty list; allowed: at least one model"},
    {"ModelsHasNoValue", "models:\n", "s.yaml:1:1: models: no value; allowed: a list"},
    {"ModelIsAWord", "models: [rock.obj]\n",
     "s.yaml:1:10: models[0]: 'rock.obj'; allowed: a map (key: value)"},
    {"ModelWithoutFile", "models:\n  - {model: a}\n  - {name: b}\n",
     "s.yaml:3:5: models[1]: the key 'model' is missing; add 'model: ...'"},
    {"UnknownModelKey", model("scal: 2"),
     "s.yaml:3:5: models[0].scal: unknown key 'scal'; allowed: model, name, unit, up, scale, pose, "
     "id, class, materials; did you mean 'scale'?"},
    {"UnknownUnit", model("unit: inch"),
     "s.yaml:3:11: models[0].unit: 'inch'; allowed: mm, cm, m, in; did you mean 'in'?"},
    {"UnknownAxis", model("up: w"),
     "s.yaml:3:9: models[0].up: 'w'; allowed: x, y, z; did you "
     "mean 'x'?"},
    {"ScaleZero", model("scale: 0"),
     "s.yaml:3:12: models[0].scale: 0; allowed: a finite number above 0"},
    {"ScaleNan", model("scale: .nan"),
     "s.yaml:3:12: models[0].scale: .nan; allowed: a finite number above 0"},
    {"IdNegative", model("id: -1"),
     "s.yaml:3:9: models[0].id: -1; allowed: a whole number from 0 to 4294967294"},
    {"IdReserved", model("id: 4294967295"),
     "s.yaml:3:9: models[0].id: 4294967295; allowed: a whole number from 0 to 4294967294"},
    {"IdTwice", "models: [{model: a, id: 2}, {model: a}]\n",
     "s.yaml:1:29: models[1]: id 2, which models[0] has; allowed: each id once (without 'id' it is "
     "the place in the list, from 1); give one of them another id"},
    {"NameTwice", "models: [{model: a, name: b}, {model: a, name: b}]\n",
     "s.yaml:1:48: models[1].name: the name 'b' is given twice; allowed: each name once; choose "
     "another name"},
    {"PositionOfTwo", model("pose: {position: [1, 2]}"),
     "s.yaml:3:22: models[0].pose.position: a list of 2; allowed: a list of 3 numbers"},
    {"PositionInfinite", model("pose: {position: [1, 2, .inf]}"),
     "s.yaml:3:29: models[0].pose.position[2]: .inf; allowed: a finite number"},
    {"PositionNamed", model("pose: {position: {x: 1, y: 2, z: 3}}"),
     "s.yaml:3:22: models[0].pose.position: a map; allowed: a list of 3 numbers"},
    {"PoseUnknownKey", model("pose: {orientaton: {}}"),
     "s.yaml:3:12: models[0].pose.orientaton: unknown key 'orientaton'; allowed: " + kPoseKeys +
         "; did you mean 'orientation'?"},
    {"TwoRotations", model("pose: {orientation: {w: 1, x: 0, y: 0, z: 0}, euler_deg: {yaw: 1}}"),
     "s.yaml:3:62: models[0].pose.euler_deg: given beside 'orientation'; allowed: one of "
     "orientation, rotation_vector, euler_deg; remove one of them"},
    {"QuaternionAsAList", model("pose: {orientation: [1, 0, 0, 0]}"),
     "s.yaml:3:25: models[0].pose.orientation: a list of 4; allowed: a map with the keys w, x, y, "
     "z; name the parts: {w: 1, x: 0, y: 0, z: 0}; their order in a list is ambiguous"},
    {"QuaternionWithoutW", model("pose: {orientation: {x: 0, y: 0, z: 0}}"),
     "s.yaml:3:25: models[0].pose.orientation: the key 'w' is missing; add 'w: ...'"},
    {"QuaternionOfZeros", model("pose: {orientation: {w: 0, x: 0, y: 0, z: 0}}"),
     "s.yaml:3:25: models[0].pose.orientation: a quaternion of zeros; allowed: a quaternion of any "
     "other length"},
    {"EulerUnknownAngle", model("pose: {euler_deg: {rol: 1}}"),
     "s.yaml:3:24: models[0].pose.euler_deg.rol: unknown key 'rol'; allowed: roll, pitch, yaw; did "
     "you mean 'roll'?"},
    {"ColourAboveOne", model("materials: {A: {diffuse: [0, 255, 0]}}"),
     "s.yaml:3:34: models[0].materials.A.diffuse[1]: 255; allowed: a number from 0 to 1"},
    {"ColourAsANumber", model("materials: {A: {diffuse: 0.5}}"),
     "s.yaml:3:30: models[0].materials.A.diffuse: 0.5; allowed: a list of 3 numbers"},
    {"ShininessTooLarge", model("materials: {A: {shininess: 129}}"),
     "s.yaml:3:32: models[0].materials.A.shininess: 129; allowed: a number from 0 to 128"},
    {"OpacityNegative", model("materials: {A: {opacity: -0.1}}"),
     "s.yaml:3:30: models[0].materials.A.opacity: -0.1; allowed: a number from 0 to 1"},
    {"MaterialTwice", model("materials: {A: {}, A: {}}"),
     "s.yaml:3:24: models[0].materials.A: the key is given twice; allowed: each key once; remove "
     "one of them"},
    {"MaterialUnknownKey", model("materials: {A: {difuse: [1, 1, 1]}}"),
     "s.yaml:3:21: models[0].materials.A.difuse: unknown key 'difuse'; allowed: ambient, diffuse, "
     "specular, shininess, opacity; did you mean 'diffuse'?"},
    {"SensorIsAList", with_model("sensor: [a]"),
     "s.yaml:2:9: sensor: a list of 1; allowed: a map, or the path of a sensor file"},
    {"SensorFileIsMissing", with_model("sensor: c.yaml"),
     "s.yaml:2:9: sensor: no such file: c.yaml; allowed: a map, or the path of a sensor file; "
     "paths are relative to the folder of this file"},
    {"SensorInTheSceneIsWrong", with_model("sensor: {optics: {widht: 3}}"),
     "s.yaml:2:19: sensor.optics.widht: unknown key 'widht'; allowed: type, width, height, "
     "fov_deg, fov_x_deg, fx, fy, cx, cy, pixel_centre, distortion; did you mean 'width'?"},
    {"LookAtBesidePosition",
     with_model("sensor_pose: {position: [0, 0, 0], look_at: {eye: [0, 0, 0], target: [1, 0, 0]}}"),
     "s.yaml:2:45: sensor_pose.look_at: given beside other keys; allowed: look_at alone, or a "
     "position and a rotation; remove one of them"},
    {"LookAtNothing", with_model("sensor_pose: {look_at: {eye: [1, 0, 0], target: [1, 0, 0]}}"),
     "s.yaml:2:24: sensor_pose.look_at: eye and target are the same point; allowed: two distinct "
     "points"},
    {"LookAtAlongUp", with_model("sensor_pose: {look_at: {eye: [0, 0, 5], target: [0, 0, 0]}}"),
     "s.yaml:2:24: sensor_pose.look_at: the up vector is parallel to the line of sight; allowed: "
     "an up vector that is not; choose another up vector"},
    {"LookAtWithoutTarget", with_model("sensor_pose: {look_at: {eye: [0, 0, 5]}}"),
     "s.yaml:2:24: sensor_pose.look_at: the key 'target' is missing; add 'target: ...'"},
};

INSTANTIATE_TEST_SUITE_P(All, SceneFileError, testing::ValuesIn(kBadScenes), bad_file_name);

TEST(SceneFile, ErrorsInTheSensorFileNameThatFile) {
  const TestFolder folder;
  (void)folder.write("c.yaml", "optics:\n  width: 0\n");
  EXPECT_EQ(error_of(folder, [&] { plan(folder, with_model("sensor: c.yaml")); }),
            "c.yaml:2:10: optics.width: 0; allowed: a whole number from 1 to 65536");
}

}  // namespace
}  // namespace glidar
