// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/files/input_file.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace glidar {

using TextFileKind = InputFileKind;

/// The whole file, see read_input_file. Throws Error like read_input_file, and when it contains
/// zero bytes.
std::string read_text_file(const std::filesystem::path& file, const TextFileKind& kind);

/// Throws Error, with file and line, when a text is not UTF-8.
void require_utf8(const std::filesystem::path& file, std::string_view text);

/// A word of a file, shortened for an error; see excerpt().
std::string shown(std::string_view word);

}  // namespace glidar
