// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/process_limits.hpp>

#include <glidar/io/model/model_folder.hpp>

#include <assimp/IOSystem.hpp>

#include <string>
#include <vector>

namespace glidar::import {

/// Assimp's access to files: read-only, regular files inside the model's root only, from private
/// copies.
class ConfinedIo : public Assimp::IOSystem {
 public:
  /// Assimp owns this object; files, limits and log must outlive it. Every file that is opened
  /// raises the limits.
  ConfinedIo(ModelFolder folder, ModelFiles& files, InputLimits& limits, FileLog& log);
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
  ModelFiles& files_;
  InputLimits& limits_;
  FileLog& log_;
};

}  // namespace glidar::import
