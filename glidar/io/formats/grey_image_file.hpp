// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/raw_images.hpp>
#include <glidar/io/decoder/decoder_process.hpp>

#include <filesystem>

namespace glidar {

/// A PNG of 8 or 16 bits: grey, or colours with equal channels, of which an alpha channel is
/// ignored. The sandboxed process glidar-import reads it. Throws Error when it cannot be read, is
/// no PNG, is damaged, has colours, or more than 2^26 pixels.
GreyImage load_grey_image(const std::filesystem::path& path);

/// The same in this process: only in the sandboxed one, and for tests.
GreyImage load_grey_image_unconfined(const std::filesystem::path& path);
void send_grey_image(const std::filesystem::path& path, RecordWriter& to);
inline constexpr DecoderKind kGreyImageDecoder = {"grey_image", std::uint64_t{160} << 20U};

}  // namespace glidar
