// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/model_files.hpp>

#include <import/open_beneath.hpp>

#include <glidar/io/files/content_hash.hpp>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <utility>

namespace glidar::import {
namespace {

/// Importers detect formats by the first bytes of a file. Files of unknown formats are read no
/// further.
constexpr std::size_t kFirstPiece = std::size_t{1} << 20U;

}  // namespace

void add_once(std::vector<std::string>& list, std::string item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(std::move(item));
}

/// Returns the number of bytes read, less than `size` only at the end of the file.
std::size_t FileContent::read_some(char* to, std::size_t size) {
  std::size_t have = 0;
  while (have < size) {
    const ssize_t got = ::read(file_.get(), to + have, size - have);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    have += static_cast<std::size_t>(got);
  }
  is_at_end_ = is_at_end_ || have < size;
  return have;
}

std::string_view FileContent::head(std::size_t end) {
  end = std::min(end, size_);
  if (end > bytes_.size() && !is_at_end_) {
    bytes_.reserve(end > kFirstPiece ? size_ : std::min(size_, kFirstPiece));
    const std::size_t have = bytes_.size();
    bytes_.resize(end);
    bytes_.resize(have + read_some(bytes_.data() + have, end - have));
  }
  return std::string_view(bytes_).substr(0, end);
}

const std::string& FileContent::hash() {
  if (!hash_.empty()) return hash_;
  hash_to(bytes_.size());
  // Not beyond the size that importers saw, although the file may have grown.
  std::size_t left = is_at_end_ ? 0 : size_ - bytes_.size();
  std::string piece(std::min(left, kFirstPiece), '\0');
  while (left > 0) {
    const std::size_t got = read_some(piece.data(), std::min(left, piece.size()));
    running_hash_.add(piece.data(), got);
    left = is_at_end_ ? 0 : left - got;
  }
  is_at_end_ = true;
  hash_ = hex(running_hash_.value());
  return hash_;
}

void FileContent::hash_to(std::size_t end) {
  if (end <= hashed_) return;
  running_hash_.add(bytes_.data() + hashed_, end - hashed_);
  hashed_ = end;
}

void FileContent::forget(const char* end) {
  const char* const begin = bytes_.data();
  if (std::less<>()(end, begin) || std::less<>()(begin + bytes_.size(), end)) return;
  // Whole pages, as the system frees them; the buffer begins anywhere.
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  if (forgotten_ == 0) forgotten_ = page - reinterpret_cast<std::uintptr_t>(begin) % page;
  const auto read = static_cast<std::size_t>(end - begin);
  next_forgotten_ = end + kFirstPiece;
  if (read < forgotten_ + kFirstPiece) return;
  hash_to(read);
  const std::size_t size = (read - forgotten_) / page * page;
  ::madvise(bytes_.data() + forgotten_, size, MADV_DONTNEED);
  forgotten_ += size;
}

ModelFiles::ModelFiles(const ModelFolder& folder) {
  for (const std::filesystem::path& root : folder.allowed())
    roots_.emplace_back(root, open_root(root));
}

std::shared_ptr<FileContent> ModelFiles::content(const std::string& path) {
  if (const auto known = entries_.find(path); known != entries_.end()) return known->second.content;
  const auto root = std::find_if(roots_.begin(), roots_.end(),
                                 [&](const auto& one) { return is_inside(path, one.first); });
  if (root == roots_.end()) return nullptr;
  UniqueFd file = open_beneath(root->second.get(), root->first, path);
  struct stat info {};
  if (!file || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode)) return nullptr;
  const auto content =
      std::make_shared<FileContent>(std::move(file), static_cast<std::size_t>(info.st_size));
  entries_.emplace(path, Entry{content, ""});
  paths_.push_back(path);
  total_bytes_ += content->size();
  return content;
}

void ModelFiles::release(const std::string& path) {
  const auto entry = entries_.find(path);
  if (entry == entries_.end() || entry->second.content == nullptr) return;
  entry->second.hash = entry->second.content->hash();
  entry->second.content = nullptr;
}

void ModelFiles::replace(const std::string& path, std::string content) {
  replacements_[path] = std::move(content);
}

const std::string* ModelFiles::replacement(const std::string& path) const {
  const auto found = replacements_.find(path);
  return found == replacements_.end() ? nullptr : &found->second;
}

std::vector<std::string> ModelFiles::hashes() {
  std::vector<std::string> all;
  for (const std::string& path : paths_) {
    const Entry& entry = entries_.at(path);
    all.push_back(entry.content == nullptr ? entry.hash : entry.content->hash());
  }
  return all;
}

}  // namespace glidar::import
