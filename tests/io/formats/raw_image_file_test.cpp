// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/grey_image_file.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

namespace glidar {
namespace {

using ::testing::HasSubstr;

TEST(RawImageFile, HoldsTheGreyLevelsOfTheNamedImage) {
  const testing::TestFolder folder;
  const CloudFixture made = make_fixture();
  for (const RawImage& image : made.frame.raw_images) {
    if (image.name.starts_with("pattern_")) continue;
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

/// A NumPy file by its format: magic, version 1.0, length of the header, header, numbers.
struct NpyParts {
  std::string header;
  std::string numbers;
};

NpyParts read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length =
      static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  return {bytes.substr(10, length), bytes.substr(10 + length)};
}

TEST(RawImageFile, OfPatternsHasAllOfThem) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  write_cloud(made, folder / "a.patterns.npy");
  const NpyParts bytes = read_npy(folder / "a.patterns.npy");
  EXPECT_THAT(bytes.header, HasSubstr("'descr': '|u1'"));
  EXPECT_THAT(bytes.header, HasSubstr("(2, 4, 5, )"));
  ASSERT_EQ(bytes.numbers.size(), 40U);
  std::vector<GreyImage*> patterns;
  for (RawImage& image : made.frame.raw_images) {
    if (image.name.starts_with("pattern_")) patterns.push_back(&image.grey);
  }
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(static_cast<unsigned char>(bytes.numbers[i]), patterns[i / 20]->level[i % 20]);
  }
  for (GreyImage* image : patterns) image->max_level = 4095;
  patterns[1]->level[19] = 0x0A0B;
  write_cloud(made, folder / "b.patterns.npy");
  const NpyParts words = read_npy(folder / "b.patterns.npy");
  EXPECT_THAT(words.header, HasSubstr("'descr': '<u2'"));
  ASSERT_EQ(words.numbers.size(), 80U);
  EXPECT_EQ(words.numbers.substr(78), "\x0B\x0A");
}

TEST(RawImageFile, OfPatternsIsRefusedWithoutThem) {
  const testing::TestFolder folder;
  CloudFixture made = make_fixture();
  made.frame.raw_images.resize(3);
  EXPECT_THAT(error_text([&] { write_cloud(made, folder / "a.patterns.npy"); }),
              HasSubstr("without images of patterns"));
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
  EXPECT_THAT(misfit_of("a.patterns.npy", sensor).reason, HasSubstr("not simulated from images"));
  sensor.depth_camera = StructuredLightCamera{};
  EXPECT_EQ(misfit_of("a.patterns.npy", sensor).reason, "");
  EXPECT_THAT(misfit_of("a.ir_left.png", sensor).reason, HasSubstr("not simulated from infrared"));
}

}  // namespace
}  // namespace glidar
