// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/staged_files.hpp>

#include <glidar/io/files/folder_lock.hpp>
#include <glidar/io/files/overwrite_guard.hpp>
#include <glidar/io/files/unfinished_files.hpp>

#include <optional>
#include <system_error>

namespace glidar {
namespace {

void remove_outdated(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure)) return;
  std::filesystem::remove(path, failure);
  if (!failure) return;
  throw Error({path.string(),
               "cannot remove this file, which belongs to an earlier output: " + failure.message(),
               "", "write to another folder"});
}

}  // namespace

AtomicFile& StagedFiles::add(const std::filesystem::path& path) {
  refuse_overwrite_of_inputs(protected_, path);
  return files_.emplace_back(path);
}

void StagedFiles::add_folder(const std::filesystem::path& path) {
  std::error_code failure;
  if (std::filesystem::create_directory(path, failure)) {
    const std::filesystem::path whole = std::filesystem::absolute(path);
    folders_.push_back({whole, list_unfinished(whole.native())});
  }
  if (!failure) return;
  throw Error({path.string(), "cannot create this folder: " + failure.message(), "",
               "write to another folder"});
}

void StagedFiles::commit() {
  std::optional<FolderLock> lock;
  if (!is_locked_ && files_.size() + removals_.size() > 1 && !files_.empty())
    lock.emplace(std::filesystem::absolute(files_.front().path()).parent_path());
  for (const std::filesystem::path& path : removals_) remove_outdated(path);
  removals_.clear();
  for (auto file = files_.rbegin(); file != files_.rend(); ++file) file->commit();
  files_.clear();
  unlist_folders();
}

void StagedFiles::clear() noexcept {
  files_.clear();
  removals_.clear();
  std::error_code ignored;  // a folder that is in use by now stays
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
    std::filesystem::remove(folder->path, ignored);
  unlist_folders();
}

void StagedFiles::unlist_folders() noexcept {
  for (const NewFolder& folder : folders_) unlist_unfinished(folder.slot);
  folders_.clear();
}

}  // namespace glidar
