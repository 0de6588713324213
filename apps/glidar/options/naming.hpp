// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>

#include <string>

namespace glidar::app {

/// Lets an error of `work` name the option too.
template <class Work>
void naming(const char* option, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    parts.where = std::string(option) + (parts.where.empty() ? " ''" : ", " + parts.where);
    throw Error(parts);
  }
}

}  // namespace glidar::app
