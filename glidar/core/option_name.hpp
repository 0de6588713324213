// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>

#include <string>

namespace glidar {

/// Runs `work` and adds the option's name to its errors; empty: nothing.
template <class Work>
void with_option_name(const std::string& option, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    if (parts.where.starts_with(option)) throw;
    parts.where = parts.where.empty() ? option : option + ", " + parts.where;
    throw Error(parts);
  }
}

}  // namespace glidar
