// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/zip_archive.hpp>

#include <import/source_model.hpp>

#include <glidar/io/model/texture_search.hpp>

#include <algorithm>
#include <new>

namespace glidar::import {
namespace {

zip_t* open_zip(std::string_view bytes) {
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
  zip_t* opened = source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, nullptr);
  if (opened == nullptr) zip_source_free(source);
  return opened;
}

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes)
    : archive_(open_zip(bytes), zip_discard), bytes_(bytes.size()) {}

std::string ZipArchive::text(const std::string& name, std::size_t max_bytes) const {
  zip_file_t* file = archive_ ? zip_fopen(archive_.get(), name.c_str(), ZIP_FL_NOCASE) : nullptr;
  if (file == nullptr) return "";
  std::string text(max_bytes, '\0');
  const zip_int64_t size = zip_fread(file, text.data(), text.size());
  zip_fclose(file);
  text.resize(static_cast<std::size_t>(std::max<zip_int64_t>(size, 0)));
  return text;
}

std::string ZipArchive::content(const std::string& name) const {
  zip_stat_t state;
  const bool is_known = archive_ && zip_stat(archive_.get(), name.c_str(), 0, &state) == 0;
  constexpr zip_uint64_t kMostPerByte = 1100;  // deflate gives 1032 at most
  const bool is_possible = is_known && state.size / kMostPerByte <= bytes_;
  zip_file_t* file = is_possible ? zip_fopen(archive_.get(), name.c_str(), 0) : nullptr;
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> closed(file, zip_fclose);
  std::string content(file == nullptr ? 0 : state.size, '\0');
  // The last read checks the checksum.
  const bool is_whole =
      file != nullptr &&
      zip_fread(file, content.data(), content.size()) == static_cast<zip_int64_t>(content.size()) &&
      zip_fread(file, &state, 1) == 0;
  if (!is_whole) {
    throw Refusal{"its archive is damaged: '" + name.substr(0, 80) + "' cannot be unpacked",
                  "export or download the file again"};
  }
  return content;
}

std::string make_zip(const std::map<std::string, std::string>& files) {
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  if (target == nullptr) throw std::bad_alloc();
  zip_source_keep(target);
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> kept(target, zip_source_free);
  zip_t* made = zip_open_from_source(target, ZIP_TRUNCATE, nullptr);
  if (made == nullptr) throw std::bad_alloc();
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(made, content.data(), content.size(), 0);
    const zip_int64_t index = zip_file_add(made, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) throw std::bad_alloc();
    zip_set_file_compression(made, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
  }
  if (zip_close(made) != 0 || zip_source_open(target) != 0) throw std::bad_alloc();
  zip_stat_t state;
  zip_source_stat(target, &state);
  std::string archive(state.size, '\0');
  zip_source_read(target, archive.data(), archive.size());
  zip_source_close(target);
  return archive;
}

std::vector<std::string> ZipArchive::names() const {
  std::vector<std::string> all;
  const zip_int64_t count = archive_ ? zip_get_num_entries(archive_.get(), 0) : 0;
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) all.emplace_back(name);
  }
  return all;
}

std::string zip_name(std::string_view reference) {
  if (reference.starts_with("./")) reference.remove_prefix(2);
  while (reference.starts_with('/')) reference.remove_prefix(1);
  return percent_decoded(std::string(reference));
}

}  // namespace glidar::import
