// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/version.hpp>

namespace glidar {

const char* version() {
  return GLIDAR_VERSION;
}

}  // namespace glidar
