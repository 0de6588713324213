// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model_folder.hpp>

#include <assimp/IOSystem.hpp>

#include <memory>
#include <string>
#include <vector>

namespace glidar::import {

/// Every file that was asked for, each once, in the order of asking.
struct FileLog {
  std::vector<std::string> read;    ///< canonical paths
  std::vector<std::string> absent;  ///< not there, or not to be read
  std::vector<std::string> notes;   ///< what the user should know of the latter
};

void add_once(std::vector<std::string>& list, std::string item);

/// Assimp's view of the files: reading only, regular files inside the model's root only.
class ConfinedIo : public Assimp::IOSystem {
 public:
  ConfinedIo(ModelFolder folder, std::shared_ptr<FileLog> log);
  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

 private:
  [[nodiscard]] ConfinedFile find(const char* path) const;

  ModelFolder folder_;
  std::shared_ptr<FileLog> log_;  ///< Assimp owns this object, the log outlives it
};

}  // namespace glidar::import
