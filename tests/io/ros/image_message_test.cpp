// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/sensor_topics.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/pictures/picture.hpp>
#include <glidar/io/ros/pose_message.hpp>
#include <glidar/math/constants.hpp>

#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace glidar::ros {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;

struct Measured {
  Sensor sensor;
  Beams beams;
  Frame frame;
  [[nodiscard]] CloudSource source() const { return {frame, sensor, beams}; }
};

Measured measured(Optics optics, double rate_hz = 30.0) {
  Measured made;
  made.sensor.optics = std::move(optics);
  made.sensor.rate_hz = rate_hz;
  made.beams = make_beams(made.sensor);
  Frame& frame = made.frame;
  frame.frame_id = "camera_optical_frame";
  frame.stamp_ns = 5'000'000'000;
  const std::size_t count = made.beams.size();
  frame.range_m.assign(count, 2.0);
  frame.intensity.assign(count, 0.5F);
  frame.status.assign(count, Status::hit);
  return made;
}

Measured camera() {
  return measured(pinhole_from_fov(3, 2, 1.0));
}

void invalidate(Measured& made, std::size_t beam, Status why) {
  made.frame.range_m[beam] = kNaN;
  made.frame.status[beam] = why;
  made.frame.intensity[beam] = 0.0F;
}

