// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/io/decoder/decoder_process.hpp>

#include <filesystem>

namespace glidar {

/// Reads a PNG file as 8 bit texels, grey or rgb, with alpha where the file has it. Throws Error
/// when it is missing, corrupt or larger than 16384 pixels per side or 256 MiB of texels. The
/// sandboxed process glidar-import reads it.
Texture read_png_texture(const std::filesystem::path& file);

/// The same in this process: only in the sandboxed one, and for tests.
Texture read_png_texture_unconfined(const std::filesystem::path& file);
void send_png_texture(const std::filesystem::path& file, RecordWriter& to);
inline constexpr DecoderKind kTextureDecoder = {"texture", std::uint64_t{257} << 20U};

}  // namespace glidar
