// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/zip_archive.hpp>

#include <glidar/io/model/texture_search.hpp>

#include <zip.h>

#include <algorithm>
#include <memory>

namespace glidar::import {
namespace {

using Archive = std::unique_ptr<zip_t, void (*)(zip_t*)>;

Archive open_zip(std::string_view archive) {
  zip_source_t* source = zip_source_buffer_create(archive.data(), archive.size(), 0, nullptr);
  zip_t* opened = source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, nullptr);
  if (opened == nullptr) zip_source_free(source);
  return {opened, zip_discard};
}

}  // namespace

std::string zip_text(std::string_view archive, const std::string& name, std::size_t max_bytes) {
  const Archive opened = open_zip(archive);
  zip_file_t* file = opened ? zip_fopen(opened.get(), name.c_str(), ZIP_FL_NOCASE) : nullptr;
  if (file == nullptr) return "";
  std::string text(max_bytes, '\0');
  const zip_int64_t size = zip_fread(file, text.data(), text.size());
  zip_fclose(file);
  text.resize(static_cast<std::size_t>(std::max<zip_int64_t>(size, 0)));
  return text;
}

std::vector<std::string> zip_names(std::string_view archive) {
  std::vector<std::string> names;
  const Archive opened = open_zip(archive);
  const zip_int64_t count = opened ? zip_get_num_entries(opened.get(), 0) : 0;
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(opened.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) names.emplace_back(name);
  }
  return names;
}

std::string zip_name(std::string_view reference) {
  if (reference.starts_with("./")) reference.remove_prefix(2);
  while (reference.starts_with('/')) reference.remove_prefix(1);
  return percent_decoded(std::string(reference));
}

}  // namespace glidar::import
