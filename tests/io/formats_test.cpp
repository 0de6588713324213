// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// Exact bytes of small files and error texts; tests/io/readers checks every number of every format.
#include <glidar/core/error.hpp>
#include <glidar/core/version.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cstring>

namespace glidar {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Two points, the second a miss, with x y z and intensity, in a frame that is the sensor's.
CloudFixture two_points() {
  CloudFixture made = make_fixture(1, 2);
  for (const char* name : {"depth", "normal", "colour", "instance", "ring", "status"})
    drop_column(made.cloud, name);
  made.cloud.columns[0].values =
      std::vector<double>{0.5, -1.25, 3.0, std::nan(""), -std::nan(""), std::nan("")};
  made.cloud.columns[1].values = std::vector<float>{0.1F, 0.0F};
  made.cloud.world_from_cloud = made.frame.world_from_sensor;
  made.cloud.frame_id = "my\nframe";
  return made;
}

std::string written(const CloudFixture& made, const char* name,
                    const FileSinkOptions& options = {}) {
  const testing::TestFolder folder;
  write_cloud(made, folder / name, options);
  return file_bytes(folder / name);
}

std::string write_error(const CloudFixture& made, const char* name) {
  return error_text([&] { written(made, name); });
}

std::string pcd_head(const char* data) {
  return std::string("# .PCD v0.7 - Point Cloud Data file format\n# glidar ") + version() +
         ", metres in the frame my?frame\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\n"
         "TYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS "
         "2\nDATA " +
         data + "\n";
}

TEST(PcdFile, AsciiHasTheExpectedText) {
  FileSinkOptions options;
  options.pcd = PcdEncoding::ascii;
  EXPECT_EQ(written(two_points(), "a.pcd", options),
            pcd_head("ascii") + "0.5 -1.25 3 0.1\nnan nan nan 0\n");
}

TEST(PcdFile, BinaryHasFloatsPointByPoint) {
  const std::string found = written(two_points(), "a.pcd");
  const std::string head = pcd_head("binary");
  ASSERT_EQ(found.size(), head.size() + 32);
  EXPECT_THAT(found, StartsWith(head));
  float numbers[8];
  std::memcpy(numbers, found.data() + head.size(), sizeof(numbers));
  EXPECT_EQ(numbers[0], 0.5F);
  EXPECT_EQ(numbers[1], -1.25F);
  EXPECT_EQ(numbers[2], 3.0F);
  EXPECT_EQ(numbers[3], 0.1F);
  EXPECT_TRUE(std::isnan(numbers[4]) && std::isnan(numbers[5]) && std::isnan(numbers[6]));
  EXPECT_EQ(numbers[7], 0.0F);
}

TEST(PcdFile, TheViewpointIsTheSensorInTheCloudsFrame) {
  CloudFixture made = two_points();
  made.cloud.world_from_cloud = Pose::Identity();
  EXPECT_THAT(written(made, "a.pcd"), HasSubstr("VIEWPOINT 1 2 3 0.5 0.5 -0.5 0.5\n"));
}

TEST(PcdFile, CompressedDoesNotGrowMuchOnNoise) {
  CloudFixture made = make_fixture(100, 100);
  std::uint32_t state = 1;
  for (float& value : std::get<std::vector<float>>(made.cloud.columns[1].values)) {
    state = state * 1664525U + 1013904223U;
    value = std::bit_cast<float>(state & 0xFF7FFFFFU);
  }
  made.cloud.columns.resize(2);
  FileSinkOptions options;
  options.pcd = PcdEncoding::binary_compressed;
  const std::size_t binary = written(made, "a.pcd").size();
  EXPECT_LT(written(made, "a.pcd", options).size(), binary + binary / 16);
}

TEST(PcdFile, LargeCoordinatesStayFloatForAllReaders) {
  CloudFixture made = make_fixture(1, 2);
  for (const char* name : {"normal", "colour", "instance", "ring", "status"})
    drop_column(made.cloud, name);
  std::get<std::vector<double>>(made.cloud.columns[2].values)[0] = 2048.1;
  EXPECT_THAT(written(made, "a.pcd"), HasSubstr("FIELDS x y z intensity depth\nSIZE 4 4 4 4 4\n"));
}

TEST(PlyFile, AsciiHasTheExpectedText) {
  FileSinkOptions options;
  options.ply_ascii = true;
  EXPECT_EQ(written(two_points(), "a.ply", options),
            std::string("ply\nformat ascii 1.0\ncomment glidar ") + version() +
                ", metres in the frame my?frame\nelement vertex 2\nproperty float x\n"
                "property float y\nproperty float z\nproperty float intensity\nend_header\n"
                "0.5 -1.25 3 0.1\nnan nan nan 0\n");
}

TEST(PlyFile, FarCoordinatesAreDouble) {
  CloudFixture made = two_points();
  auto& xyz = std::get<std::vector<double>>(made.cloud.columns[0].values);
  xyz[1] = -2047.9;
  EXPECT_THAT(written(made, "a.ply"), HasSubstr("property float x\n"));
  xyz[1] = -2048.1;
  EXPECT_THAT(written(made, "a.ply"),
              AllOf(HasSubstr("property double x\n"), HasSubstr("property float intensity\n")));
}

TEST(CsvFile, KeepsEveryDigitAndHasAHeader) {
  CloudFixture made = two_points();
  std::get<std::vector<double>>(made.cloud.columns[0].values)[0] = 1.0 / 3.0;
  EXPECT_EQ(written(made, "a.csv"),
            "x,y,z,intensity\n0.3333333333333333,-1.25,3,0.1\nnan,nan,nan,0\n");
}

TEST(KittiFile, AlwaysOmitsMisses) {
  const std::string found = written(two_points(), "a.bin");
  ASSERT_EQ(found.size(), 16U);
  float numbers[4];
  std::memcpy(numbers, found.data(), sizeof(numbers));
  EXPECT_EQ(numbers[1], -1.25F);
  EXPECT_EQ(numbers[3], 0.1F);
}

/// The intensity that a.bin has for a sensor's intensity and a range of 10 m.
float kitti_intensity(const Sensor& sensor, float intensity) {
  CloudFixture made = two_points();
  made.sensor = sensor;
  std::get<std::vector<float>>(made.cloud.columns[1].values)[0] = intensity;
  made.cloud.columns.push_back({"range", {"range"}, std::vector<double>{10.0, std::nan("")}});
  float numbers[4];
  const std::string found = written(made, "a.bin");
  EXPECT_EQ(found.size(), sizeof(numbers));
  std::memcpy(numbers, found.data(), sizeof(numbers));
  return numbers[3];
}

TEST(KittiFile, IntensityIsFromZeroToOneForEverySensor) {
  Sensor plain;
  EXPECT_EQ(kitti_intensity(plain, 0.5F), 0.5F);
  EXPECT_EQ(kitti_intensity(plain, 1.5F), 1.0F);
  Sensor vendor;
  vendor.noise = {IntensityScale{.kind = IntensityScale::Kind::vendor}};
  EXPECT_EQ(kitti_intensity(vendor, 51.0F), 0.2F);
  // A white diffuse surface at R_ref = 100 m, of reference reflectance 0.5, sends 2 back; at 10 m
  // 100 times that: 200 is reflectivity 1, which Velodynes report as 100 of 255.
  Sensor pulsed;
  pulsed.lidar_equation = LidarEquation{.reference_reflectance = 0.5, .reference_range_m = 100.0};
  EXPECT_FLOAT_EQ(kitti_intensity(pulsed, 200.0F), 100.0F / 255.0F);
  EXPECT_FLOAT_EQ(kitti_intensity(pulsed, 20.0F), 10.0F / 255.0F);
  EXPECT_EQ(kitti_intensity(pulsed, 1e9F), 1.0F);
}

TEST(KittiFile, ClassesNeedTheColumnsOfLabels) {
  CloudFixture made = two_points();
  made.scene.class_names.emplace_back("rock");
  made.scene.instances.front().class_id = 1;
  EXPECT_THAT(error_text([&] { written(made, "a.bin"); }),
              HasSubstr("the cloud has no column instance"));
}

TEST(DepthNpy, HasNumPysHeaderPaddedTo64Bytes) {
  const std::string found = written(make_fixture(), "a.npy");
  EXPECT_THAT(found, StartsWith("\x93NUMPY\x01"));
  EXPECT_THAT(found, HasSubstr("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 5, ), }"));
  EXPECT_EQ((found.size() - 4 * 20) % 64, 0U);
}

TEST(DepthPng, ADepthOutOfRangeIsAnErrorWithASuitableScale) {
  CloudFixture made = make_fixture();
  auto& depths_m = std::get<std::vector<double>>(made.cloud.columns[2].values);
  depths_m[0] = 65.535;
  EXPECT_EQ(write_error(made, "a.depth.png"), "no error");
  depths_m[0] = 80.0;
  EXPECT_THAT(
      write_error(made, "a.depth.png"),
      AllOf(HasSubstr("the largest depth, 80 m, does not fit 16 bits at 1000 units per metre"),
            HasSubstr("up to 65.535 m"), HasSubstr("use 810 units per metre")));
  depths_m[0] = -2.0;
  EXPECT_THAT(write_error(made, "a.depth.png"), HasSubstr("a depth of -2 m, behind the sensor"));
}

TEST(Woods2016Png, RejectsFramesOfOtherRenderTargets) {
  CloudFixture made = make_fixture();
  made.frame.framebuffer.rgba.clear();
  EXPECT_THAT(write_error(made, "a.framebuffer.png"),
              HasSubstr("a frame without a quantized framebuffer; allowed: a frame of "
                        "--quantized-framebuffer"));
}

TEST(TransformFile, IsTheFirstObjectInTheCloudsFrameWithoutScale) {
  CloudFixture made = make_fixture();
  made.cloud.world_from_cloud = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0));
  EXPECT_EQ(written(made, "a.transform"), "-1 0 0 9\n0 1 0 2\n0 0 -1 3\n0 0 0 1\n");
  made.frame.world_from_instance[0].translation().x() = 1.1;
  EXPECT_THAT(written(made, "a.transform"), HasSubstr("-1 0 0 0.10000000000000009\n"));
}

