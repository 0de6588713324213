// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/sensor/optics/pinhole.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace glidar::app {
namespace {

int apart(Colour a, Colour b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}

TEST(Hue, CoversTheCircleOfPureColours) {
  EXPECT_EQ(apart(hue(0.0), {255, 0, 0}), 0);
  EXPECT_EQ(apart(hue(1.0 / 6.0), {255, 255, 0}), 0);
  EXPECT_EQ(apart(hue(1.0 / 3.0), {0, 255, 0}), 0);
  EXPECT_EQ(apart(hue(0.5), {0, 255, 255}), 0);
  EXPECT_EQ(apart(hue(2.0 / 3.0), {0, 0, 255}), 0);
  EXPECT_EQ(apart(hue(5.0 / 6.0), {255, 0, 255}), 0);
  EXPECT_EQ(apart(hue(1.25), hue(0.25)), 0);
}

TEST(ColourOf, ClampsBeyondZeroAndOne) {
  for (const ColourMap map : {ColourMap::viridis, ColourMap::rainbow, ColourMap::grey}) {
    EXPECT_EQ(apart(colour_of(map, -3.0), colour_of(map, 0.0)), 0);
    EXPECT_EQ(apart(colour_of(map, 7.0), colour_of(map, 1.0)), 0);
    EXPECT_GT(apart(colour_of(map, 0.0), colour_of(map, 1.0)), 300);
  }
}

TEST(ColourOf, RainbowRunsFromBlueToRedAndGreyIsLinear) {
  EXPECT_EQ(apart(colour_of(ColourMap::rainbow, 0.0), {0, 0, 255}), 0);
  EXPECT_EQ(apart(colour_of(ColourMap::rainbow, 1.0), {255, 0, 0}), 0);
  EXPECT_EQ(apart(colour_of(ColourMap::grey, 0.5), {128, 128, 128}), 0);
}

TEST(CategoryColour, DiffersForTheFirstSixteen) {
  for (std::uint32_t a = 0; a < 16; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      EXPECT_GT(apart(category_colour(a), category_colour(b)), 40) << a << " and " << b;
    }
  }
}

constexpr float kSingle = 1e-5F;

Beams camera_beams() {
  return make_beams(pinhole_from_fov(8, 6, 0.5));
}

TEST(GridSpacing, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(grid_spacing_m(10.0), 1.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(19.0), 1.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(20.0), 2.0);
  EXPECT_DOUBLE_EQ(grid_spacing_m(70.0), 5.0);
  EXPECT_NEAR(grid_spacing_m(0.03), 0.002, 1e-15);
  EXPECT_DOUBLE_EQ(grid_spacing_m(3e6), 2e5);
}

TEST(AddGrid, IsHorizontalAtMultiplesOfItsSpacing) {
  Lines lines;
  add_grid({0.4, -0.3, 2.0}, 3.0, 1.0, lines);
  ASSERT_EQ(lines.size(), 2U * 2U * 7U);
  for (const ColouredVertex& vertex : lines) {
    EXPECT_FLOAT_EQ(vertex.position_m.z(), 2.0F);
    EXPECT_FLOAT_EQ(vertex.position_m.x(), std::round(vertex.position_m.x()));
    EXPECT_LE(vertex.position_m.head<2>().cwiseAbs().maxCoeff(), 3.0F);
  }
}

TEST(AddAxes, PointAlongTheAxesOfThePose) {
  Lines lines;
  Pose pose = optical_from_body();
  pose.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  add_axes(pose, 2.0, lines);
  ASSERT_EQ(lines.size(), 6U);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(2 * axis);
    EXPECT_TRUE(lines[at].position_m.isApprox(Eigen::Vector3f(1.0F, 2.0F, 3.0F)));
    const Eigen::Vector3d tip = pose.translation() + 2.0 * pose.linear().col(axis);
    EXPECT_TRUE(lines[at + 1].position_m.isApprox(tip.cast<float>(), kSingle));
  }
}

