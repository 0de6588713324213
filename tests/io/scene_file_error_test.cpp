// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/scene_plan.hpp>

#include "yaml_files.hpp"

namespace glidar {
namespace {

class SceneFileError : public ::testing::TestWithParam<BadFile> {};

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

const std::string kPoseKeys = "position, orientation, rotation_vector, euler_deg, matrix";

const std::string kFactors = "a number from 1e-15 to 1e15, or its negative, which mirrors";

const BadFile kBadScenes[] = {
    {"NoModels", "sensor: c.yaml\n", "s.yaml:1:1: the key 'models' is missing; add 'models: ...'"},
    {"UnknownTopKey", with_model("sensr: c.yaml"),
     "s.yaml:2:1: sensr: unknown key 'sensr'; allowed: models, sensor, sensor_mode, "
     "sensor_calibration_file, sensor_fire_time_file, sensor_pose, sensor_motion, sensors, "
     "rig_pose, rig_motion, imus, gravity_m_s2, box_classes; did you "
     "mean 'sensor'?"},
    {"SensorBesideSensors", with_model("sensors: [{name: a, sensor: VLP-16}]\nsensor: VLP-16"),
     "s.yaml:3:9: sensor: given beside 'sensors'; allowed: sensors, rig_pose, rig_motion; a rig of "
     "sensors has poses of its own: rig_pose and the 'pose' of each sensor"},
    {"RigPoseWithoutSensors", with_model("rig_pose: {position: [0, 0, 0]}"),
     "s.yaml:2:11: rig_pose: given without 'sensors'; allowed: sensor, sensor_pose, sensor_motion; "
     "list the sensors of the rig: 'sensors: [{name: ..., sensor: ..., pose: ...}]'"},
    {"NoSensors", with_model("sensors: []"),
     "s.yaml:2:10: sensors: an empty list; allowed: 1 to 256 sensors"},
    {"SensorsIsAName", with_model("sensors: VLP-16"),
     "s.yaml:2:10: sensors: 'VLP-16'; allowed: a list"},
    {"RigSensorWithoutName", with_model("sensors: [{sensor: VLP-16}]"),
     "s.yaml:2:11: sensors[0]: the key 'name' is missing; add 'name: ...'"},
    {"RigSensorWithAFolder", with_model("sensors: [{name: a/b, sensor: VLP-16}]"),
     "s.yaml:2:18: sensors[0].name: 'a/b'; allowed: up to 31 letters, digits, - and _; files and "
     "topics are named by it"},
    {"RigSensorTwice",
     with_model("sensors: [{name: a, sensor: VLP-16}, {name: a, sensor: VLP-16}]"),
     "s.yaml:2:45: sensors[1].name: the name 'a' is given twice; allowed: each name once; choose "
     "another name"},
    {"RigSensorUnknownKey", with_model("sensors: [{name: a, sensor: VLP-16, poes: {}}]"),
     "s.yaml:2:37: sensors[0].poes: unknown key 'poes'; allowed: name, sensor, mode, "
     "calibration_file, fire_time_file, pose; did you mean 'pose'?"},
    {"RigMotionWithoutStart",
     with_model(
         "sensors: [{name: a, sensor: VLP-16}]\nrig_motion: {spin: {rate_deg_s: [0, 0, 1]}}"),
     "s.yaml:3:13: rig_motion: the pose at which it starts is missing; add 'rig_pose: ...' beside "
     "rig_motion"},
    {"ModelsIsAMap", "models: {model: a}\n", "s.yaml:1:9: models: a map; allowed: a list"},
    {"ModelsIsEmpty", "models: []\n",
     "s.yaml:1:9: models: an empty list; allowed: at least one model"},
    {"ModelsHasNoValue", "models:\n", "s.yaml:1:1: models: no value; allowed: a list"},
    {"ModelIsAWord", "models: [rock.obj]\n",
     "s.yaml:1:10: models[0]: 'rock.obj'; allowed: a map (key: value)"},
    {"ModelWithoutFile", "models:\n  - {model: a}\n  - {name: b}\n",
     "s.yaml:3:5: models[1]: the key 'model' is missing; add 'model: ...'"},
    {"UnknownModelKey", model("scal: 2"),
     "s.yaml:3:5: models[0].scal: unknown key 'scal'; allowed: model, name, unit, up, centre, "
     "texture_folder, size, radius, tube_radius, scale, pose, id, class, materials, split, parts, "
     "visible_to, hidden_from, poses, motion; did you mean 'scale'?"},
    {"UnknownUnit", model("unit: inch"),
     "s.yaml:3:11: models[0].unit: 'inch'; allowed: mm, cm, m, in, ft; did you mean 'in'?"},
    {"WordOfOtherPrograms", model("label: car"),
     "s.yaml:3:5: models[0].label: unknown key 'label'; allowed: model, name, unit, up, centre, "
     "texture_folder, size, radius, tube_radius, scale, pose, id, class, materials, split, parts, "
     "visible_to, hidden_from, poses, motion; did you mean 'class'?"},
    {"TextForAList", model("pose: {position: \"1, 2, 3\"}"),
     "s.yaml:3:22: models[0].pose.position: the text \"1, 2, 3\"; allowed: a list of 3 numbers; "
     "write [1, 2, 3]"},
    {"OneKeyInTwoSpellings", model("center: yes\n    centre: no"),
     "s.yaml:4:5: models[0].centre: the key is given twice; allowed: each key once; remove one of "
     "them"},
    {"UnknownAxis", model("up: w"), "s.yaml:3:9: models[0].up: 'w'; allowed: x, y, z"},
    {"ScaleZero", model("scale: 0"),
     "s.yaml:3:12: models[0].scale: a factor of 0, or nearly; allowed: " + kFactors},
    {"ScaleOfTwo", model("scale: [1, 2]"),
     "s.yaml:3:12: models[0].scale: a list of 2; allowed: a list of 3 numbers"},
    {"ScaleNanAlongOneAxis", model("scale: [1, 1, .nan]"),
     "s.yaml:3:19: models[0].scale[2]: .nan; allowed: " + kFactors},
    {"EulerWithoutItsUnit", model("pose: {euler: {yaw: 1}}"),
     "s.yaml:3:12: models[0].pose.euler: unknown key 'euler'; allowed: " + kPoseKeys +
         "; did you mean 'euler_deg'?"},
    {"ScaleNan", model("scale: .nan"), "s.yaml:3:12: models[0].scale: .nan; allowed: " + kFactors},
    {"ScaleBeyondReach", model("scale: 1e300"),
     "s.yaml:3:12: models[0].scale: 1e300; allowed: " + kFactors},
    {"PositionBeyondReach", model("pose: {position: [1, 2, 1e300]}"),
     "s.yaml:3:29: models[0].pose.position[2]: 1e300; allowed: a number from -1e15 to 1e15"},
    {"ClassEmpty", model("class: \"\""),
     "s.yaml:3:12: models[0].class: the text \"\"; allowed: a text that is not empty"},
    {"ClassWithoutValue", model("class:"),
     "s.yaml:3:5: models[0].class: no value; allowed: a text that is not empty"},
    {"NameEmpty", model("name: ''"),
     "s.yaml:3:11: models[0].name: the text \"\"; allowed: a text that is not empty"},
    {"FileEmpty", "models:\n  - model: \"\"\n",
     "s.yaml:2:12: models[0].model: the text \"\"; allowed: a text that is not empty"},
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
     "s.yaml:3:29: models[0].pose.position[2]: .inf; allowed: a number from -1e15 to 1e15"},
    {"PositionNamed", model("pose: {position: {x: 1, y: 2, z: 3}}"),
     "s.yaml:3:22: models[0].pose.position: a map; allowed: a list of 3 numbers"},
    {"PoseUnknownKey", model("pose: {orientaton: {}}"),
     "s.yaml:3:12: models[0].pose.orientaton: unknown key 'orientaton'; allowed: " + kPoseKeys +
         "; did you mean 'orientation'?"},
    {"TwoRotations", model("pose: {orientation: {w: 1, x: 0, y: 0, z: 0}, euler_deg: {yaw: 1}}"),
     "s.yaml:3:62: models[0].pose.euler_deg: given beside 'orientation'; allowed: one of "
     "orientation, rotation_vector, euler_deg; remove one of them"},
    {"MatrixBesidePosition", model("pose: {position: [0, 0, 1], matrix: [1]}"),
     "s.yaml:3:41: models[0].pose.matrix: given beside 'position'; allowed: matrix alone, or a "
     "position and a rotation; remove one of them"},
    {"MatrixOfFourRows", model("pose: {matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"),
     "s.yaml:3:20: models[0].pose.matrix: a list of 16; allowed: a list of 12 numbers"},
    {"MatrixMirrors", model("pose: {matrix: [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, -1, 7]}"),
     "s.yaml:3:20: models[0].pose.matrix: not a rotation; allowed: a rotation within 0.001, with "
     "its position"},
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
     "specular, shininess, opacity, noise_scale, noise_texture, surface, backscatter, mirror, "
     "spectrum; "
     "did you "
     "mean 'diffuse'?"},
    {"TwoMotions", model("motion: {spin: {rate_rad_s: [0, 0, 1]}, trajectory: t.tum}"),
     "s.yaml:3:57: models[0].motion.trajectory: given beside 'spin'; allowed: one of spin, twist, "
     "tumbling, trajectory; remove one of them"},
    {"NoMotion", model("motion: {}"),
     "s.yaml:3:13: models[0].motion: the kind of motion is missing; allowed: one of spin, twist, "
     "tumbling, trajectory; add 'spin: ...', for example"},
    {"TrajectoryIsAList", model("motion: {trajectory: [t.tum]}"),
     "s.yaml:3:26: models[0].motion.trajectory: a list of 1; allowed: a map, or the path of a "
     "trajectory file"},
    {"TrajectoryUnknownKey", model("motion: {trajectory: {file: t.tum, rate: 1}}"),
     "s.yaml:3:40: models[0].motion.trajectory.rate: unknown key 'rate'; allowed: file, rate_hz, "
     "times, start_s, interpolation; did you mean 'rate_hz'?"},
    {"SizeIsAMap", model("size: {x: 1}"),
     "s.yaml:3:11: models[0].size: a map; allowed: a number, or a list of 3"},
    {"SpinWithoutRate", model("motion: {spin: {}}"),
     "s.yaml:3:20: models[0].motion.spin: the rate is missing; allowed: one of rate_rad_s, "
     "rate_deg_s; "
     "add 'rate_rad_s: [0, 0, 0.1]'"},
    {"SpinInTwoUnits", model("motion: {spin: {rate_rad_s: [0, 0, 1], rate_deg_s: [0, 0, 1]}}"),
     "s.yaml:3:56: models[0].motion.spin.rate_deg_s: given beside 'rate_rad_s'; allowed: one of "
     "rate_rad_s, rate_deg_s; remove one of them"},
    {"TwistInAnotherFrame", model("motion: {twist: {frame: wrld}}"),
     "s.yaml:3:29: models[0].motion.twist.frame: 'wrld'; allowed: body, world; did you mean "
     "'world'?"},
    {"TumblingLikeNoBody",
     model("motion: {tumbling: {moments_kg_m2: [1, 1, 3], rate_rad_s: [0, 0, 1]}}"),
     "s.yaml:3:40: models[0].motion.tumbling.moments_kg_m2: one exceeds the sum of the other "
     "two; allowed: moments of a rigid body: none above the sum of the other two"},
    {"TrajectoryBesidePose", model("pose: {}\n    motion: {trajectory: t.tum}"),
     "s.yaml:4:26: models[0].motion.trajectory: given beside a pose; allowed: a pose, or a "
     "trajectory, which gives the poses itself; remove one of them"},
    {"TrajectoryIsMissing", model("motion: {trajectory: t.tum}"),
     "s.yaml:3:26: models[0].motion.trajectory: no such file: t.tum; allowed: the path of a "
     "trajectory file; paths are relative to the folder of this file"},
    {"SensorMotionWithoutStart", with_model("sensor_motion: {spin: {rate_deg_s: [0, 0, 1]}}"),
     "s.yaml:2:16: sensor_motion: the pose at which it starts is missing; add 'sensor_pose: ...' "
     "beside sensor_motion"},
    {"SensorIsAList", with_model("sensor: [a]"),
     "s.yaml:2:9: sensor: a list of 1; allowed: a map, or the path of a sensor file"},
    {"SensorFileIsMissing", with_model("sensor: c.yaml"),
     "s.yaml:2:9: sensor: no such file: c.yaml; allowed: a map, or the path of a sensor file; "
     "paths are relative to the folder of this file"},
    {"SensorInTheSceneIsWrong", with_model("sensor: {optics: {widht: 3}}"),
     "s.yaml:2:19: sensor.optics.widht: unknown key 'widht'; allowed: type, "
     "calibration_file, width, height, fov_deg, fov_x_deg, fx, fy, cx, cy, pixel_centre, skew, "
     "distortion; did you mean 'width'?"},
    {"LookAtBesidePosition",
     with_model("sensor_pose: {position: [0, 0, 0], look_at: {eye: [0, 0, 0], target: [1, 0, 0]}}"),
     "s.yaml:2:45: sensor_pose.look_at: given beside 'position'; allowed: look_at alone, or a "
     "position and a rotation; remove one of them"},
    {"LookAtFromBeyondReach",
     with_model("sensor_pose: {look_at: {eye: [1e16, 0, 0], target: [0, 0, 0]}}"),
     "s.yaml:2:31: sensor_pose.look_at.eye[0]: 1e16; allowed: a number from -1e15 to 1e15"},
    {"LookAtNothing", with_model("sensor_pose: {look_at: {eye: [1, 0, 0], target: [1, 0, 0]}}"),
     "s.yaml:2:24: sensor_pose.look_at: eye and target are the same point; allowed: two distinct "
     "points"},
    {"LookAtAlongUp",
     with_model("sensor_pose: {look_at: {eye: [0, 0, 5], target: [0, 0, 0], up: [0, 0, 2]}}"),
     "s.yaml:2:24: sensor_pose.look_at: the up vector is parallel to the line of sight; allowed: "
     "an up vector in another direction; choose another up vector"},
    {"LookAtWithoutTarget", with_model("sensor_pose: {look_at: {eye: [0, 0, 5]}}"),
     "s.yaml:2:24: sensor_pose.look_at: the key 'target' is missing; add 'target: ...'"},
};

