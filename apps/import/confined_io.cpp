// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/confined_io.hpp>

#include <fmt/format.h>
#include <assimp/IOStream.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace glidar::import {
namespace {

/// Some importers ask for the next line of a file that has ended until one comes. Honest ones
/// notice the end after a few attempts.
constexpr unsigned kMostReadsOfNothing = 10'000;

/// Ends such an importer: Assimp takes its words for the reason of failure.
class EndlessReading : public std::runtime_error {
 public:
  EndlessReading() : std::runtime_error("the file ends too early, its data is cut off") {}
};

class ReadStream : public Assimp::IOStream {
 public:
  ReadStream(std::FILE* file, std::size_t size) : file_(file), size_(size) {}
  ~ReadStream() override { std::fclose(file_); }
  ReadStream(const ReadStream&) = delete;
  ReadStream& operator=(const ReadStream&) = delete;

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0) return 0;
    const std::size_t got = std::fread(buffer, size, count, file_);
    reads_of_nothing_ = got > 0 ? 0 : reads_of_nothing_ + 1;
    if (reads_of_nothing_ > kMostReadsOfNothing) throw EndlessReading();
    return got;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const int from = origin == aiOrigin_SET   ? SEEK_SET
                     : origin == aiOrigin_CUR ? SEEK_CUR
                                              : SEEK_END;
    const int failed = std::fseek(file_, static_cast<long>(offset), from);
    return failed == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
  }
  std::size_t Tell() const override { return static_cast<std::size_t>(std::ftell(file_)); }
  std::size_t FileSize() const override { return size_; }
  void Flush() override {}

 private:
  std::FILE* file_;
  std::size_t size_;
  unsigned reads_of_nothing_ = 0;  ///< one after another, whatever was sought in between
};

/// For messages: without the model's folder, and not too long.
std::string shown(std::string name, const ModelFolder& folder) {
  const std::string prefix = folder.folder.string() + "/";
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  constexpr std::size_t kLongest = 120;
  if (name.size() > kLongest) name = name.substr(0, kLongest) + "...";
  return name;
}

}  // namespace

void add_once(std::vector<std::string>& list, std::string item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(std::move(item));
}

ConfinedIo::ConfinedIo(ModelFolder folder, std::shared_ptr<FileLog> log)
    : folder_(std::move(folder)), log_(std::move(log)) {}

ConfinedFile ConfinedIo::find(const char* path) const {
  std::string tidy = path;
  ConfinedFile file = confine(tidy, folder_);
  if (file.access == Access::granted) return file;
  add_once(log_->absent, tidy);
  std::replace(tidy.begin(), tidy.end(), '\\', '/');
  if (tidy == path) return file;
  file = confine(tidy, folder_);
  if (file.access != Access::granted) add_once(log_->absent, tidy);
  return file;
}

bool ConfinedIo::Exists(const char* path) const {
  return find(path).access == Access::granted;
}

Assimp::IOStream* ConfinedIo::Open(const char* path, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  const ConfinedFile file = find(path);
  if (file.access != Access::granted) {
    add_once(log_->notes,
             fmt::format("'{}' is not read: {}", shown(path, folder_), reason(file.access)));
    return nullptr;
  }
  std::FILE* opened = std::fopen(file.path.c_str(), "rbe");
  if (opened == nullptr) {
    add_once(log_->notes, fmt::format("'{}' cannot be opened", shown(path, folder_)));
    add_once(log_->absent, path);
    return nullptr;
  }
  add_once(log_->read, file.path.string());
  return new ReadStream(opened, std::filesystem::file_size(file.path));
}

void ConfinedIo::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace glidar::import
