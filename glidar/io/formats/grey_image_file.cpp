// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/grey_image_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/input_file.hpp>

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace glidar {
namespace {

constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;
constexpr std::uint32_t kMax8Bits = 255;
constexpr std::uint32_t kMax16Bits = 65535;
const InputFileKind kGreyPng = {"a PNG image", 1024, "crop or shrink the image"};

/// Data of the callbacks. libpng uses longjmp, which must not skip destructors, so errors are
/// stored here and thrown after it has returned.
struct PngReading {
  std::string file;
  std::size_t position = 0;
  char message[128] = {};
};

struct PngHeader {
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  int bits = 0;
  png_byte channels = 0;
  std::size_t row_bytes = 0;
};

void read_png_bytes(png_structp png, png_bytep to, std::size_t size) {
  PngReading& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (size > reading.file.size() - reading.position) png_error(png, "the file ends too early");
  std::memcpy(to, reading.file.data() + reading.position, size);
  reading.position += size;
}

void keep_png_error(png_structp png, png_const_charp message) {
  PngReading& reading = *static_cast<PngReading*>(png_get_error_ptr(png));
  std::strncpy(reading.message, message, sizeof(reading.message) - 1);
  png_longjmp(png, 1);
}

void ignore_png_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// False after an error. Nothing in this function has a destructor that longjmp could skip.
bool read_header(png_structp png, png_infop info, PngHeader& header) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  png_set_expand(png);  // palettes and fewer bits become 8 bits
  png_set_swap(png);    // 16 bits in memory order
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  header = {png_get_image_width(png, info), png_get_image_height(png, info),
            png_get_bit_depth(png, info), png_get_channels(png, info), png_get_rowbytes(png, info)};
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

/// libpng's objects.
class PngReader {
 public:
  explicit PngReader(PngReading& reading)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, keep_png_error,
                                    ignore_png_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    if (info_ != nullptr) png_set_read_fn(png_, &reading, read_png_bytes);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool header(PngHeader& header) { return info_ != nullptr && read_header(png_, info_, header); }
  bool rows(std::vector<png_bytep>& rows) { return read_rows(png_, rows.data()); }

 private:
  png_structp png_;
  png_infop info_;
};

std::uint16_t sample_at(const std::vector<png_byte>& bytes, std::size_t sample, int bits) {
  if (bits == 8) return bytes[sample];
  std::uint16_t value = 0;
  std::memcpy(&value, bytes.data() + 2 * sample, sizeof(value));
  return value;
}

/// The first channel; throws Error unless those of colour are equal.
GreyImage grey_of(const std::string& name, const PngHeader& header,
                  const std::vector<png_byte>& bytes) {
  GreyImage image = {header.width, header.height, header.bits == 8 ? kMax8Bits : kMax16Bits};
  const std::size_t pixels = std::size_t{header.width} * header.height;
  image.level.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t first = i * header.channels;
    image.level[i] = sample_at(bytes, first, header.bits);
    if (header.channels < 3) continue;
    if (sample_at(bytes, first + 1, header.bits) == image.level[i] &&
        sample_at(bytes, first + 2, header.bits) == image.level[i])
      continue;
    throw Error({name, fmt::format("pixel {},{} is coloured", i % header.width, i / header.width),
                 "a grey image", "convert it to grey levels"});
  }
  return image;
}

}  // namespace

GreyImage load_grey_image(const std::filesystem::path& path) {
  open_input_file(path, kGreyPng);  // the sandboxed process cannot look for similar names
  const ReceivedPixels pixels = receive_pixels(
      start_decoder(kGreyImageDecoder, path), [](const PixelSize& size) -> std::uint64_t {
        const std::uint64_t count = std::uint64_t{size.width} * size.height;
        const bool is_known = size.samples == kMax8Bits || size.samples == kMax16Bits;
        return is_known && count <= kMaxPixels ? count * sizeof(std::uint16_t) : 0;
      });
  GreyImage image = {pixels.size.width, pixels.size.height, pixels.size.samples};
  image.level.resize(pixels.bytes.size() / sizeof(std::uint16_t));
  std::memcpy(image.level.data(), pixels.bytes.data(), pixels.bytes.size());
  for (std::uint16_t& level : image.level)
    level = static_cast<std::uint16_t>(std::min<std::uint32_t>(level, pixels.size.samples));
  return image;
}

void send_grey_image(const std::filesystem::path& path, RecordWriter& to) {
  const GreyImage image = load_grey_image_unconfined(path);
  send_pixels({image.width, image.height, image.max_level}, std::as_bytes(std::span(image.level)),
              to);
}

GreyImage load_grey_image_unconfined(const std::filesystem::path& path) {
  PngReading reading;
  reading.file = read_input_file(path, kGreyPng);
  const auto fail = [&](const std::string& found) -> Error {
    return Error({path.string(), found, "a PNG image of grey levels", ""});
  };
  if (reading.file.size() < 8 ||
      png_sig_cmp(reinterpret_cast<png_const_bytep>(reading.file.data()), 0, 8) != 0) {
    throw fail("it is not a PNG image");
  }
  PngReader reader(reading);
  PngHeader header;
  if (!reader.header(header)) throw fail(fmt::format("it is damaged: {}", reading.message));
  if (std::uint64_t{header.width} * header.height > kMaxPixels) {
    throw Error({path.string(), fmt::format("has {}x{} pixels", header.width, header.height),
                 fmt::format("at most {} pixels", kMaxPixels), "crop or shrink the image"});
  }
  std::vector<png_byte> bytes(header.row_bytes * header.height);
  std::vector<png_bytep> rows(header.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = bytes.data() + y * header.row_bytes;
  if (!reader.rows(rows)) throw fail(fmt::format("it is damaged: {}", reading.message));
  return grey_of(path.string(), header, bytes);
}

}  // namespace glidar
