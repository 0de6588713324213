// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/decode_image.hpp>

#include <import/image_size.hpp>

#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <climits>
#include <memory>

namespace glidar::import {
namespace {

constexpr std::uint64_t kMaxSide = 16384;
constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;

/// The reason for not decoding an image of this size; empty: none.
std::string too_large(std::uint64_t width, std::uint64_t height, std::uint64_t channels,
                      std::uint64_t budget) {
  if (width == 0 || height == 0) return "it has no pixels";
  if (width > kMaxSide || height > kMaxSide) {
    return fmt::format("too large: {} x {}, allowed {} per side", width, height, kMaxSide);
  }
  const std::uint64_t bytes = width * height * channels;
  if (bytes > kMaxBytes) return "too large: more than 256 MiB when decoded";
  if (bytes > budget) return "the model's textures together are too large: more than 512 MiB";
  return "";
}

/// Drops an alpha channel that is opaque everywhere.
void drop_opaque_alpha(Texture& t) {
  if (t.channels != 2 && t.channels != 4) return;
  const std::size_t texels = std::size_t{t.width} * t.height;
  for (std::size_t i = 0; i < texels; ++i) {
    if (t.texels[(i + 1) * t.channels - 1] != 255) return;
  }
  const std::uint32_t fewer = t.channels - 1;
  for (std::size_t i = 0; i < texels; ++i) {
    std::copy_n(&t.texels[i * t.channels], fewer, &t.texels[i * fewer]);
  }
  t.texels.resize(texels * fewer);
  t.channels = fewer;
}

/// Khronos Texture 2.0, section 3.1.
bool is_ktx2(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 12> kMark = {0xAB, 'K',  'T',  'X',  ' ',  '2',
                                                  '0',  0xBB, '\r', '\n', 0x1A, '\n'};
  return bytes.size() >= kMark.size() && std::equal(kMark.begin(), kMark.end(), bytes.begin());
}

Decoded no_image(std::string reason) {
  return {{}, std::move(reason)};
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

/// RFC 4648, both alphabets; stops at the padding or any other character.
std::vector<std::uint8_t> base64_decoded(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) break;
    bits = (bits << 6U) | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return bytes;
}

}  // namespace

Decoded decode_image(std::span<const std::uint8_t> bytes, std::uint64_t budget) {
  int width = 0;
  int height = 0;
  int channels = 0;
  if (bytes.size() > INT_MAX) return no_image("the file is too large");
  const int size = static_cast<int>(bytes.size());
  if (is_ktx2(bytes)) {
    return no_image(
        "a KTX2 image (KHR_texture_basisu), which GLIDAR does not read: export the model "
        "with PNG or JPEG textures");
  }
  if (const auto declared = declared_size(bytes)) {
    std::string refused = too_large(declared->width, declared->height, 4, budget);
    if (!refused.empty()) return no_image(std::move(refused));
  }
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    return no_image("not an image that can be read (PNG, JPEG, BMP, TGA, GIF, PSD, HDR, PNM)");
  }
  if (width < 0 || height < 0 || channels < 1 || channels > 4) return no_image("broken");
  // Palettes may expand to more channels than in the header.
  std::string refused =
      too_large(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), 4, budget);
  if (!refused.empty()) return no_image(std::move(refused));
  const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 0), stbi_image_free);
  if (!texels) return no_image("broken, or too large for the memory limit");
  Decoded decoded;
  Texture& t = decoded.texture;
  t.width = static_cast<std::uint32_t>(width);
  t.height = static_cast<std::uint32_t>(height);
  t.channels = static_cast<std::uint32_t>(channels);
  t.texels.assign(texels.get(), texels.get() + std::size_t{t.width} * t.height * t.channels);
  drop_opaque_alpha(t);
  return decoded;
}

Decoded decode_embedded(const EmbeddedImage& image, std::uint64_t budget) {
  if (image.bytes.empty()) return no_image("empty");
  if (image.width == 0) return decode_image(image.bytes, budget);
  std::string refused = too_large(image.width, image.height, 4, budget);
  if (!refused.empty()) return no_image(std::move(refused));
  if (image.bytes.size() != std::size_t{4} * image.width * image.height) return no_image("broken");
  Decoded decoded;
  decoded.texture = {"", image.width, image.height, 4, image.bytes};
  drop_opaque_alpha(decoded.texture);
  return decoded;
}

std::vector<std::uint8_t> data_uri_bytes(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || uri.substr(0, comma).find("base64") == std::string::npos) {
    return {};
  }
  return base64_decoded(std::string_view(uri).substr(comma + 1));
}

Decoded decode_data_uri(const std::string& uri, std::uint64_t budget) {
  const std::vector<std::uint8_t> bytes = data_uri_bytes(uri);
  if (bytes.empty()) return no_image("a data URI that is not base64");
  return decode_image(bytes, budget);
}

}  // namespace glidar::import
