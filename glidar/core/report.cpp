// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/report.hpp>

namespace glidar {

ProgressCallback subrange(const ProgressCallback& whole, double begin, double end) {
  if (!whole) return {};
  return [&whole, begin, end](double fraction) { whole(begin + fraction * (end - begin)); };
}

}  // namespace glidar