INSTANTIATE_TEST_SUITE_P(All, SceneFileError, ::testing::ValuesIn(kBadScenes), bad_file_name);

TEST(SceneFileErrors, ErrorsInTheSensorFileNameThatFileAndWhereTheSceneNamesIt) {
  const TestFolder folder;
  (void)folder.write("c.yaml", "optics:\n  width: 0\n");
  const auto file = folder.write("s.yaml", with_model("sensor: c.yaml"));
  EXPECT_EQ(error_of(folder, [&] { read_scene_plan(file, {}); }),
            "s.yaml:2:9: sensor: c.yaml:2:10: optics.width: 0; allowed: a whole number from 1 to "
            "65536");
}

std::string sensor_error(const std::string& name) {
  const TestFolder folder;
  (void)folder.write("camera.yaml", "optics: {width: 5, height: 4, fov_deg: 30}\n");
  const auto file = folder.write("s.yaml", with_model("sensor: " + name));
  return error_of(folder, [&] { read_scene_plan(file, {}); });
}

TEST(SceneFileErrors, SensorsThatAreNotThereAreReportedWithTheirPlaceInTheScene) {
  const std::string preset = sensor_error("VLP-17");
  EXPECT_TRUE(preset.starts_with("s.yaml:2:9: sensor: 'VLP-17' is neither a file nor the name"))
      << preset;
  EXPECT_TRUE(preset.ends_with("did you mean VLP-16?")) << preset;
  EXPECT_EQ(sensor_error("camra.yaml"),
            "s.yaml:2:9: sensor: no such file: camra.yaml; allowed: a map, or the path of a sensor "
            "file; did you mean 'camera.yaml'?");
}