template <class Number>
std::vector<Number> pixels(const Image& image) {
  const std::vector<std::byte> bytes = image.data.to_vector();
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

TEST(DepthImage, IsMillimetresOrMetresAlongTheBoresight) {
  Measured made = camera();
  invalidate(made, 4, Status::miss);
  const Image in_mm = depth_image(made.source(), DepthEncoding::millimetres_16uc1);
  EXPECT_EQ(in_mm.encoding, "16UC1");
  EXPECT_EQ(in_mm.step, 6U);
  EXPECT_EQ(in_mm.header.frame_id, "camera_optical_frame");
  EXPECT_EQ(to_ns(in_mm.header.stamp), 5'000'000'000);
  const double depth = 2.0 * made.beams.directions[0].z();
  EXPECT_EQ(pixels<std::uint16_t>(in_mm)[0], std::lround(depth * 1e3));
  EXPECT_EQ(pixels<std::uint16_t>(in_mm)[4], 0);
  const Image in_m = depth_image(made.source(), DepthEncoding::metres_32fc1, "optical");
  EXPECT_EQ(in_m.encoding, "32FC1");
  EXPECT_EQ(in_m.header.frame_id, "optical");
  EXPECT_FLOAT_EQ(pixels<float>(in_m)[0], static_cast<float>(depth));
  EXPECT_TRUE(std::isnan(pixels<float>(in_m)[4]));
}

TEST(DepthImage, DepthsBeyond16BitsAreUnknown) {
  Measured made = camera();
  made.frame.range_m[0] = 100.0;
  made.frame.range_m[1] = 1e-5;
  const auto depths =
      pixels<std::uint16_t>(depth_image(made.source(), DepthEncoding::millimetres_16uc1));
  EXPECT_EQ(depths[0], 0);
  EXPECT_EQ(depths[1], 1);  // 0 would mean no return
}

TEST(DepthImage, OfACameraThatLooksBackHasRanges) {
  Pinhole panorama = pinhole_from_fov(8, 4, 1.0);
  panorama.intrinsics.fx = panorama.intrinsics.fy = 8 / kTwoPi;
  panorama.distortion = Equirectangular{};
  Measured made = measured(panorama);
  invalidate(made, 3, Status::miss);
  const Image in_mm = depth_image(made.source(), DepthEncoding::millimetres_16uc1);
  const Image in_m = depth_image(made.source(), DepthEncoding::metres_32fc1);
  for (std::size_t i = 0; i < 32; ++i) {
    EXPECT_EQ(pixels<std::uint16_t>(in_mm)[i], i == 3 ? 0 : 2000) << i;
    if (i == 3) continue;
    EXPECT_EQ(pixels<float>(in_m)[i], 2.0F) << i;
  }
}

TEST(IntensityImage, IsBytesOrTheIntensityItself) {
  const Measured made = camera();
  EXPECT_THAT(pixels<std::uint8_t>(intensity_image(made.source(), IntensityEncoding::mono8)),
              Each(128));
  EXPECT_THAT(pixels<float>(intensity_image(made.source(), IntensityEncoding::f32c1)), Each(0.5F));
}

TEST(CompressedImage, IsAPng) {
  const Measured made = camera();
  const CompressedImage image = png_image(intensity_image(made.source(), IntensityEncoding::mono8));
  EXPECT_EQ(image.format, "mono8; png compressed ");
  const auto bytes = image.data.bytes();
  ASSERT_GT(bytes.size(), 8U);
  EXPECT_EQ(std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8), 0);
  EXPECT_THAT(
      error_text([&] { png_image(intensity_image(made.source(), IntensityEncoding::f32c1)); }),
      HasSubstr("mono8 or 16UC1"));
}

TEST(CompressedImage, OfDepthIsAPngBehindAHeader) {
  const Measured made = camera();
  const Image depth = depth_image(made.source(), DepthEncoding::millimetres_16uc1);
  const CompressedImage image = compressed_depth_image(depth);
  EXPECT_EQ(image.format, "16UC1; compressedDepth png");
  const auto bytes = image.data.bytes();
  ASSERT_GT(bytes.size(), 20U);
  EXPECT_THAT(bytes.first(12), Each(std::byte{0}));
  EXPECT_EQ(std::memcmp(bytes.data() + 12, "\x89PNG\r\n\x1a\n", 8), 0);
  const Image in_m = depth_image(made.source(), DepthEncoding::metres_32fc1);
  EXPECT_THAT(error_text([&] { compressed_depth_image(in_m); }), HasSubstr("16UC1"));
}

TEST(ColourImage, HasTheDiffuseColoursOfTheSurfaces) {
  Measured made = camera();
  EXPECT_THAT(error_text([&] { colour_image(made.source(), ColourEncoding::rgb8); }),
              HasSubstr("no colours"));
  made.frame.ground_truth.colour.assign(made.beams.size(), {1.0F, 0.5F, 0.0F});
  made.frame.ground_truth.colour[1] = Eigen::Vector3f::Constant(kNaNf);
  const Image rgb = colour_image(made.source(), ColourEncoding::rgb8);
  EXPECT_EQ(rgb.encoding, "rgb8");
  EXPECT_EQ(rgb.step, 9U);
  const auto bytes = pixels<std::uint8_t>(rgb);
  EXPECT_THAT(std::vector(bytes.begin(), bytes.begin() + 6), ElementsAre(255, 128, 0, 0, 0, 0));
  const Image bgra = colour_image(made.source(), ColourEncoding::bgra8, "rgb_camera_link");
  EXPECT_EQ(bgra.header.frame_id, "rgb_camera_link");
  const auto others = pixels<std::uint8_t>(bgra);
  EXPECT_THAT(std::vector(others.begin(), others.begin() + 4), ElementsAre(0, 128, 255, 255));
  EXPECT_EQ(png_image(rgb).format, "rgb8; png compressed bgr8");
}

TEST(RawImageMessage, HasTheLevelsOfTheImager) {
  Measured made = camera();
  RawImage& raw = made.frame.raw_images.emplace_back(RawImage{.name = "ir_left"});
  raw.grey = {.width = 3, .height = 2, .max_level = 255, .level = {0, 1, 2, 3, 4, 255}};
  const Image image = raw_image(made.source(), "ir_left");
  EXPECT_EQ(image.encoding, "mono8");
  EXPECT_THAT(pixels<std::uint8_t>(image), ElementsAre(0, 1, 2, 3, 4, 255));
  made.frame.raw_images[0].grey.max_level = 1023;
  EXPECT_EQ(raw_image(made.source(), "ir_left").encoding, "mono16");
  EXPECT_THAT(error_text([&] { raw_image(made.source(), "ir_right"); }),
              HasSubstr("--depth-model physical"));
}

TEST(CameraInfoMessage, OfARightCameraHasTheBaselineInItsProjection) {
  const Measured made = camera();
  const CameraInfo info = camera_info(made.source(), "left", 0.05);
  EXPECT_DOUBLE_EQ(info.p[3], -0.05 * info.k[0]);
  EXPECT_EQ(camera_info(made.source()).p[3], 0.0);
}

TEST(CameraInfoMessage, HasTheModelsOfRos) {
  Measured made = camera();
  const CameraInfo plain = camera_info(made.source());
  EXPECT_EQ(plain.distortion_model, "plumb_bob");
  EXPECT_THAT(plain.d, ElementsAre(0, 0, 0, 0, 0));
  EXPECT_EQ(plain.k[2], 1.0);  // pixel centres at whole numbers
  EXPECT_EQ(plain.p[6], plain.k[5]);
  auto& pinhole = std::get<Pinhole>(made.sensor.optics);
  pinhole.distortion = RadialTangential{.k1 = 0.1, .k6 = 0.2};
  EXPECT_EQ(camera_info(made.source()).distortion_model, "rational_polynomial");
  EXPECT_EQ(camera_info(made.source()).d.size(), 8U);
  pinhole.distortion = Fisheye{.k1 = 0.1};
  EXPECT_EQ(camera_info(made.source()).distortion_model, "equidistant");
  EXPECT_EQ(camera_info(made.source()).d.size(), 4U);
  pinhole.distortion = RadialTangential{.k1 = 0.1, .s1 = 0.01};
  EXPECT_EQ(camera_info(made.source()).d.size(), 12U);
  pinhole.distortion = RadialTangential{.k1 = 0.1, .tau_y = 0.01};
  EXPECT_EQ(camera_info(made.source()).distortion_model, "rational_polynomial");
  EXPECT_EQ(camera_info(made.source()).d.size(), 14U);
  pinhole.distortion = DoubleSphere{-0.2, 0.6};
  pinhole.skew_px = 1.5;
  EXPECT_EQ(camera_info(made.source()).distortion_model, "double_sphere");
  EXPECT_THAT(camera_info(made.source()).d, ElementsAre(-0.2, 0.6));
  EXPECT_EQ(camera_info(made.source()).k[1], 1.5);
  made.sensor.optics = Spinning{};
  EXPECT_THAT(error_text([&] { camera_info(made.source()); }), HasSubstr("no camera"));
}

Measured scanner(Spinning::RotationDirection direction) {
  Spinning spinning;
  spinning.channels = {{.elevation_rad = 0.0, .ring = 3}, {.elevation_rad = 0.1, .ring = 4}};
  spinning.columns_per_turn = 8;
  spinning.rotation_direction = direction;
  return measured(spinning, 10.0);
}

TEST(LaserScanMessage, OfAWholeTurnGoesFromMinusPiWithAPositiveTimeIncrement) {
  for (const auto direction :
       {Spinning::RotationDirection::clockwise, Spinning::RotationDirection::counterclockwise}) {
    Measured made = scanner(direction);
    made.sensor.limits.near_m = 0.25;
    made.sensor.limits.far_m = 50.0;
    const LaserScan scan = laser_scan(made.source(), 3);
    ASSERT_EQ(scan.ranges.size(), 8U);
    EXPECT_THAT(scan.ranges, Each(FloatEq(2.0F)));
    EXPECT_FLOAT_EQ(scan.angle_increment, static_cast<float>(std::numbers::pi / 4.0));
    EXPECT_NEAR(scan.angle_max - scan.angle_min, 7.0 * std::numbers::pi / 4.0, 1e-6);
    EXPECT_NEAR(scan.angle_min, -std::numbers::pi, 1e-6);
    EXPECT_NEAR(scan.time_increment, 0.0125, 1e-9);
    EXPECT_EQ(to_ns(scan.header.stamp), 5'000'000'000);
    EXPECT_FLOAT_EQ(scan.range_min, 0.25F);
    EXPECT_FLOAT_EQ(scan.scan_time, 0.1F);
    EXPECT_FLOAT_EQ(scan.range_max, 50.0F);
  }
}

TEST(LaserScanMessage, ASectorIsOneScan) {
  Spinning sector;
  sector.channels = {{.elevation_rad = 0.0, .ring = 0}};
  sector.columns_per_turn = 1440;
  sector.azimuth_start_rad = -0.75 * std::numbers::pi;
  sector.azimuth_width_rad = 1.5 * std::numbers::pi;
  const LaserScan scan = laser_scan(measured(sector, 10.0).source(), 0);
  EXPECT_EQ(scan.ranges.size(), 1081U);
  EXPECT_NEAR(scan.angle_min, -0.75 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(scan.angle_max, 0.75 * std::numbers::pi, 1e-6);
  sector.start_azimuth_rad = 0.0;
  EXPECT_THAT(error_text([&] { laser_scan(measured(sector, 10.0).source(), 0); }),
              HasSubstr("start_azimuth_deg"));
}

TEST(LaserScanMessage, MissingReturnsFollowRep117) {
  Measured made = scanner(Spinning::RotationDirection::counterclockwise);
  // the fifth of eight columns is at -pi, the first angle of the scan
  const std::size_t ring3 = ring_of(made.beams, 0) == 3 ? 4 : 12;
  invalidate(made, ring3, Status::miss);
  invalidate(made, ring3 + 1, Status::too_near);
  invalidate(made, ring3 + 2, Status::dropped);
  const LaserScan scan = laser_scan(made.source(), 3);
  EXPECT_EQ(scan.ranges[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(scan.ranges[1], -std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(scan.ranges[2]));
  EXPECT_FLOAT_EQ(scan.ranges[3], 2.0F);
}

/// Beams at a given azimuth have a range of 1 m plus a share of the angle.
TEST(LaserScanMessage, EveryRangeIsAtTheAngleOfItsBeam) {
  for (const auto direction :
       {Spinning::RotationDirection::clockwise, Spinning::RotationDirection::counterclockwise}) {
    for (const int turns : {0, 1, 2}) {
      Measured made = scanner(direction);
      for (std::size_t i = 0; i < made.beams.size(); ++i) {
        const Eigen::Vector3d& d = made.beams.directions[i];
        made.frame.range_m[i] = 10.0 + std::atan2(d.y(), d.x());
      }
      const LaserScan scan = laser_scan(made.source(), 3, "laser", turns);
      for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
        const double angle = scan.angle_min + scan.angle_increment * static_cast<double>(i);
        const double in_sensor = angle - 0.5 * std::numbers::pi * turns;
        EXPECT_NEAR(std::cos(scan.ranges[i] - 10.0 - in_sensor), 1.0, 1e-9) << i << " " << turns;
      }
    }
  }
}

TEST(LaserScanMessage, OtherPatternsAreErrors) {
  const Measured made = scanner(Spinning::RotationDirection::clockwise);
  EXPECT_THAT(error_text([&] { laser_scan(made.source(), 9); }), HasSubstr("0 beams"));
  const Measured pixels = measured(pinhole_from_fov(9, 1, 2.0));
  EXPECT_THAT(error_text([&] { laser_scan(pixels.source(), 0); }), HasSubstr("rad apart"));
}

TEST(PoseMessages, ReadBackTheSamePose) {
  const Pose pose = make_pose({1.0, 2.0, 3.0}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
  const TransformStamped transform = to_transform(pose, {"map", "base"}, 1'500'000'000);
  EXPECT_EQ(transform.header.frame_id, "map");
  EXPECT_EQ(transform.child_frame_id, "base");
  EXPECT_EQ(transform.transform.rotation.w, 0.5);
  EXPECT_EQ(transform.transform.rotation.x, -0.5);
  const TimedPose timed = timed_pose(transform);
  EXPECT_EQ(timed.t_ns, 1'500'000'000);
  EXPECT_EQ(timed.position_m, pose.translation());
  EXPECT_TRUE(timed.orientation.toRotationMatrix().isApprox(pose.linear()));
  EXPECT_EQ(timed_pose(to_pose_stamped(pose, "map", 7)).t_ns, 7);
  EXPECT_EQ(to_ns(to_clock(7).clock), 7);
}

TEST(PoseMessages, AnUnknownTwistIsMarkedInItsCovariance) {
  const Odometry odometry = to_odometry(Pose::Identity(), std::nullopt, {"odom", "base"}, 9);
  EXPECT_EQ(odometry.linear_velocity.x, 0.0);
  EXPECT_EQ(odometry.twist_covariance[0], -1.0);
}

TEST(PoseMessages, TheMeanTwistOfAConstantTwistIsExact) {
  const Eigen::Vector3d omega(0.3, -0.2, 0.5);
  const Eigen::Vector3d v(1.0, 2.0, -0.5);
  const Pose before = make_pose({4.0, 5.0, 6.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  for (const double seconds : {1e-6, 0.1, 2.0}) {
    // se3_exp takes a rotation and the velocity along it
    const Pose after = before * se3_exp(omega * seconds, v * seconds);
    const BodyTwist twist = mean_twist(before, after, seconds);
    EXPECT_NEAR((twist.angular_rad_s - omega).norm(), 0.0, 1e-7) << seconds;
    EXPECT_NEAR((twist.linear_m_s - v).norm(), 0.0, 1e-7) << seconds;
  }
  const Odometry odometry = to_odometry(before, BodyTwist{v, omega}, {"odom", "base"}, 9);
  EXPECT_EQ(odometry.linear_velocity.y, 2.0);
  EXPECT_EQ(odometry.angular_velocity.z, 0.5);
  EXPECT_EQ(timed_pose(odometry).position_m, before.translation());
}

}  // namespace
}  // namespace glidar::ros
