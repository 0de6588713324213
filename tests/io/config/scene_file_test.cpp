// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_file.hpp>

#include <glidar/io/config/scene_plan.hpp>
#include <glidar/io/model/builtin_models.hpp>

#include <support/source_folder.hpp>

#include "io/yaml_files.hpp"

#include <cmath>
#include <numbers>

namespace glidar {
namespace {

constexpr double kPi = std::numbers::pi;

/// Built-in models as if they came from files, and the requested sources.
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
  return build_scene(plan(folder, content), std::ref(loader)).scene;
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
  return *plan(folder, "models: [{model: a.ply}]\nsensor_pose: {" + content + "}\n").world_from_rig;
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
  EXPECT_EQ(rock.scale, Eigen::Vector3d::Constant(2.5));
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
  EXPECT_TRUE(scene.sensors.empty());
  EXPECT_FALSE(scene.world_from_rig.has_value());
}

TEST(SceneFile, SensorLooksStraightDownWithoutAnUpVector) {
  const Pose pose = sensor_pose("look_at: {eye: [1, 2, 9], target: [1, 2, 0]}");
  EXPECT_TRUE(pose.isApprox(look_at({1, 2, 9}, {1, 2, 0}, {1, 0, 0}), 0.0));
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
  EXPECT_EQ(scene.instances[0].scale, Eigen::Vector3d::Ones());
  EXPECT_TRUE(scene.instances[0].world_from_object.isApprox(Pose::Identity(), 0.0));
  EXPECT_EQ(scene.instances[0].id, 1U);
  EXPECT_EQ(scene.instances[1].id, 2U);
  EXPECT_EQ(scene.instances[1].source, "/a/b.ply");
}

TEST(SceneFile, UnitsAreMetresPerUnit) {
  const TestFolder folder;
  const ScenePlan scene =
      plan(folder,
           "models: [{model: a, unit: mm}, {model: a, unit: cm}, "
           "{model: a, unit: m}, {model: a, unit: in}, {model: a, unit: FT}]\n");
  const std::array<double, 5> expected = {0.001, 0.01, 1.0, 0.0254, 0.3048};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(scene.instances[i].options.metres_per_unit, expected[i]);
  }
}

