// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/png_texture.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/input_file.hpp>

#include <png.h>

#include <cstring>
#include <memory>
#include <span>

namespace glidar {
namespace {

constexpr std::uint32_t kMaxSide = 16384;
const InputFileKind kPng = {"a PNG file", 512, ""};
constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;

[[noreturn]] void refuse(const std::filesystem::path& file, std::string found) {
  throw Error({.where = file.string(),
               .found = std::move(found),
               .allowed = "a PNG file of at most 16384 pixels per side and 256 MiB of texels"});
}

}  // namespace

Texture read_png_texture(const std::filesystem::path& file) {
  open_input_file(file, kPng);  // the sandboxed process cannot look for similar names
  const ReceivedPixels pixels = receive_pixels(
      start_decoder(kTextureDecoder, file), [](const PixelSize& size) -> std::uint64_t {
        const bool is_allowed = size.width <= kMaxSide && size.height <= kMaxSide &&
                                size.samples >= 1 && size.samples <= 4;
        const std::uint64_t bytes = std::uint64_t{size.width} * size.height * size.samples;
        return is_allowed && bytes <= kMaxBytes ? bytes : 0;
      });
  Texture texture{.name = file.string(),
                  .width = pixels.size.width,
                  .height = pixels.size.height,
                  .channels = pixels.size.samples,
                  .texels = {}};
  texture.texels.resize(pixels.bytes.size());
  std::memcpy(texture.texels.data(), pixels.bytes.data(), pixels.bytes.size());
  return texture;
}

void send_png_texture(const std::filesystem::path& file, RecordWriter& to) {
  const Texture texture = read_png_texture_unconfined(file);
  send_pixels({texture.width, texture.height, texture.channels},
              std::as_bytes(std::span(texture.texels)), to);
}

Texture read_png_texture_unconfined(const std::filesystem::path& file) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, void (*)(png_image*)> owner(&image, png_image_free);
  const std::string bytes = read_input_file(file, kPng);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    refuse(file, image.message);
  image.format &= PNG_FORMAT_FLAG_COLOR | PNG_FORMAT_FLAG_ALPHA;  // 8 bits, no palette
  Texture texture{.name = file.string(),
                  .width = image.width,
                  .height = image.height,
                  .channels = PNG_IMAGE_SAMPLE_CHANNELS(image.format),
                  .texels = {}};
  const std::size_t texels = std::size_t{image.width} * image.height * texture.channels;
  if (image.width > kMaxSide || image.height > kMaxSide || texels > kMaxBytes) {
    refuse(file, std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels");
  }
  texture.texels.resize(texels);
  if (png_image_finish_read(&image, nullptr, texture.texels.data(), 0, nullptr) == 0) {
    refuse(file, image.message);
  }
  return texture;
}

}  // namespace glidar
