// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>
#include <import/text_cursor.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace glidar::import {

/// A model to read, and the files that it may read.
struct ReaderInput {
  const std::filesystem::path& model;  ///< canonical
  const ModelFolder& folder;
  ModelFiles& files;
  FileLog& log;

  /// The bytes of the model itself.
  [[nodiscard]] std::string_view bytes() const;
  /// The words of the model. UTF-16 is converted in `storage`, which must outlive the cursor; other
  /// texts are read as the cursor advances.
  [[nodiscard]] TextCursor text(std::string& storage, bool continues) const;
  /// The file itself, whose read bytes can be forgotten.
  [[nodiscard]] FileContent& content() const { return *files.content(model.string()); }
  /// Frees it.
  void release() const { files.release(model.string()); }
  /// A file that the model names, relative to its folder. Null, with a note in the log, if it is
  /// missing or must not be read.
  [[nodiscard]] std::shared_ptr<FileContent> companion(const std::string& name) const;
};

/// GLIDAR's own readers. Each statement of a file is used, or named in a note, or refused with
/// its line or byte.
SourceModel read_obj(const ReaderInput& input);
SourceModel read_ply(const ReaderInput& input);
SourceModel read_stl(const ReaderInput& input);
SourceModel read_off(const ReaderInput& input);

/// The reader for a file, by its first bytes and its extension; none: Assimp's.
using Reader = SourceModel (*)(const ReaderInput&);
Reader own_reader(const ReaderInput& input);

/// Errors of a file at a line, or at a byte from 0.
[[noreturn]] void refuse_line(std::uint64_t line, const std::string& found);
[[noreturn]] void refuse_byte(std::size_t byte, const std::string& found);

}  // namespace glidar::import
