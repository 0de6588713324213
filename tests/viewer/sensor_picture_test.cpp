// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/view_drawing.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace glidar::app {
namespace {

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

}  // namespace
}  // namespace glidar::app