TEST(TransformFile, NeedsAnObject) {
  CloudFixture made = make_fixture();
  made.frame.world_from_instance.clear();
  EXPECT_THAT(write_error(made, "a.transform"), HasSubstr("the scene has no object"));
}

nlohmann::json sidecar_of(const CloudFixture& made, const std::string& name = "a.pcd") {
  const testing::TestFolder folder;
  write_cloud(made, folder / name);
  return nlohmann::json::parse(file_bytes(sidecar_path(folder / name)));
}

TEST(Sidecar, ContainsSensorPosesSeedModelAndCounts) {
  CloudFixture made = make_fixture();
  Pinhole pinhole;
  pinhole.intrinsics.fx = 123.25;
  pinhole.distortion = RadialTangential{.k1 = 0.125, .k6 = -2.0};
  made.sensor.optics = pinhole;
  made.sensor.name = "bad \xFF utf-8 \"quoted\"\n";
  const nlohmann::json reported = sidecar_of(made);
  EXPECT_EQ(reported.at("glidar"), version());
  EXPECT_EQ(reported.at("renderer"), "rays");
  EXPECT_EQ(reported.at("seed"), made.frame.seed);
  EXPECT_EQ(reported.at("stamp_ns"), made.frame.stamp_ns);
  EXPECT_EQ(reported.at("sensor").at("optics").at("fx"), 123.25);
  EXPECT_EQ(reported.at("sensor").at("optics").at("distortion").at("model"), "radial_tangential");
  EXPECT_EQ(reported.at("sensor").at("optics").at("distortion").at("k6"), -2.0);
  EXPECT_TRUE(reported.at("sensor").at("limits").at("far_m").is_null());
  EXPECT_EQ(reported.at("world_from_sensor").at("position_m"), nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(reported.at("world_from_sensor").at("orientation").at("y"), -0.5);
  EXPECT_EQ(reported.at("world_from_sensor").at("matrix").at(0),
            nlohmann::json({0.0, -1.0, 0.0, 1.0}));
  EXPECT_EQ(reported.at("files").at(0).at("frame_id"), "map");
  EXPECT_EQ(
      reported.at("files").at(0).at("columns").at(0),
      nlohmann::json::parse(R"({"name": "xyz", "type": "f32", "components": ["x", "y", "z"]})"));
  EXPECT_EQ(reported.at("instances").at(0).at("model_hash"), "0123abcd");
  EXPECT_EQ(reported.at("instances").at(0).at("scale"), 2.5);
  EXPECT_EQ(reported.at("instances").at(0).at("class"), "unlabelled");
  EXPECT_EQ(reported.at("beams_by_status").at("hit"), 14);
  EXPECT_EQ(reported.at("beams_by_status").at("miss"), 6);
}

// readers_test.py compares the columns of every sidecar with the header of the file beside it.
TEST(Sidecar, ListsOnlyColumnsOfTheFile) {
  EXPECT_EQ(sidecar_of(make_fixture(), "a.bin").at("files").at(0).at("columns"),
            nlohmann::json::parse(R"([
    {"name": "xyz", "type": "f32", "components": ["x", "y", "z"]},
    {"name": "intensity", "type": "f32", "components": ["intensity"]}])"));
}

TEST(Sidecar, ListsNamesAndTypesAsStoredInTheFile) {
  const auto column = [](const char* file, std::size_t i) {
    const nlohmann::json reported =
        sidecar_of(make_fixture(), file).at("files").at(0).at("columns").at(i);
    return reported.at("type").get<std::string>() + " " + reported.at("components").dump();
  };
  EXPECT_EQ(column("a.pcd", 2), R"(f32 ["depth"])");
  EXPECT_EQ(column("a.pcd", 4), R"(packed_rgb ["rgb"])");
  EXPECT_EQ(column("a.ply", 3), R"(f32 ["nx","ny","nz"])");
  EXPECT_EQ(column("a.ply", 4), R"(u8 ["red","green","blue"])");
  EXPECT_EQ(column("a.npz", 0), R"(f64 ["x","y","z"])");
  EXPECT_EQ(column("a.csv", 6), R"(u16 ["ring"])");
}

TEST(Sidecar, ContainsOnlyValidJson) {
  CloudFixture made = make_fixture();
  made.sensor.light.ambient = std::nan("");
  const testing::TestFolder folder;
  write_cloud(made, folder / "a.npz");
  const std::string text = file_bytes(folder / "a.glidar.json");
  EXPECT_TRUE(nlohmann::json::accept(text));
  EXPECT_THAT(text, Not(ContainsRegex("[^a-z_\"](nan|inf)")));  // "camera_info" may stay
}

}  // namespace
}  // namespace glidar
