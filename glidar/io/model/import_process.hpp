// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// A run of the import process. Model importers crash on malicious and on some valid files, so
/// they run in a separate process, which may read the model's folder and the texture folders, and
/// must stay within these limits.
struct ImportRequest {
  std::filesystem::path model;  ///< canonical path
  double crease_angle_rad = 0.785398163397448310;
  double time_limit_s = 20.0;
  std::uint64_t memory_limit_bytes =
      0;  ///< address space; 0: default_memory_limit of the file's size
  std::vector<std::filesystem::path> texture_folders = {};  ///< canonical
};

struct ImportRun {
  ImportEnd end = ImportEnd::crashed;
  int signal = 0;   ///< that ended it when crashed; 0: it exited without an answer
  UniqueFd answer;  ///< memory file at position 0, with one frame: a model or a failure
  std::uint64_t peak_memory_bytes = 0;  ///< resident; that of the starting process if it is larger
  std::uint64_t memory_limit_bytes = 0;
  double seconds = 0.0;
};

/// 1 GiB, or 40 times the file size if that is larger: text formats expand that much.
std::uint64_t default_memory_limit(std::uint64_t file_bytes);

/// Starts the import program and waits for its end. Reports progress as "loading NAME" when it
/// takes more than half a second (a negative fraction: unknown).
/// Throws Error only when the program cannot be found or started.
ImportRun run_import(const ImportRequest& request, const Report& report);

/// Throws Error for an answer of the import process that is malformed or not allowed.
[[noreturn]] void reject_answer(const std::filesystem::path& model, const std::string& found);

/// The model of a run. Throws Error naming the model, what happened and what to do.
ImportedModel take_model(const ImportRun& run, const ImportRequest& request);

}  // namespace glidar
