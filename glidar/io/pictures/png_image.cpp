// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/pictures/png_image.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/function_ref.hpp>

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <exception>
#include <string>
#include <vector>

namespace glidar {
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
