// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/error.hpp>

#include <string>

namespace glidar {

/// The text of the Error that the action throws; "no error" when it throws none.
inline std::string error_text(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace glidar
