// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <support/source_folder.hpp>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>

namespace glidar::testing {

/// A corpus of the fuzzers, decoded.
struct DecodedCorpus {
  std::set<std::string> accepted;  ///< names of the files that are valid messages
  std::size_t files = 0;
};

/// Decodes every file of tests/fuzz/corpus/PROTOCOL.zip.
inline DecodedCorpus decode_corpus(const char* protocol,
                                   bool (*decode)(std::span<const std::byte>)) {
  DecodedCorpus result;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(kCorpusFolder) / protocol)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    ++result.files;
    if (decode(std::as_bytes(std::span(bytes)))) {
      result.accepted.insert(entry.path().filename().string());
    }
  }
  return result;
}

}  // namespace glidar::testing