TEST(SceneFileErrors, ModesThatDoNotFitTheSensorAreReportedWithTheirPlace) {
  EXPECT_EQ(sensor_error("OS1-32\nsensor_mode: 512x21"),
            "s.yaml:3:14: sensor_mode: '512x21' is no mode of Ouster OS1-32; allowed: 512x10, "
            "1024x10, 2048x10, 512x20, 1024x20; did you mean '512x20'?");
  EXPECT_EQ(sensor_error("camera.yaml\nsensor_mode: a"),
            "s.yaml:3:14: sensor_mode: 'a', but camera.yaml has no modes; allowed: a sensor with "
            "modes; leave the mode out");
  EXPECT_EQ(sensor_error("{optics: {width: 4, height: 3, fov_deg: 9}}\nsensor_mode: a"),
            "s.yaml:3:14: sensor_mode: a mode, but the sensor is a map; allowed: a mode of a "
            "preset or sensor file; leave the mode out");
  EXPECT_EQ(sensor_error("{optics: {width: 4, height: 3, fov_deg: 9}, modes: {a: {}}}"),
            "s.yaml:2:60: sensor.modes: a family of sensors inside another file; allowed: a "
            "sensor file of its own; write it to a file, and name the file here");
  const TestFolder folder;
  const auto file = folder.write("s.yaml", with_model("sensor_mode: a"));
  EXPECT_EQ(error_of(folder, [&] { read_scene_plan(file, {}); }),
            "s.yaml:2:14: sensor_mode: given without 'sensor'; allowed: together with a sensor; "
            "add the sensor");
}

