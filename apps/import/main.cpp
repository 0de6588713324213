// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// glidar-import MODEL CREASE_ANGLE_RAD MEMORY_BYTES TIME_S PARENT
// Reads one model and writes one block (glidar/io/model/mesh_blob.hpp) to descriptor 3: the model,
// or the error. It reads the model in a sandbox (sandbox.hpp). Progress in percent goes to
// descriptor 4, one byte each. The GLIDAR library starts it; it is not for direct use.

#include <import/import_model.hpp>
#include <import/process_limits.hpp>
#include <import/sandbox.hpp>

#include <glidar/io/files/checksummed_block.hpp>
#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/model_folder.hpp>

#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

namespace glidar::import {
namespace {

constexpr int kAnswerFd = 3;
constexpr int kProgressFd = 4;
constexpr int kExitAnswered = 0;
constexpr int kExitFailed = 2;
constexpr int kExitNoMemory = 3;
constexpr int kExitFileSize = 4;

void report_progress(double fraction) {
  const auto percent = static_cast<unsigned char>(fraction <= 1.0 ? fraction * 100.0 : 100.0);
  // Progress is optional: a full or closed pipe must not stop the work.
  [[maybe_unused]] const ssize_t written = ::write(kProgressFd, &percent, 1);
}

int answer(const char* const* arguments) {
  const std::vector<std::string> notes =
      enter_sandbox(model_folder(arguments[1]).root, kProgressFd);
  try {
    ImportedModel imported =
        import_model(arguments[1], std::strtod(arguments[2], nullptr), report_progress);
    imported.sandbox_notes = notes;
    write_model(kAnswerFd, imported);
  } catch (const Refusal& refusal) {
    write_failure(kAnswerFd, {refusal.found, refusal.remedy});
  }
  return kExitAnswered;
}

int run(int argc, const char* const* argv) {
  constexpr int kArguments = 6;
  if (argc != kArguments) return kExitFailed;
  // A fixed threshold returns every large block to the system: glibc's own adapts and keeps some.
  constexpr int kLarge_bytes = 1 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kLarge_bytes);
  const ProcessLimits limits{std::strtoull(argv[3], nullptr, 10), std::strtod(argv[4], nullptr),
                             std::strtoll(argv[5], nullptr, 10)};
  if (!apply(limits)) return kExitFailed;
  try {
    return answer(argv);
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
