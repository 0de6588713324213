// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/hits.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

namespace glidar::testing {

template <class T>
void expect_same_bytes(const std::vector<T>& found, const std::vector<T>& expected,
                       const char* column) {
  ASSERT_EQ(found.size(), expected.size()) << column;
  if (found.empty()) return;
  if (std::memcmp(found.data(), expected.data(), found.size() * sizeof(T)) == 0) return;
  std::size_t differ = 0;
  std::size_t first = found.size();
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (std::memcmp(&found[i], &expected[i], sizeof(T)) == 0) continue;
    ++differ;
    first = std::min(first, i);
  }
  ADD_FAILURE() << column << ": " << differ << " of " << found.size()
                << " beams differ, the first is " << first;
}

/// Expects the same bits of every column; returns how many beams hit.
inline std::size_t expect_same_hits(const Hits& found, const Hits& expected) {
  expect_same_bytes(found.instance, expected.instance, "instance");
  expect_same_bytes(found.primitive, expected.primitive, "primitive");
  expect_same_bytes(found.range_m, expected.range_m, "range");
  expect_same_bytes(found.normal, expected.normal, "normal");
  expect_same_bytes(found.shading_normal, expected.shading_normal, "shading normal");
  expect_same_bytes(found.cos_incidence, expected.cos_incidence, "cosine of incidence");
  expect_same_bytes(found.cos_shading, expected.cos_shading, "cosine of shading");
  expect_same_bytes(found.barycentrics, expected.barycentrics, "barycentrics");
  expect_same_bytes(found.colour, expected.colour, "colour");
  expect_same_bytes(found.diffuse, expected.diffuse, "diffuse");
  expect_same_bytes(found.object_point_m, expected.object_point_m, "object point");
  expect_same_bytes(found.noise_scale, expected.noise_scale, "noise scale");
  expect_same_bytes(found.depth_m, expected.depth_m, "depth");
  expect_same_bytes(found.reflectance, expected.reflectance, "reflectance");
  std::size_t hits = 0;
  for (const std::uint32_t instance : expected.instance) hits += instance == kInvalidId ? 0 : 1;
  return hits;
}

}  // namespace glidar::testing
