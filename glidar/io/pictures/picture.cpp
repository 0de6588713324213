// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

constexpr std::array kViridis = std::to_array<Colour>(
    {{68, 1, 84},    {71, 13, 96},   {72, 24, 106},  {72, 35, 116},  {71, 45, 123},  {69, 55, 129},
     {66, 64, 134},  {62, 73, 137},  {59, 82, 139},  {55, 91, 141},  {51, 99, 141},  {47, 107, 142},
     {44, 114, 142}, {41, 122, 142}, {38, 130, 142}, {35, 137, 142}, {33, 145, 140}, {31, 152, 139},
     {31, 160, 136}, {34, 167, 133}, {40, 174, 128}, {50, 182, 122}, {63, 188, 115}, {78, 195, 107},
     {94, 201, 98},  {112, 207, 87}, {132, 212, 75}, {152, 216, 62}, {173, 220, 48}, {194, 223, 35},
     {216, 226, 25}, {236, 229, 27}, {253, 231, 37}});

constexpr std::array kCategories = std::to_array<Colour>({{86, 180, 233},
                                                          {240, 128, 48},
                                                          {64, 192, 96},
                                                          {236, 104, 168},
                                                          {214, 200, 72},
                                                          {172, 124, 232},
                                                          {72, 214, 204},
                                                          {224, 72, 72},
                                                          {164, 216, 84},
                                                          {96, 120, 240},
                                                          {190, 140, 100},
                                                          {255, 222, 160}});

std::uint8_t level(double t) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(t, 0.0, 1.0)));
}

}  // namespace

Picture make_picture(std::size_t width, std::size_t height, Colour background) {
  return {width, height, std::vector<Colour>(width * height, background)};
}

void fill(Picture& picture, const Box& box, Colour colour) {
  if (box.x >= picture.width) return;
  const std::size_t width = std::min(box.width, picture.width - box.x);
  const std::size_t bottom = std::min(box.y + box.height, picture.height);
  for (std::size_t row = box.y; row < bottom; ++row)
    std::fill_n(&picture.pixels[row * picture.width + box.x], width, colour);
}

Colour viridis(double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(kViridis.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double part = place - static_cast<double>(below);
  const auto mix = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * part));
  };
  const Colour& a = kViridis[below];
  const Colour& b = kViridis[below + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

Colour grey(double t) {
  return {level(t), level(t), level(t)};
}

Colour light_grey(double t) {
  constexpr double kDarkest = 0.28;
  return grey(kDarkest + (1.0 - kDarkest) * t);
}

Colour hue(double turn) {
  const double sixth = 6.0 * (turn - std::floor(turn));
  return {level(std::abs(sixth - 3.0) - 1.0), level(2.0 - std::abs(sixth - 2.0)),
          level(2.0 - std::abs(sixth - 4.0))};
}

Colour category_colour(std::uint32_t number) {
  constexpr double kGoldenSection = 0.6180339887498949;
  constexpr double kFirst = 0.08;
  if (number < kCategories.size()) return kCategories.at(number);
  return hue(kFirst + kGoldenSection * number);
}

}  // namespace glidar
