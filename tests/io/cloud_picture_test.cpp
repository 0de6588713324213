// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/png_texture.hpp>
#include <glidar/io/pictures/chart.hpp>
#include <glidar/io/pictures/point_image.hpp>
#include <glidar/math/constants.hpp>

#include <glidar/sensor/optics/firing_schedule.hpp>

#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>

namespace glidar {
namespace {

using ::testing::HasSubstr;

/// A LiDAR's cloud of four beams: two on a car, one miss, one echo of noise.
struct Made {
  Scene scene;
  Sensor sensor;
  Beams beams;
  Frame frame;
  PointCloud cloud;
  FileSinkOptions options;

  [[nodiscard]] SidecarContext context() const { return {scene, sensor, beams, "rays"}; }
};

template <class T>
void add(PointCloud& cloud, const std::string& name, std::vector<T> values) {
  const std::size_t width = values.size() / cloud.size();
  std::vector<std::string> components;
  for (std::size_t i = 0; i < width; ++i) components.push_back(name + std::to_string(i));
  cloud.columns.push_back({name, components, std::move(values)});
}

Made make(bool is_camera = false) {
  Made made;
  made.scene.class_names = {"unlabelled", "car", "road"};
  made.scene.instances.resize(1);
  made.scene.instances[0].name = "my car";
  made.scene.instances[0].id = 7;
  made.scene.instances[0].class_id = 1;
  made.beams.rows = made.frame.rows = made.cloud.rows = 2;
  made.beams.cols = made.frame.cols = made.cloud.cols = 2;
  if (!is_camera) made.beams.boresight = Eigen::Vector3d::UnitX();
  made.beams.directions.assign(4, made.beams.boresight);
  made.cloud.frame_id = "lidar_frame";
  made.frame.range_m = {4.0, 5.0, kNaN, 90.0};
  add<double>(made.cloud, "xyz", {4, 1, 0, 5, -1, 1, kNaN, kNaN, kNaN, 0, 90, 2});
  add<double>(made.cloud, "range", made.frame.range_m);
  add<float>(made.cloud, "intensity", {1.0F, kNaNf, 0.0F, 3.0F});
  add<std::uint16_t>(made.cloud, "ring", {0, 0, 1, 1});
  add<std::uint32_t>(made.cloud, "class", {1, 0, kInvalidId, kInvalidId});
  add<std::uint32_t>(made.cloud, "instance", {7, 7, kInvalidId, kInvalidId});
  add<double>(made.cloud, "radial_velocity", {kNaN, kNaN, kNaN, kNaN});
  return made;
}

PointColours colours_by(Made made, ColourBy by) {
  made.options.picture.colour_by = by;
  const SidecarContext context = made.context();
  const CloudFile job{made.cloud, made.frame, made.options, context, {}};
  return colour_points(job, {{{4, 1, 0}, {5, -1, 1}, {0, 90, 2}}, {0, 1, 3}});
}

std::string written(const Made& made, const std::string& name) {
  const testing::TestFolder folder;
  const SidecarContext context = made.context();
  make_file_sink(folder / name, made.options, context)->write(made.cloud, made.frame);
  std::ifstream in(folder / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Width and height as the head of a PNG has them (RFC 2083, IHDR).
std::array<unsigned, 2> png_size(const std::string& png) {
  const auto number = [&png](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value * 256U + static_cast<unsigned char>(png.at(i));
    return value;
  };
  return {number(16), number(20)};
}

TEST(PointColours, HaveABarForNumbersAndALegendForCategories) {
  for (const ColourBy by :
       {ColourBy::height, ColourBy::range, ColourBy::intensity, ColourBy::ring}) {
    const PointColours colours = colours_by(make(), by);
    EXPECT_TRUE(colours.bar.has_value());
    EXPECT_TRUE(colours.legend.empty());
    EXPECT_EQ(colours.colours.size(), 3U);
  }
  EXPECT_FALSE(colours_by(make(), ColourBy::object_class).bar.has_value());
}

TEST(PointColours, HaveAColourBarWithTheirRange) {
  const PointColours height = colours_by(make(), ColourBy::height);
  EXPECT_EQ(height.bar->scale.low, 0.0);
  EXPECT_EQ(height.bar->scale.high, 2.0);
  EXPECT_EQ(height.bar->unit, "m");
  const PointColours range = colours_by(make(), ColourBy::range);
  EXPECT_GT(range.colours[0].r, range.colours[2].r) << "near is bright";
}

TEST(PointColours, OfRadialVelocitiesAreBlueWhiteAndRedOnAScaleAroundZero) {
  Made made = make();
  made.sensor.doppler = Doppler{};
  made.cloud.columns.pop_back();
  add<double>(made.cloud, "radial_velocity", {-4.0, 0.0, kNaN, 2.0});
  const PointColours colours = colours_by(made, ColourBy::radial_velocity);
  EXPECT_EQ(colours.bar->scale.low, -4.0);
  EXPECT_EQ(colours.bar->scale.high, 4.0);
  EXPECT_EQ(colours.bar->unit, "m/s");
  EXPECT_GT(colours.colours[0].b, colours.colours[0].r + 100) << "it comes nearer";
  EXPECT_LT(std::abs(int{colours.colours[1].b} - int{colours.colours[1].r}), 10)
      << "it does not move";
  EXPECT_GT(colours.colours[2].r, colours.colours[2].b + 50) << "it moves away";
  made.sensor.doppler.reset();
  EXPECT_THAT(error_text([&] { colours_by(made, ColourBy::radial_velocity); }),
              HasSubstr("the sensor does not measure it"));
}

TEST(PointColours, NameClassesAndInstances) {
  const PointColours classes = colours_by(make(), ColourBy::object_class);
  ASSERT_EQ(classes.legend.size(), 3U);
  std::vector<std::string> names;
  for (const LegendEntry& entry : classes.legend) names.push_back(entry.text);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("car", "unlabelled", "no object"));
  const PointColours instances = colours_by(make(), ColourBy::instance);
  EXPECT_EQ(instances.legend.at(0).text, "my car") << "the most frequent comes first";
  EXPECT_EQ(instances.colours[0], instances.colours[1]);
  EXPECT_NE(instances.colours[0], instances.colours[2]);
}

TEST(Legend, ListsEntriesThatFitAndCountsTheOthers) {
  std::vector<LegendEntry> entries;
  for (int i = 0; i < 100; ++i) entries.push_back({{1, 2, 3}, "class number " + std::to_string(i)});
  const std::vector<LegendEntry> fitted = fitted_legend(entries, 400.0, 90.0, 10.0);
  EXPECT_LE(legend_height(fitted, 400.0, 10.0), 90.0);
  ASSERT_GE(fitted.size(), 5U);
  EXPECT_EQ(fitted[0].text, "class number 0");
  EXPECT_EQ(fitted.back().text, "and " + std::to_string(100 - (fitted.size() - 1)) + " others");
  EXPECT_EQ(fitted_legend({entries[0], entries[1]}, 400.0, 90.0, 10.0).back().text,
            "class number 1");
}

TEST(Legend, TruncatesLongNamesBetweenCharacters) {
  std::string name;
  for (int i = 0; i < 200; ++i) name += "\u00e9";  // two bytes each
  const std::vector<LegendEntry> fitted = fitted_legend({{{1, 2, 3}, name}}, 400.0, 90.0, 10.0);
  const std::string& text = fitted.at(0).text;
  EXPECT_LE(text_width(text, 10.0), 200.0);
  ASSERT_GT(text.size(), 13U);
  EXPECT_EQ(text.substr(text.size() - 3), "...");
  EXPECT_EQ(text.size() % 2, 1U) << "whole letters and three points";
}

TEST(PointColours, AreGreyForMissingValues) {
  const PointColours intensity = colours_by(make(), ColourBy::intensity);
  EXPECT_EQ(intensity.bar->scale.high, 3.0);
  EXPECT_NE(intensity.colours[1], intensity.colours[0]);
}

TEST(PointColours, RejectRingsOfACamera) {
  EXPECT_THAT(error_text([] { colours_by(make(true), ColourBy::ring); }),
              HasSubstr("ring: a camera has no rings; allowed: height, range, intensity, class"));
}

TEST(CloudPicture, HasTheRequestedSize) {
  Made made = make();
  made.options.picture.width = 640;
  made.options.picture.height = 480;
  for (const char* name : {"a.bev.png", "a.view.png"}) {
    EXPECT_EQ(png_size(written(made, name)), (std::array<unsigned, 2>{640, 480})) << name;
  }
}

/// The pixels of a colour in a picture's plot: how many, and their mean place.
struct Spots {
  std::size_t count = 0;
  double col = 0.0;
  double row = 0.0;
};
Spots spots_of(const Made& made, const char* name, const Colour& colour) {
  const testing::TestFolder folder;
  const SidecarContext context = made.context();
  make_file_sink(folder / name, made.options, context)->write(made.cloud, made.frame);
  const Texture png = read_png_texture(folder / name);
  Spots spots;
  const std::size_t plot_rows = png.height - png.height / 6;  // the legend is below
  for (std::size_t i = 0; i < png.width * plot_rows; ++i) {
    const std::uint8_t* rgb = &png.texels[i * png.channels];
    if (rgb[0] != colour.r || rgb[1] != colour.g || rgb[2] != colour.b) continue;
    ++spots.count;
    spots.col += static_cast<double>(i % png.width);
    spots.row += static_cast<double>(i / png.width);
  }
  spots.col /= static_cast<double>(spots.count);
  spots.row /= static_cast<double>(spots.count);
  return spots;
}

/// A cloud of one point.
Made one_point(bool is_camera, const std::vector<double>& xyz) {
  Made made = make(is_camera);
  made.options.picture.colour_by = ColourBy::object_class;
  made.scene.class_names = {"unlabelled", "car"};
  made.cloud.columns[0].values = std::vector<double>{xyz[0], xyz[1], xyz[2], kNaN, kNaN, kNaN,
                                                     kNaN,   kNaN,   kNaN,   kNaN, kNaN, kNaN};
  return made;
}

TEST(CloudPicture, IsDrawnWithoutPoints) {
  Made made = one_point(false, {5.0, 2.0, 0.0});
  const Colour point = colours_by(make(), ColourBy::object_class).colours[0];
  for (const char* name : {"a.bev.png", "a.view.png"}) {
    EXPECT_GT(spots_of(made, name, point).count, 0U) << name;
  }
  made.cloud.columns[0].values = std::vector<double>(12, kNaN);
  for (const char* name : {"a.bev.png", "a.view.png"}) {
    EXPECT_EQ(spots_of(made, name, point).count, 0U) << name;
  }
}

TEST(CloudPicture, ShowsForwardToTheRightAndLeftUpForEverySensor) {
  const Colour point = colours_by(make(), ColourBy::object_class).colours[0];
  const Made lidar = one_point(false, {5.0, 2.0, 0.0});   // x ahead, y to the left
  const Made camera = one_point(true, {-2.0, 0.0, 5.0});  // x to the right, z ahead
  const Spots of_lidar = spots_of(lidar, "a.bev.png", point);
  const Spots of_camera = spots_of(camera, "a.bev.png", point);
  ASSERT_GT(of_lidar.count, 0U);
  EXPECT_EQ(of_lidar.count, of_camera.count);
  EXPECT_NEAR(of_lidar.col, of_camera.col, 1.0);
  EXPECT_NEAR(of_lidar.row, of_camera.row, 1.0);
}

TEST(CloudPicture, RejectsInvalidSizesAndEyes) {
  Made made = make();
  made.options.picture.eye_m = made.options.picture.target_m = Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_THAT(error_text([&] { written(made, "a.view.png"); }),
              HasSubstr("view_eye: it equals the view's target"));
  made.options.picture.width = 10;
  EXPECT_THAT(error_text([&] { written(made, "a.bev.png"); }),
              HasSubstr("picture size: 10 x 1000 pixels; allowed: sides from 200 to 8192"));
}

TEST(CloudPicture, LeavesNoFileAfterAnError) {
  const testing::TestFolder folder;
  Made made = make(true);
  made.options.picture.colour_by = ColourBy::ring;
  const SidecarContext context = made.context();
  const auto sink = make_file_sink(folder / "a.bev.png", made.options, context);
  EXPECT_THROW(sink->write(made.cloud, made.frame), Error);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace glidar