TEST(SceneFile, AmericanSpellingsCapitalsAndAllWordsOfYamlForYesAreAccepted) {
  const TestFolder folder;
  for (const char* word : {"true", "True", "yes", "YES", "on"}) {
    const ScenePlan scene =
        plan(folder, "models: [{model: a, center: " + std::string(word) + ", up: Y}]\n");
    EXPECT_TRUE(scene.instances[0].options.centre) << word;
    EXPECT_EQ(scene.instances[0].options.up, Axis::y);
  }
  for (const char* word : {"false", "No", "off"}) {
    const ScenePlan scene =
        plan(folder, "models: [{model: a, centre: " + std::string(word) + "}]\n");
    EXPECT_FALSE(scene.instances[0].options.centre) << word;
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

TEST(SceneFile, MatricesKeepTheirBitsUnlessTheyAreRounded) {
  const Pose exact = pose("matrix: [0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7]");
  EXPECT_EQ(exact.translation(), Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(exact * Eigen::Vector3d::UnitX(), Eigen::Vector3d(5, 7, 7));
  const Pose rounded = pose("matrix: [0.866, -0.5, 0, 0, 0.5, 0.866, 0, 0, 0, 0, 1, 0]");
  EXPECT_TRUE(is_rigid(rounded));
  EXPECT_TRUE(rounded.isApprox(pose("euler_deg: {yaw: 30}"), 1e-4));
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
  EXPECT_EQ(
      plan(folder, "models: [{model: a}]\nsensor: sensors/c.yaml\n").sensors.at(0).sensor.name,
      "far");
  EXPECT_EQ(plan(folder,
                 "models: [{model: a}]\n"
                 "sensor: {name: near, optics: {width: 4, height: 2, fov_deg: 20}}\n")
                .sensors.at(0)
                .sensor.name,
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
  EXPECT_EQ(build_scene(two, std::ref(loader)).scene.meshes.size(), 1U);
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

TEST(SceneFile, MaterialsScaleTheNoiseByNumberAndTexture) {
  const TestFolder folder;
  // 2 x 1 pixels, grey, 8 bits: 64 and 255
  constexpr unsigned char kPng[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
      0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
      0x00, 0xd1, 0x49, 0x20, 0x56, 0x00, 0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78,
      0x9c, 0x63, 0x70, 0xf8, 0x0f, 0x00, 0x01, 0x82, 0x01, 0x40, 0xa9, 0xec, 0xd7, 0x53,
      0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const auto map_file =
      folder.write("t/map.png", std::string(reinterpret_cast<const char*>(kPng), sizeof kPng));
  ASSERT_TRUE(std::filesystem::exists(map_file));
  Loader loader;
  const Scene scene = build_scene(plan(folder, R"(
models:
  - {model: a, materials: {Bus: {noise_scale: 2.5, noise_texture: t/map.png}}}
  - {model: a, materials: {Panels: {noise_texture: t/../t/map.png}}}
)"),
                                  std::ref(loader))
                          .scene;
  const Material& bus = scene.materials[scene.instances[0].materials[0]];
  const Material& panels = scene.materials[scene.instances[1].materials[1]];
  EXPECT_EQ(bus.noise_scale, 2.5F);
  EXPECT_EQ(panels.noise_scale, 1.0F);
  ASSERT_TRUE(bus.noise_texture.used());
  EXPECT_EQ(bus.noise_texture.texture, panels.noise_texture.texture);  // loaded once
  const Texture& map = scene.textures[static_cast<std::size_t>(bus.noise_texture.texture)];
  EXPECT_EQ(map.width, 2U);
  EXPECT_EQ(map.channels, 1U);
  EXPECT_EQ(map.texels, (std::vector<std::uint8_t>{64, 255}));
}

TEST(SceneFile, AMissingNoiseTextureIsToldWithItsPlace) {
  const TestFolder folder;
  Loader loader;
  const std::string error = error_of(folder, [&] {
    build_scene(plan(folder, "models: [{model: a, materials: {Bus: {noise_texture: no.png}}}]\n"),
                std::ref(loader));
  });
  EXPECT_TRUE(error.starts_with(
      "scene.yaml:1:54: models[0].materials.Bus.noise_texture: no.png: no such file"))
      << error;
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

TEST(SetMaterials, ChangesOneInstanceAsASceneFileDoes) {
  Scene scene;
  add_model(scene, load_model("builtin:box", {}, {}));
  scene.instances.push_back(Instance(scene.instances[0]));
  const std::string name = scene.materials[0].name;
  set_materials(scene, 1, R"({"*": {"diffuse": [0.25, 0.5, 1], "mirror": 0.5}})");
  const Material& changed = scene.materials[scene.instances[1].materials[0]];
  EXPECT_EQ(changed.diffuse, Eigen::Vector3f(0.25F, 0.5F, 1.0F));
  EXPECT_EQ(changed.mirror, 0.5F);
  EXPECT_EQ(scene.materials[scene.instances[0].materials[0]].mirror, 0.0F);
  const TestFolder folder;
  EXPECT_EQ(error_of(folder, [&] { set_materials(scene, 1, "{paint: {mirror: 1}}"); }),
            "materials: paint: the model has no material 'paint'; allowed: '" + name +
                "', or '*' for all");
}

TEST(SceneFile, ExampleLoads) {
  const SceneFile file =
      load_scene_file(std::filesystem::path(kSourceFolder) / "examples/two_rocks.yaml", {}, {});
  ASSERT_EQ(file.scene.instances.size(), 3U);
  EXPECT_EQ(file.scene.meshes.size(), 2U);
  EXPECT_EQ(file.scene.instances[0].mesh, file.scene.instances[1].mesh);
  EXPECT_EQ(file.scene.class_names,
            (std::vector<std::string>{"unlabelled", "asteroid", "calibration target"}));
  ASSERT_TRUE(file.sensors.size() == 1 && file.world_from_rig);
  EXPECT_EQ(file.sensors[0].sensor.name, "Woods 2016 camera");
  // The whole scene is in the cone of the camera's 20 degrees.
  const Eigen::AlignedBox3d box = bounds(file.scene);
  const Eigen::Vector3d centre = file.world_from_rig->inverse() * box.center();
  EXPECT_LT((centre.head<2>().norm() + 0.5 * box.diagonal().norm()) / centre.z(),
            std::tan(kPi / 18.0) * 1.3);
}

/// The n-th block of YAML in docs/files.md.
std::string documented(int n) {
  std::ifstream stream(std::filesystem::path(kSourceFolder) / "docs/files.md");
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  const std::string fence = "```yaml\n";
  std::size_t begin = 0;
  for (int i = 0; i <= n; ++i) begin = text.find(fence, begin) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(SceneFile, DocumentedExamplesAreRight) {
  const TestFolder folder;
  (void)folder.write("camera.yaml", documented(0));
  const ScenePlan scene = plan(folder, documented(1));
  EXPECT_EQ(scene.sensors.at(0).sensor.name, "my camera");
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].overrides.size(), 2U);
}

}  // namespace
}  // namespace glidar
