// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/confined_io.hpp>

#include <fmt/format.h>
#include <assimp/IOStream.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace glidar::import {
namespace {

/// Some importers request lines after the end of a file forever. Others notice the end after a few
/// attempts.
constexpr unsigned kMaxReadsOfNothing = 10'000;

/// Ends such an importer; Assimp reports its text as the reason of the failure.
class EndlessReading : public std::runtime_error {
 public:
  EndlessReading() : std::runtime_error("the file ends too early, its data is cut off") {}
};

/// Reads a file's private copy, or a replacement text, with the semantics of std::fread and fseek.
class ReadStream : public Assimp::IOStream {
 public:
  explicit ReadStream(std::shared_ptr<FileContent> file)
      : file_(std::move(file)), size_(file_->size()) {}
  explicit ReadStream(std::string_view text) : text_(text), size_(text.size()) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0) return 0;
    const std::size_t wanted = count > kMax / size ? kMax : size * count;
    const std::string_view bytes = up_to(wanted > kMax - at_ ? kMax : at_ + wanted);
    const std::string_view got = bytes.substr(std::min(at_, bytes.size()));
    std::memcpy(buffer, got.data(), got.size());
    at_ += got.size();
    reads_of_nothing_ = got.size() >= size ? 0 : reads_of_nothing_ + 1;
    if (reads_of_nothing_ > kMaxReadsOfNothing) throw EndlessReading();
    return got.size() / size;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : size_;
    const std::size_t target = from + offset;  // a negative offset wraps
    if (target > kMax / 2) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  [[nodiscard]] std::size_t Tell() const override { return at_; }
  [[nodiscard]] std::size_t FileSize() const override { return size_; }
  void Flush() override {}

 private:
  static constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::string_view up_to(std::size_t end) const {
    return file_ != nullptr ? file_->head(end) : text_.substr(0, end);
  }

  std::shared_ptr<FileContent> file_;  ///< null: `text_`
  std::string_view text_;
  std::size_t size_;
  std::size_t at_ = 0;
  unsigned reads_of_nothing_ = 0;  ///< consecutive, regardless of seeks in between
};

/// The path for messages: relative to the model's folder, and limited in length.
std::string shown_name(std::string name, const ModelFolder& folder) {
  const std::string prefix = folder.folder.string() + "/";
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  constexpr std::size_t kLongest = 120;
  if (name.size() > kLongest) name = name.substr(0, kLongest) + "...";
  return name;
}

}  // namespace

ConfinedIo::ConfinedIo(ModelFolder folder, ModelFiles& files, InputLimits& limits, FileLog& log)
    : folder_(std::move(folder)), files_(files), limits_(limits), log_(log) {}

ConfinedFile ConfinedIo::find(const char* path) const {
  std::string tidy = path;
  if (files_.replacement(tidy) != nullptr) return {Access::granted, tidy};
  ConfinedFile file = confine(tidy, folder_);
  if (file.access == Access::granted) return file;
  add_once(log_.absent, tidy);
  std::replace(tidy.begin(), tidy.end(), '\\', '/');
  if (tidy == path) return file;
  file = confine(tidy, folder_);
  if (file.access != Access::granted) add_once(log_.absent, tidy);
  return file;
}

bool ConfinedIo::Exists(const char* path) const {
  return find(path).access == Access::granted;
}

Assimp::IOStream* ConfinedIo::Open(const char* path, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  const ConfinedFile file = find(path);
  if (file.access != Access::granted) {
    add_once(log_.notes,
             fmt::format("'{}' is not read: {}", shown_name(path, folder_), reason(file.access)));
    return nullptr;
  }
  if (const std::string* text = files_.replacement(file.path.string())) {
    return new ReadStream(*text);
  }
  std::shared_ptr<FileContent> content = files_.content(file.path.string());
  if (content == nullptr) {
    add_once(log_.notes, fmt::format("'{}' cannot be opened", shown_name(path, folder_)));
    add_once(log_.absent, path);
    return nullptr;
  }
  limits_.set_input(files_.total_bytes());
  return new ReadStream(std::move(content));
}

void ConfinedIo::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace glidar::import
