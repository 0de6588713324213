// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/model/model_folder.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidar::import {

/// Files that were requested and not read, each once, in the order of requests.
struct FileLog {
  std::vector<std::string> absent;  ///< missing, or not allowed to be read
  std::vector<std::string> notes;   ///< messages for the user about them
};

void add_once(std::vector<std::string>& list, std::string item);

/// A private copy of a file, read as far as needed. Every byte is read from the file once, so that
/// the parser and the hash see the same bytes even if the file changes.
class FileContent {
 public:
  FileContent(UniqueFd file, std::size_t size) : file_(std::move(file)), size_(size) {}
  [[nodiscard]] std::size_t size() const { return size_; }  ///< when the file was opened
  /// The first `end` bytes, fewer if the file is shorter.
  std::string_view head(std::size_t end);
  std::string_view whole() { return head(size_); }
  /// Hexadecimal hash of the whole file. Bytes that were not read before are hashed but not kept,
  /// and cannot be read afterwards.
  const std::string& hash();
  /// Frees the memory of the bytes before `end`, of those that were read, in large pieces; they are
  /// 0 afterwards. Nothing if `end` is in another text.
  void forget_before(const char* end) {
    if (!std::less<>()(end, next_forgotten_)) forget(end);
  }

 private:
  std::size_t read_some(char* to, std::size_t size);
  void hash_to(std::size_t end);
  void forget(const char* end);

  UniqueFd file_;
  std::size_t size_;
  std::string bytes_;
  ContentHash running_hash_;
  std::size_t hashed_ = 0;                ///< so many bytes are in it
  std::string hash_;                      ///< empty until it is known
  const char* next_forgotten_ = nullptr;  ///< end of the next piece
  std::size_t forgotten_ = 0;             ///< end of the pages that were freed
  bool is_at_end_ = false;
};

/// The files of a model, each opened once.
class ModelFiles {
 public:
  explicit ModelFiles(const ModelFolder& folder);

  /// The content of a regular file below the model's root or a texture folder; `path` is canonical.
  /// Null if it cannot be opened.
  std::shared_ptr<FileContent> content(const std::string& path);
  /// Frees the content of a file that is no longer needed; keeps its hash.
  void release(const std::string& path);

  /// Makes importers read `content` instead of a file. The hash is still that of the file. The path
  /// need not exist.
  void replace(const std::string& path, std::string content);
  /// The replacement of this file for importers; null: the file itself.
  [[nodiscard]] const std::string* replacement(const std::string& path) const;

  /// Canonical paths of all files that were opened, in the order of opening.
  [[nodiscard]] const std::vector<std::string>& paths() const { return paths_; }
  /// Size of all of them together.
  [[nodiscard]] std::uint64_t total_bytes() const { return total_bytes_; }
  /// Hexadecimal hashes of their content, in the same order.
  std::vector<std::string> hashes();

 private:
  struct Entry {
    std::shared_ptr<FileContent> content;
    std::string hash;  ///< empty until it is known
  };

  std::vector<std::pair<std::filesystem::path, UniqueFd>> roots_;
  std::vector<std::string> paths_;
  std::uint64_t total_bytes_ = 0;
  std::map<std::string, Entry> entries_;
  std::map<std::string, std::string> replacements_;
};

}  // namespace glidar::import