TEST(AddFrustum, OutlinesACamerasViewFromTheSensor) {
  const Beams beams = camera_beams();
  Lines lines;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(5.0, 0.0, 0.0);
  add_frustum(beams, pose, 2.0, lines);
  ASSERT_FALSE(lines.empty());
  std::size_t at_sensor = 0;
  for (const ColouredVertex& vertex : lines) {
    const float range = (vertex.position_m - Eigen::Vector3f(5.0F, 0.0F, 0.0F)).norm();
    EXPECT_TRUE(range < kSingle || std::abs(range - 2.0F) < kSingle) << range;
    at_sensor += range < kSingle ? 1 : 0;
  }
  EXPECT_GE(at_sensor, 4U);
  const Eigen::Vector3f corner =
      (pose * Eigen::Vector3d(2.0 * beams.directions.front())).cast<float>();
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const ColouredVertex& vertex) {
    return vertex.position_m.isApprox(corner, kSingle);
  }));
}

TEST(AddFrustum, SkipsPixelsWithoutABeam) {
  Beams beams = camera_beams();
  std::fill(beams.directions.begin(), beams.directions.end(), Eigen::Vector3d::Constant(NAN));
  Lines lines;
  add_frustum(beams, Pose::Identity(), 1.0, lines);
  EXPECT_TRUE(lines.empty());
  add_frustum(Beams{}, Pose::Identity(), 1.0, lines);
  EXPECT_TRUE(lines.empty());
}

TEST(AddBoxes, DrawsTheTwelveEdgesOfEachBox) {
  std::vector<Eigen::Vector3d> corners_m;
  for (int box = 0; box < 2; ++box) {
    for (int i = 0; i < 8; ++i) corners_m.emplace_back(i & 1, (i >> 1) & 1, 10 * box + (i >> 2));
  }
  Lines lines;
  add_boxes(corners_m, lines);
  ASSERT_EQ(lines.size(), 2U * 2U * 12U);
  for (std::size_t k = 0; k < lines.size(); k += 2) {
    EXPECT_EQ((lines[k].position_m - lines[k + 1].position_m).norm(), 1.0F) << "no diagonals";
  }
}

/// Three beams of a camera: a near and a far hit, and a miss.
class SensorPictureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    beams_.rows = 1;
    beams_.cols = 3;
    beams_.directions = {direction_through(0.0, 0.0), direction_through(0.75, 0.0),
                         direction_through(0.0, 0.0)};
    frame_.status = {Status::hit, Status::hit, Status::miss};
    frame_.range_m = {1.0, 5.0, NAN};
    frame_.intensity = {0.5F, 0.25F, 0.0F};
    frame_.ground_truth.normal = {Eigen::Vector3f(0.0F, 0.0F, -1.0F),
                                  Eigen::Vector3f(-1.0F, 0.0F, 0.0F),
                                  Eigen::Vector3f::Constant(NAN)};
    frame_.ground_truth.instance = {1, 0, kInvalidId};
    scene_.instances = {{.name = "rock", .id = 7, .materials = {}},
                        {.name = "box", .id = 9, .materials = {}}};
  }

  SensorPicture picture_of(Quantity quantity) {
    SensorPicture picture;
    make_sensor_picture(frame_, beams_, scene_, quantity, ColourMap::grey, picture);
    return picture;
  }

  Beams beams_;
  Frame frame_;
  Scene scene_;
};

TEST_F(SensorPictureTest, ScalesDepthAlongTheBoresightAndRangeAlongTheBeam) {
  const SensorPicture depth = picture_of(Quantity::depth);
  EXPECT_DOUBLE_EQ(depth.scale.low, 1.0);
  EXPECT_NEAR(depth.scale.high, 4.0, 1e-12) << "of a 3-4-5 triangle";
  const SensorPicture range = picture_of(Quantity::range);
  EXPECT_DOUBLE_EQ(range.scale.high, 5.0);
  EXPECT_EQ(range.colours[0].r, 255) << "near is bright";
  EXPECT_EQ(range.colours[1].r, 0);
}

TEST_F(SensorPictureTest, CountsRangesFromTheSensorsOrigin) {
  beams_.range_offset_m = 0.5;
  EXPECT_DOUBLE_EQ(picture_of(Quantity::range).scale.low, 1.5);
}

