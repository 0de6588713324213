// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Applies the hit rule to rays and triangles from the standard input and writes the distances, for
// hit_rule_test.py. A case is 15 doubles of the machine: origin, direction, three corners.
#include <glidar/render/common/hit_rule.hpp>

#include <array>
#include <cstdio>

int main() {
  std::array<double, 15> values{};
  while (std::fread(values.data(), sizeof(double), values.size(), stdin) == values.size()) {
    const auto corner = [&](std::size_t first) {
      return std::array<float, 3>{static_cast<float>(values[first]),
                                  static_cast<float>(values[first + 1]),
                                  static_cast<float>(values[first + 2])};
    };
    const glidar::HitRay ray =
        glidar::make_hit_ray({values[0], values[1], values[2]}, {values[3], values[4], values[5]});
    const double distance = glidar::hit_distance(ray, {corner(6), corner(9), corner(12)});
    std::fwrite(&distance, sizeof distance, 1, stdout);
  }
  return 0;
}
