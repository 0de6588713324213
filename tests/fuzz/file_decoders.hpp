// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace glidar::testing {

/// A reader of one kind of file.
struct FileDecoder {
  std::string_view name;       ///< of its corpus, tests/fuzz/corpus/NAME.zip
  std::string_view file_name;  ///< readers go by it
  void (*read)(const std::filesystem::path& file);
};

/// All of them.
std::span<const FileDecoder> file_decoders();

/// Throws std::out_of_range where there is none of this name.
const FileDecoder& file_decoder(std::string_view name);

/// Gives the bytes to a reader as a file; true when it takes them, false when it throws Error. No
/// other exception is caught: none may come.
bool try_file_decoder(const FileDecoder& decoder, std::span<const std::byte> bytes);

}  // namespace glidar::testing