TEST(SceneFileErrors, CalibrationsThatDoNotFitAreReportedWithBothPlaces) {
  const TestFolder folder;
  (void)folder.write("c.csv", "Channel,Elevation,Azimuth\n1,3,0\n2,up,0\n");
  (void)folder.write("d.csv", "Channel,Elevation,Azimuth\n1,3,0\n2,4,0\n");
  const auto error = [&](const std::string& rest) {
    const auto file = folder.write("s.yaml", with_model(rest));
    return error_of(folder, [&] { read_scene_plan(file, {}); });
  };
  const std::string cell = "c.csv:3: 'up'; allowed: degrees from -90 to 90";
  const std::string two = "optics: {type: spinning, columns_per_turn: 8, elevation_deg: [1, 2]";
  EXPECT_EQ(error("sensors: [{name: a, sensor: {" + two + "}}, calibration_file: c.csv}]"),
            "s.yaml:2:119: sensors[0].calibration_file: " + cell);
  EXPECT_EQ(error("sensor: {" + two + ", calibration_file: c.csv}}"),
            "s.yaml:2:97: sensor.optics.calibration_file: " + cell);
  EXPECT_EQ(error("sensor: VLP-16\nsensor_calibration_file: d.csv"),
            "s.yaml:3:26: sensor_calibration_file: d.csv: 2 channels; allowed: 16, as the sensor; "
            "use the calibration of this sensor, or the sensor's preset");
  EXPECT_EQ(error("sensor: VLP-16\nsensor_fire_time_file: no.csv").substr(0, 51),
            "s.yaml:3:24: sensor_fire_time_file: no.csv: no such");
  EXPECT_EQ(error("sensor_calibration_file: d.csv"),
            "s.yaml:2:26: sensor_calibration_file: given without 'sensor'; allowed: together with "
            "a sensor; add the sensor");
}

