// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/gamma.hpp>

#include <glidar/math/elementary.hpp>
#include <glidar/math/gaussian.hpp>

#include <cmath>

namespace glidar {

double sample_gamma(double deviation, RngKey key) {
  if (deviation == 0.0) return 1.0;
  const double shape = 1.0 / (deviation * deviation);  // at least 1
  const double d = shape - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  for (;; ++key.block) {  // 95 % or more of the attempts succeed
    const RandomWords words = random_words(key);
    const double x = normals(words)[0];
    const double root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double limit = 0.5 * x * x + d - d * v + d * portable_log(v);
    if (portable_log(uniform(words[2])) < limit) return d * v / shape;
  }
}

}  // namespace glidar
