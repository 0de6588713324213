// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/text_source.hpp>

#include <zip.h>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include <charconv>
#include <memory>

namespace glidar::import {
namespace {

constexpr std::size_t kPiece = 65536;

std::shared_ptr<zip_t> open_zip(const std::string& archive) {
  return {zip_open(archive.c_str(), ZIP_RDONLY, nullptr), [](zip_t* opened) {
            if (opened != nullptr) zip_discard(opened);
          }};
}

/// A character that is written as %20 and the like.
bool decode(std::string_view digits, char& decoded) {
  unsigned code = 0;
  const auto [stop, problem] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
  decoded = static_cast<char>(code);
  return digits.size() == 2 && problem == std::errc() && stop == digits.data() + digits.size();
}

}  // namespace

TextSource file_text(Assimp::IOSystem& files, const std::string& name) {
  const std::shared_ptr<Assimp::IOStream> stream(files.Open(name.c_str(), "rb"),
                                                 [&files](Assimp::IOStream* opened) {
                                                   if (opened != nullptr) files.Close(opened);
                                                 });
  return [stream] {
    std::string piece(stream ? kPiece : 0, '\0');
    if (stream) piece.resize(stream->Read(piece.data(), 1, piece.size()));
    return piece;
  };
}

TextSource zip_text(const std::string& archive, const std::string& name) {
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

std::vector<std::string> zip_names(const std::string& archive) {
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
