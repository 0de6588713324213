// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/decode_image.hpp>

#include <import/gltf/data_uri.hpp>
#include <import/image_size.hpp>

#include <fmt/format.h>
#include <stb/stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <climits>
#include <memory>
#include <numeric>
#include <utility>

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

bool is_webp(std::span<const std::uint8_t> bytes) {
  return WebPGetInfo(bytes.data(), bytes.size(), nullptr, nullptr) != 0;
}

Decoded decode_webp(std::span<const std::uint8_t> bytes, std::uint64_t budget) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
    return no_image("broken");
  }
  if (features.has_animation != 0) return no_image("an animated WebP image");
  const auto width = static_cast<std::uint32_t>(features.width);
  const auto height = static_cast<std::uint32_t>(features.height);
  const std::uint32_t channels = features.has_alpha != 0 ? 4 : 3;
  std::string refused = too_large(width, height, channels, budget);
  if (!refused.empty()) return no_image(std::move(refused));
  Decoded decoded;
  Texture& t = decoded.texture;
  t.width = width;
  t.height = height;
  t.channels = channels;
  t.texels.resize(std::size_t{width} * height * channels);
  const auto decode = channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  const int stride = static_cast<int>(width * channels);
  if (decode(bytes.data(), bytes.size(), t.texels.data(), t.texels.size(), stride) == nullptr) {
    return no_image("broken, or too large for the memory limit");
  }
  drop_opaque_alpha(t);
  return decoded;
}

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 1 && bytes[0] == 0xFF && bytes[1] == 0xD8;
}

/// Calls `visit` with the code of each segment of a JPEG (ITU-T T.81, annex B) and its content,
/// which may be cut off, without those in its thumbnails and after its end.
template <class Visit>
void for_segments(std::span<const std::uint8_t> jpeg, const Visit& visit) {
  constexpr std::uint8_t kMarker = 0xFF;
  constexpr std::uint8_t kEnd = 0xD9;
  for (std::size_t at = 2; at + 3 < jpeg.size();) {
    const std::uint8_t code = jpeg[at + 1];
    const bool is_data = jpeg[at] != kMarker || code == 0 || code == kMarker ||
                         (code >= 0xD0 && code < kEnd);  // restarts have no content
    if (is_data) {
      ++at;
      continue;
    }
    if (code == kEnd) break;
    const std::size_t size = (std::size_t{jpeg[at + 2]} << 8U) + jpeg[at + 3];
    const auto rest = jpeg.subspan(at + 2);
    visit(code, rest.first(std::min(size, rest.size())));
    at += 2 + size;
  }
}

/// Huffman tables with more than 256 codes, for which stb_image has no room, or that do not end
/// with their segment (ITU-T T.81, B.2.4.2).
bool has_broken_tables(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kTables = 0xC4;
  constexpr std::size_t kLengths = 16;
  bool is_broken = false;
  for_segments(bytes, [&](std::uint8_t code, std::span<const std::uint8_t> segment) {
    if (code != kTables) return;
    std::size_t at = 2;
    while (at + kLengths < segment.size()) {
      const auto counts = segment.subspan(at + 1, kLengths);
      const std::size_t codes = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
      is_broken = is_broken || codes > 256;
      at += 1 + kLengths + codes;
    }
    is_broken = is_broken || at != segment.size();
  });
  return is_broken;
}

/// Each scan of a progressive JPEG costs time for all texels, however small it is.
bool has_too_many_scans(std::span<const std::uint8_t> bytes, std::uint64_t texels) {
  constexpr std::uint64_t kAlways = 32;                         // encoders write about ten
  constexpr std::uint64_t kMostWork = std::uint64_t{1} << 29U;  // texels: about a second
  constexpr std::uint8_t kScan = 0xDA;
  std::uint64_t scans = 0;
  for_segments(bytes, [&](std::uint8_t code, auto) { scans += code == kScan ? 1 : 0; });
  return scans > std::max(kAlways, kMostWork / std::max<std::uint64_t>(texels, 1));
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
  if (is_webp(bytes)) return decode_webp(bytes, budget);
  if (const auto declared = declared_size(bytes)) {
    std::string refused = too_large(declared->width, declared->height, 4, budget);
    if (!refused.empty()) return no_image(std::move(refused));
  }
  if (is_jpeg(bytes) && has_broken_tables(bytes)) return no_image("broken: its Huffman tables");
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    return no_image(
        "not an image that can be read (PNG, JPEG, WebP, BMP, TGA, GIF, PSD, HDR, PNM)");
  }
  if (width < 0 || height < 0 || channels < 1 || channels > 4) return no_image("broken");
  // Palettes may expand to more channels than in the header.
  std::string refused =
      too_large(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), 4, budget);
  if (!refused.empty()) return no_image(std::move(refused));
  const std::uint64_t texels_of_all =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (is_jpeg(bytes) && has_too_many_scans(bytes, texels_of_all))
    return no_image("a JPEG with too many scans for its size");
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

Decoded decode_embedded(EmbeddedImage image, std::uint64_t budget) {
  if (image.bytes.empty()) return no_image("empty");
  if (image.width == 0) return decode_image(image.bytes, budget);
  std::string refused = too_large(image.width, image.height, 4, budget);
  if (!refused.empty()) return no_image(std::move(refused));
  if (image.bytes.size() != std::size_t{4} * image.width * image.height) return no_image("broken");
  Decoded decoded;
  decoded.texture = {"", image.width, image.height, 4, std::move(image.bytes)};
  drop_opaque_alpha(decoded.texture);
  return decoded;
}

Decoded decode_data_uri(const std::string& uri, std::uint64_t budget) {
  const auto content = gltf::data_uri_content(uri);
  if (!content) return no_image("a malformed data URI");
  return decode_image({reinterpret_cast<const std::uint8_t*>(content->data()), content->size()},
                      budget);
}

}  // namespace glidar::import
