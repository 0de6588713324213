// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/text_source.hpp>

#include <zip.h>

#include <charconv>
#include <memory>

namespace glidar::import {
namespace {

constexpr std::size_t kPiece = 65536;

std::shared_ptr<zip_t> open_zip(std::string_view archive) {
  zip_source_t* source = zip_source_buffer_create(archive.data(), archive.size(), 0, nullptr);
  if (source == nullptr) return nullptr;
  zip_t* opened = zip_open_from_source(source, ZIP_RDONLY, nullptr);
  if (opened == nullptr) zip_source_free(source);
  return {opened, [](zip_t* unused) {
            if (unused != nullptr) zip_discard(unused);
          }};
}

/// Decodes a percent-encoded character such as %20.
bool decode(std::string_view digits, char& decoded) {
  unsigned code = 0;
  const auto [stop, problem] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
  decoded = static_cast<char>(code);
  return digits.size() == 2 && problem == std::errc() && stop == digits.data() + digits.size();
}

}  // namespace

TextSource plain_text(std::string_view text) {
  return [text]() mutable {
    const std::string piece(text.substr(0, kPiece));
    text.remove_prefix(piece.size());
    return piece;
  };
}

TextSource zip_text(std::string_view archive, const std::string& name) {
  const std::shared_ptr<zip_t> opened = open_zip(archive);
  zip_file_t* found = opened ? zip_fopen(opened.get(), name.c_str(), ZIP_FL_NOCASE) : nullptr;
  // it is closed before its archive
  const std::shared_ptr<zip_file_t> part(found, [opened](zip_file_t* file) {
    if (file != nullptr) zip_fclose(file);
  });
  return [part] {
    std::string piece(part ? kPiece : 0, '\0');
    const zip_int64_t read = part ? zip_fread(part.get(), piece.data(), piece.size()) : 0;
    piece.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
    return piece;
  };
}

std::vector<std::string> zip_names(std::string_view archive) {
  std::vector<std::string> names;
  const std::shared_ptr<zip_t> opened = open_zip(archive);
  const zip_int64_t count = opened ? zip_get_num_entries(opened.get(), 0) : 0;
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(opened.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) names.emplace_back(name);
  }
  return names;
}

std::string zip_name(std::string_view reference) {
  if (reference.starts_with("./")) reference.remove_prefix(2);
  while (reference.starts_with("/")) reference.remove_prefix(1);
  std::string name;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    char decoded = reference[i];
    if (decoded == '%' && decode(reference.substr(i + 1, 2), decoded)) {
      i += 2;
    } else {
      decoded = reference[i];
    }
    name += decoded;
  }
  return name;
}

}  // namespace glidar::import