TEST_F(SensorPictureTest, ScalesIntensityFromZero) {
  const SensorPicture picture = picture_of(Quantity::intensity);
  EXPECT_DOUBLE_EQ(picture.scale.low, 0.0);
  EXPECT_DOUBLE_EQ(picture.scale.high, 0.5);
  EXPECT_EQ(picture.colours[0].g, 255);
  EXPECT_EQ(picture.colours[1].g, 128);
}

TEST_F(SensorPictureTest, ShowsNormalsInTheSensorsView) {
  const SensorPicture picture = picture_of(Quantity::normals);
  EXPECT_EQ(picture.colours[0].b, 255) << "towards the sensor";
  EXPECT_EQ(picture.colours[1].r, 0) << "to the left";
  EXPECT_EQ(picture.legend.size(), 3U);
}

TEST_F(SensorPictureTest, NamesTheVisibleInstances) {
  const SensorPicture picture = picture_of(Quantity::instance);
  ASSERT_EQ(picture.legend.size(), 2U);
  EXPECT_EQ(picture.legend[0].text, "rock (id 7)");
  EXPECT_EQ(picture.legend[1].text, "box (id 9)");
  EXPECT_EQ(picture.colours[0].r, picture.legend[1].colour.r);
}

TEST_F(SensorPictureTest, CountsEveryStatus) {
  frame_.status[1] = Status::dropped;
  const SensorPicture picture = picture_of(Quantity::status);
  std::vector<std::string> texts;
  for (const LegendEntry& entry : picture.legend) texts.push_back(entry.text);
  EXPECT_THAT(texts, ::testing::ElementsAre(std::string(name(Status::hit)) + ": 1",
                                            std::string(name(Status::miss)) + ": 1",
                                            std::string(name(Status::dropped)) + ": 1"));
}

TEST_F(SensorPictureTest, HasNoScaleWithoutReturns) {
  frame_.status = {Status::miss, Status::miss, Status::miss};
  const SensorPicture picture = picture_of(Quantity::depth);
  EXPECT_FALSE(picture.scale.has_values);
}

TEST_F(SensorPictureTest, KeepsItsColoursWhenOneEchoIsFarAway) {
  constexpr std::size_t kBeams = 1000;
  beams_.cols = kBeams;
  beams_.directions.assign(kBeams, direction_through(0.0, 0.0));
  frame_.status.assign(kBeams, Status::hit);
  frame_.range_m.clear();
  for (std::size_t i = 0; i < kBeams; ++i)
    frame_.range_m.push_back(1.0 + 0.001 * static_cast<double>(i));
  frame_.range_m[500] = 100.0;
  frame_.intensity.assign(kBeams, 0.5F);
  const SensorPicture picture = picture_of(Quantity::range);
  EXPECT_LT(picture.scale.high, 2.01);
  EXPECT_TRUE(picture.scale.clips_high);
  EXPECT_NEAR(picture.colours[250].r, 191, 3) << "a quarter of the way from near to far";
}

TEST_F(SensorPictureTest, ShowsACamerasPixelsInTheirOrder) {
  const SensorPicture picture = picture_of(Quantity::range);
  EXPECT_EQ(picture.layout.kind, BeamPicture::Kind::image);
  EXPECT_EQ(picture.layout.cols, 3U);
  EXPECT_EQ(picture.layout.beam_at(2), 2U);
}

TEST_F(SensorPictureTest, ShowsAWallAtNormalIncidenceInOneColour) {
  frame_.range_m = {2.0, 2.0, NAN};
  const SensorPicture picture = picture_of(Quantity::range);
  EXPECT_EQ(picture.colours[0].r, picture.colours[1].r);
}

constexpr double kRounding = 1e-12;
constexpr float kFloatError = 1e-5F;  // rounding of the matrix in single precision

Orbit some_orbit() {
  return {.pivot_m = {1.0, -2.0, 3.0}, .yaw_rad = 0.7, .pitch_rad = 0.3, .distance_m = 5.0};
}

Eigen::Vector2f seen_at(const Orbit& orbit, const Eigen::Vector3d& point_m) {
  const Eigen::Vector4f clip = clip_from_anchor(orbit, 1.0) * point_m.cast<float>().homogeneous();
  return clip.head<2>() / clip.w();
}

