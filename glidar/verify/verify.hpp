// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/render/renderer.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace glidar {

/// What `verify` holds a renderer to.
inline constexpr double kRangeBound_ulp = 1.0;    ///< of float32, at the range
inline constexpr double kNormalBound_rad = 1e-6;  ///< normals are stored in float32

/// Errors over many rays.
struct VerifyResult {
  std::size_t rays = 0;
  std::size_t judged_hits = 0;
  std::size_t judged_misses = 0;
  std::size_t near_edges = 0;  ///< not judged
  std::size_t wrong_hits = 0;
  std::size_t wrong_misses = 0;
  double range_error_m = 0.0;     ///< largest
  double range_error_ulp = 0.0;   ///< largest, in float32 steps at the true range
  double normal_error_rad = 0.0;  ///< largest

  void add(const VerifyResult& other);
  /// Within all bounds, with hits and misses to show for it.
  [[nodiscard]] bool passed() const;
};

/// One shape at one distance, in all sizes and places.
struct VerifyRow {
  std::string shape;
  double distance_m = 0.0;
  VerifyResult result;
};

/// Measures the accuracy of ranges and normals on this machine (docs/accuracy.md): every shape at
/// every distance from 0.1 m to 10 km, judged by its closed form.
std::vector<VerifyRow> verify(const RendererOptions& options, const Progress& progress);

/// True when every row is within all bounds.
bool all_passed(const std::vector<VerifyRow>& rows);

}  // namespace glidar
