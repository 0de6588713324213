// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

namespace glidar::testing {

/// Name generator of parametrised tests: what the parameter prints, with underscores for all that
/// is no letter or digit. Print a struct by a PrintTo next to it; without one, GoogleTest prints
/// its bytes.
template <class Parameter>
std::string parameter_name(const ::testing::TestParamInfo<Parameter>& info) {
  std::string name;
  for (const char c : ::testing::PrintToString(info.param)) {
    const bool is_kept = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_kept || (!name.empty() && name.back() != '_')) name += is_kept ? c : '_';
  }
  if (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

}  // namespace glidar::testing
