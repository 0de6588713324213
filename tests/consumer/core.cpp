// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/version.hpp>

#include <cstdio>

int main() {
  std::puts(glidar::version());
  return 0;
}
