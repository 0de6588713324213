// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io and glidar-import: both ends of the stream of an image, which is one item.

#include <glidar/io/decoder/decoder_process.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// An image of whichever samples its kind of input has.
struct PixelSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;  ///< channels of a texture, or the largest level of a grey image
};

void send_pixels(const PixelSize& size, std::span<const std::byte> bytes, RecordWriter& to);

struct ReceivedPixels {
  PixelSize size;
  std::vector<std::byte> bytes;
};

/// `bytes_of` returns the number of bytes that an image of this size has, or 0 when there is no
/// such image. Throws Error when the stream has others.
ReceivedPixels receive_pixels(DecoderRun run, std::uint64_t (*bytes_of)(const PixelSize& size));

}  // namespace glidar
