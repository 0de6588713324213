// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/grey_image_file.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using ::testing::HasSubstr;

TEST(RawImageFile, HoldsTheGreyLevelsOfTheNamedImage) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  for (const RawImage& image : made.frame.raw_images) {
    const std::filesystem::path path = folder / ("a." + image.name + ".png");
    write_cloud(made, path);
    const GreyImage read = load_grey_image(path);
    EXPECT_EQ(read.max_level, 255U);
    EXPECT_EQ(read.level, image.grey.level) << image.name;
  }
}

TEST(RawImageFile, HasSixteenBitsForMoreLevels) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  GreyImage& image = made.frame.raw_images.front().grey;
  image.max_level = 1023;
  image.level.front() = 1000;
  write_cloud(made, folder / "a.ir_left.png");
  EXPECT_EQ(load_grey_image(folder / "a.ir_left.png").level, image.level);
}

TEST(RawImageFile, IsRefusedWithoutTheImage) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.frame.raw_images.clear();
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.ir_right.png"); }),
              HasSubstr("--depth-model physical"));
  EXPECT_TRUE(folder.names().empty());
}

Misfit misfit_of(const char* name, const Sensor& sensor) {
  return find_misfit(format_for(name), {}, sensor, make_beams(sensor));
}

TEST(RawImageFile, FitsSensorsThatTakeTheImage) {
  Sensor sensor;
  sensor.optics = pinhole_from_fov(40, 30, 0.5);
  EXPECT_THAT(misfit_of("a.ir_left.png", sensor).reason, HasSubstr("not simulated from infrared"));
  sensor.depth_camera = ActiveStereo{};
  sensor.depth_model = DepthModel::physical;
  EXPECT_EQ(misfit_of("a.ir_left.png", sensor).reason, "");
  EXPECT_EQ(misfit_of("a.ir_right.png", sensor).reason, "");
  EXPECT_THAT(misfit_of("a.ir_reference.png", sensor).reason, HasSubstr("no reference picture"));
  std::get<ActiveStereo>(*sensor.depth_camera).reference = ActiveStereo::Reference::pattern;
  EXPECT_THAT(misfit_of("a.ir_right.png", sensor).reason, HasSubstr("no right imager"));
}

}  // namespace
}  // namespace glidar
