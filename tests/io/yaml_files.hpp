// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>
#include <support/error_text.hpp>
#include <support/test_folder.hpp>

#include <gtest/gtest.h>

#include <string>

namespace glidar {

using testing::TestFolder;

/// The error message of `action` without the folder's name; "no error" without one.
template <class Action>
std::string error_of(const TestFolder& folder, Action action) {
  std::string text = error_text(action);
  const std::string prefix = folder.path().string() + "/";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
    text.erase(at, prefix.size());
  }
  return text;
}

/// A file with one error, and the expected message.
struct BadFile {
  const char* name;
  std::string content;
  std::string error;
};

inline void PrintTo(const BadFile& bad, std::ostream* out) {
  *out << bad.name;
}

inline std::string bad_file_name(const ::testing::TestParamInfo<BadFile>& info) {
  return info.param.name;
}

}  // namespace glidar