TEST(SceneFileErrors, WrongSizesOfBuiltInModelsAreReportedWithTheirPlace) {
  const TestFolder folder;
  const auto error = [&](const std::string& content) {
    const auto file = folder.write("s.yaml", content);
    return error_of(folder, [&] { load_scene_file(file, {}, {}); });
  };
  EXPECT_EQ(error("models: [{model: 'builtin:box', radius: 2}]\n"),
            "s.yaml:1:18: models[0].model: builtin:box:radius=2: 'radius' is not a size of this "
            "model; allowed: size");
  EXPECT_EQ(error("models: [{model: 'builtin:box', size: [1, 2]}]\n"),
            "s.yaml:1:18: models[0].model: builtin:box:size=1,2: 2 numbers; allowed: one number, "
            "or 3");
  EXPECT_EQ(error("models: [{model: 'builtin:sphere', radius: -1}]\n"),
            "s.yaml:1:44: models[0].radius: -1; allowed: metres above 0 and below 1e15");
  EXPECT_EQ(
      error("models: [{model: a.ply, size: 2}]\n"),
      "s.yaml:1:31: models[0].size: given for a model file; allowed: sizes of built-in models "
      "alone; change the size of a model file with 'scale' or 'unit'");
}

}  // namespace
}  // namespace glidar