TEST(Orbit, LooksAtItsPivotFromItsDistanceWithZUp) {
  const Orbit orbit = some_orbit();
  const Pose eye = anchor_from_eye(orbit);
  EXPECT_NEAR((eye.translation() - orbit.pivot_m).norm(), orbit.distance_m, kRounding);
  EXPECT_TRUE((eye.linear().col(2) * orbit.distance_m)
                  .isApprox(orbit.pivot_m - eye.translation(), kRounding));
  EXPECT_LT(eye.linear().col(1).z(), 0.0) << "y of the image is down";
  EXPECT_NEAR(eye.linear().col(0).z(), 0.0, kRounding) << "the horizon is level";
}

TEST(Orbit, ShowsThePivotInTheCentreAndHigherPointsHigher) {
  const Orbit orbit = some_orbit();
  EXPECT_NEAR(seen_at(orbit, orbit.pivot_m).norm(), 0.0F, kFloatError);
  EXPECT_GT(seen_at(orbit, orbit.pivot_m + Eigen::Vector3d::UnitZ()).y(), 0.1F);
}

TEST(Orbit, SeesHalfItsHeightAtTheEdge) {
  const Orbit orbit = {.pitch_rad = 0.0, .distance_m = 2.0};
  const double half_height_m = 2.0 * std::tan(kOrbitFov_rad / 2.0);
  EXPECT_NEAR(seen_at(orbit, {0.0, 0.0, half_height_m}).y(), 1.0F, kFloatError);
}

TEST(Pan, KeepsThePivotsPlaneUnderThePointer) {
  Orbit orbit = some_orbit();
  const Eigen::Vector3d before = orbit.pivot_m;
  pan(orbit, {0.25, -0.1});  // heights: right and up
  const Eigen::Vector2f at = seen_at(orbit, before);
  EXPECT_NEAR(at.x(), 2.0F * 0.25F, kFloatError);
  EXPECT_NEAR(at.y(), 2.0F * 0.1F, kFloatError);
}

TEST(Turn, StopsBeforeThePoles) {
  Orbit orbit;
  turn(orbit, {0.0, 100.0});
  EXPECT_LT(orbit.pitch_rad, 1.5708);
  EXPECT_NO_THROW(anchor_from_eye(orbit));
  turn(orbit, {0.0, -200.0});
  EXPECT_GT(orbit.pitch_rad, -1.5708);
  EXPECT_NO_THROW(anchor_from_eye(orbit));
}

TEST(Zoom, MovesTenPercentCloserPerStepWithinLimits) {
  Orbit orbit = {.distance_m = 10.0};
  zoom(orbit, 1.0);
  EXPECT_NEAR(orbit.distance_m, 9.0, kRounding);
  zoom(orbit, -1.0);
  EXPECT_NEAR(orbit.distance_m, 10.0, kRounding);
  zoom(orbit, 1e6);
  EXPECT_GT(orbit.distance_m, 0.0);
  zoom(orbit, -1e6);
  EXPECT_TRUE(std::isfinite(orbit.distance_m));
}

TEST(PointAt, FindsThePointUnderThePointerClosestToTheEye) {
  const Orbit orbit = {.pitch_rad = 0.0, .distance_m = 10.0};  // the eye at x = 10
  const float nan = kNaNf;
  const std::vector<Eigen::Vector3f> points = {{-2.0F, 0.0F, 0.0F},
                                               {2.0F, 0.0F, 0.0F},
                                               {nan, nan, nan},
                                               {3.0F, 2.0F, 0.0F},
                                               {20.0F, 0.0F, 0.0F}};  // behind the eye
  EXPECT_THAT(point_at(orbit, points, {0.0, 0.0}, 0.01), ::testing::Optional(1U));
  EXPECT_EQ(point_at(orbit, points, {0.0, 0.9}, 0.01), std::nullopt);
  const double y = 2.0 / 7.0 / std::tan(kOrbitFov_rad / 2.0);  // +y is to the right from +x
  EXPECT_THAT(point_at(orbit, points, {y, 0.0}, 0.01), ::testing::Optional(3U));
}

}  // namespace

}  // namespace glidar::app
