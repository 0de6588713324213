// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// glidar-import MODEL CREASE_ANGLE_RAD MEMORY_BYTES TIME_S PARENT [TEXTURE_FOLDER ...]
// Reads one model and writes one block (glidar/io/model/mesh_blob.hpp) to descriptor 3: the model,
// or the error. Progress in percent goes to descriptor 4, one byte each.
//
// glidar-import --decode KIND PATH MEMORY_BYTES TIME_S PARENT
// Reads a bag, capture or image and writes its records (glidar/io/decoder/record_stream.hpp) to
// descriptor 3; requests come from descriptor 4, and long records are in the memory of
// descriptor 5.
//
// It reads in a sandbox (sandbox.hpp). The GLIDAR library starts it; it is not for direct use.

#include <import/decode_file.hpp>
#include <import/import_model.hpp>
#include <import/process_limits.hpp>
#include <import/sandbox.hpp>

#include <glidar/io/decoder/decoder_process.hpp>
#include <glidar/io/files/checksummed_block.hpp>
#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/model_folder.hpp>

#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace glidar::import {
namespace {

constexpr int kExitAnswered = 0;
constexpr int kExitFailed = 2;

void report_progress(double fraction) {
  const auto percent = static_cast<unsigned char>(fraction <= 1.0 ? fraction * 100.0 : 100.0);
  // Progress is optional: a full or closed pipe must not stop the work.
  [[maybe_unused]] const ssize_t written = ::write(kControlFd, &percent, 1);
}

int answer(const char* const* arguments, std::vector<std::filesystem::path> texture_folders) {
  ModelFolder folder = model_folder(arguments[1], std::move(texture_folders));
  const std::vector<std::string> notes = enter_sandbox(folder.allowed(), kControlFd);
  try {
    ImportedModel imported = import_model(arguments[1], std::move(folder),
                                          std::strtod(arguments[2], nullptr), report_progress);
    imported.sandbox_notes = notes;
    write_model(kAnswerFd, imported);
  } catch (const Refusal& refusal) {
    write_failure(kAnswerFd, {refusal.found, refusal.remedy});
  }
  return kExitAnswered;
}

int answer_records(const char* const* arguments) {
  const std::string path = arguments[3];
  enter_sandbox({path}, kSharedFd);
  return decode_file(arguments[2], path, {kAnswerFd, kControlFd, kSharedFd}) ? kExitAnswered
                                                                             : kExitFailed;
}

int run(int argc, const char* const* argv) {
  const bool is_model = argc > 1 && std::string(argv[1]) != kDecodeOption;
  const int arguments = is_model ? 6 : 7;
  if (argc < arguments || (!is_model && argc > arguments)) return kExitFailed;
  // A fixed threshold returns every large block of a model to the system: glibc's own adapts and
  // keeps some, as the messages of a bag need.
  constexpr int kLarge_bytes = 1 << 20;
  if (is_model) ::mallopt(M_MMAP_THRESHOLD, kLarge_bytes);
  const char* const* last = argv + arguments - 3;
  const ProcessLimits limits{std::strtoull(last[0], nullptr, 10), std::strtod(last[1], nullptr),
                             std::strtoll(last[2], nullptr, 10)};
  if (!apply(limits)) return kExitFailed;
  try {
    return is_model ? answer(argv, {argv + arguments, argv + argc}) : answer_records(argv);
  } catch (const std::bad_alloc&) {
    return kExitNoMemory;
  } catch (const FileSizeLimit&) {
    return kExitFileSize;
  } catch (const std::exception&) {
    return kExitFailed;  // the parent reports the missing answer
  }
}

}  // namespace
}  // namespace glidar::import

int main(int argc, char** argv) {
  // Skips destructors: the answer is written, and data from hostile files may not destruct
  // safely.
  ::_exit(glidar::import::run(argc, argv));
}
