// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/picture.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/function_ref.hpp>

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <exception>
#include <string>
#include <vector>

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

namespace {

constexpr int kCompressionLevel = 4;  // twice as fast as libpng's default, a few percent larger

/// Receives the bytes of a file, in order.
using PngBytes = FunctionRef<void(std::span<const std::byte>)>;

/// Data of the callbacks. libpng uses longjmp, which must not skip exceptions or destructors, so
/// errors are stored here and thrown after it has returned.
struct Writing {
  PngBytes write;
  std::exception_ptr failure;
  std::string message;
};

void on_bytes(png_structp png, png_bytep bytes, std::size_t size) {
  Writing& writing = *static_cast<Writing*>(png_get_io_ptr(png));
  try {
    writing.write(std::as_bytes(std::span(bytes, size)));
    return;
  } catch (...) {
    writing.failure = std::current_exception();
  }
  png_error(png, "cannot write");
}

void on_flush(png_structp /*png*/) {}

void on_error(png_structp png, png_const_charp message) {
  static_cast<Writing*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void put_text(png_structp png, png_infop info, const std::string& description) {
  if (description.empty()) return;
  std::string key = "Description";
  std::string value = description;
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key.data();
  text.text = value.data();
  png_set_text(png, info, &text, 1);
}

struct PixelForm {
  int bits;    ///< of a channel
  int colour;  ///< libpng's constant
  std::size_t bytes;
};

PixelForm form_of(PngKind kind) {
  switch (kind) {
    case PngKind::grey8:
      return {8, PNG_COLOR_TYPE_GRAY, 1};
    case PngKind::grey16:
      return {16, PNG_COLOR_TYPE_GRAY, 2};
    case PngKind::rgb16:
      return {16, PNG_COLOR_TYPE_RGB, 6};
    case PngKind::rgba8:
      return {8, PNG_COLOR_TYPE_RGB_ALPHA, 4};
    default:
      return {8, PNG_COLOR_TYPE_RGB, 3};
  }
}

/// False after an error. Nothing in this function has a destructor that longjmp could skip.
bool encode(png_structp png, png_infop info, const PngImage& image, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const PixelForm form = form_of(image.kind);
  png_set_compression_level(png, kCompressionLevel);
  png_set_IHDR(png, info, image.width, image.height, form.bits, form.colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (form.bits == 16) png_set_swap(png);  // the file is big-endian
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

std::vector<png_bytep> rows_of(const PngImage& image) {
  const std::size_t stride = std::size_t{image.width} * form_of(image.kind).bytes;
  std::vector<png_bytep> rows(image.height);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    // libpng only reads the pixels
    rows[row] = const_cast<png_bytep>(
        reinterpret_cast<png_const_bytep>(image.pixels.data() + row * stride));
  }
  return rows;
}

/// Passes the bytes of the file on; `where` appears in errors.
void encode_to(const PngImage& image, PngBytes write, const std::string& where) {
  Writing writing{write, nullptr, {}};
  std::vector<png_bytep> rows = rows_of(image);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, on_error, on_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &writing, on_bytes, on_flush);
    put_text(png, info, image.description);
    written = encode(png, info, image, rows.data());
  }
  png_destroy_write_struct(&png, &info);
  if (writing.failure) std::rethrow_exception(writing.failure);
  if (!written) {
    throw Error({where, fmt::format("cannot write the PNG: {}", writing.message)});
  }
}

}  // namespace

void write_png(const PngImage& image, AtomicFile& file) {
  const auto write = [&](std::span<const std::byte> bytes) { file.write(bytes); };
  encode_to(image, PngBytes(write), file.path().string());
}

std::vector<std::byte> encode_png(const PngImage& image) {
  std::vector<std::byte> file;
  const auto write = [&](std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
  };
  encode_to(image, PngBytes(write), "PNG image");
  return file;
}

void write_png(const Picture& picture, const std::string& description, AtomicFile& file) {
  write_png({PngKind::rgb8, static_cast<std::uint32_t>(picture.width),
             static_cast<std::uint32_t>(picture.height), std::as_bytes(std::span(picture.pixels)),
             description},
            file);
}

}  // namespace glidar
