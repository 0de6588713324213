// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/chart.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace glidar {
namespace {

constexpr Colour kBlack = {0, 0, 0};
constexpr Colour kWhite = {255, 255, 255};
constexpr double kSize = 32.0;
constexpr double kRounding = 1e-4;  // pixels; glyphs are measured in single precision

Picture drawn(std::string_view text, TextPlace::Align align = TextPlace::Align::left) {
  Picture picture = make_picture(200, 60, kBlack);
  draw_text(picture, {100.0, 30.0, align}, text, {kSize, kWhite});
  return picture;
}

/// The box around all that is not black; nothing: width 0.
Box inked(const Picture& picture) {
  std::size_t left = picture.width;
  std::size_t right = 0;
  std::size_t top = picture.height;
  std::size_t bottom = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (picture.pixels[i] == kBlack) continue;
    left = std::min(left, i % picture.width);
    right = std::max(right, i % picture.width + 1);
    top = std::min(top, i / picture.width);
    bottom = std::max(bottom, i / picture.width + 1);
  }
  if (right == 0) return {};
  return {left, top, right - left, bottom - top};
}

TEST(Font, HasTheAdvancesOfDejaVuSans) {
  // hmtx of DejaVu Sans 2.37, in units of 1/2048 em: zero 1303, W 2025, degree 1024, minus 1716
  EXPECT_NEAR(text_width("0", kSize), kSize * 1303.0 / 2048.0, kRounding);
  EXPECT_NEAR(text_width("W", kSize), kSize * 2025.0 / 2048.0, kRounding);
  EXPECT_NEAR(text_width("\u00b0", kSize), kSize * 1024.0 / 2048.0, kRounding);
  EXPECT_NEAR(text_width("\u2212", kSize), kSize * 1716.0 / 2048.0, kRounding);
  EXPECT_NEAR(text_width("0W", kSize), text_width("0", kSize) + text_width("W", kSize), kRounding);
  EXPECT_EQ(text_width("", kSize), 0.0);
}

TEST(Font, CentresCapitalLettersVertically) {
  const Box box = inked(drawn("H"));
  EXPECT_NEAR(static_cast<double>(box.height), kSize * 0.729, 1.0) << "1493 / 2048 of the em";
  EXPECT_NEAR(static_cast<double>(box.y) + 0.5 * static_cast<double>(box.height), 30.0, 1.0);
}

TEST(Font, HasAllCharactersOfPictures) {
  const Picture unknown = drawn("\u4e2d");
  for (const char* text : {"a", "Z", "7", ",", "\u00b0", "\u00b1", "\u00d7", "\u2212", "\u2264",
                           "\u2265", "\u00e4", "\u0142", "\u03c3", "\u0416"}) {
    const Picture picture = drawn(text);
    EXPECT_GT(inked(picture).width, 0U) << text;
    EXPECT_NE(picture.pixels, unknown.pixels) << text;
  }
}

TEST(Font, DrawsABoxForUnknownCharactersAndInvalidUtf8) {
  const Picture unknown = drawn("\u4e2d");
  EXPECT_GT(inked(unknown).width, 5U);
  for (const std::string bytes : {"\xff", "\xe4", "\xc2"}) {
    EXPECT_EQ(drawn(bytes).pixels, unknown.pixels);
    EXPECT_GT(text_width(bytes + "0", kSize), text_width("0", kSize));
  }
}

TEST(Font, HasSmoothEdges) {
  const Picture picture = drawn("O");
  const auto is_grey = [](const Colour& c) { return c.r > 0 && c.r < 255; };
  EXPECT_GT(std::count_if(picture.pixels.begin(), picture.pixels.end(), is_grey), 20);
}

TEST(Font, AlignsTextLeftCentreAndRight) {
  const Box left = inked(drawn("HHH"));
  const Box middle = inked(drawn("HHH", TextPlace::Align::centre));
  const Box right = inked(drawn("HHH", TextPlace::Align::right));
  EXPECT_GE(left.x, 100U);
  EXPECT_NEAR(static_cast<double>(middle.x) + 0.5 * static_cast<double>(middle.width), 100.0, 1.5);
  EXPECT_LE(right.x + right.width, 101U);
}

TEST(Font, ClipsTextToThePicture) {
  Picture picture = make_picture(20, 20, kBlack);
  draw_text(picture, {-10.0, 2.0}, "WWWWWW", {kSize, kWhite});
  draw_text(picture, {500.0, 500.0}, "W", {kSize, kWhite});
  EXPECT_GT(inked(picture).width, 5U);
}

}  // namespace
}  // namespace glidar
