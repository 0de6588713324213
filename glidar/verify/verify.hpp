// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/render/renderer.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// What `verify` holds a renderer to.
inline constexpr double kRangeBound_ulp = 1e-3;   ///< of float32, at the range
inline constexpr double kNormalBound_rad = 1e-6;  ///< normals are stored in float32

/// Errors over many rays.
struct VerifyResult {
  std::size_t rays = 0;
  std::size_t judged_hits = 0;
  std::size_t judged_misses = 0;
  std::size_t near_edges = 0;  ///< not judged
  std::size_t wrong_hits = 0;
  std::size_t wrong_misses = 0;
  std::size_t wrong_ids = 0;      ///< the instance, or a triangle that does not hold the true point
  double range_error_m = 0.0;     ///< largest
  double range_error_ulp = 0.0;   ///< largest, in float32 steps at the true range
  double normal_error_rad = 0.0;  ///< largest

  void add(const VerifyResult& other);
  [[nodiscard]] std::size_t wrong() const { return wrong_hits + wrong_misses + wrong_ids; }
  /// Within all bounds, with hits and misses to show for it.
  [[nodiscard]] bool passed() const;
};

/// By how much a renderer may fail a row.
struct KnownFailure {
  std::string reason = {};       ///< empty: the row has to pass
  double max_wrong_share = 0.0;  ///< wrong hits, misses and ids, of the rays
  double max_range_error_ulp = kRangeBound_ulp;

  /// True when a result is no worse than this. The normal of a wrong triangle does not count.
  [[nodiscard]] bool covers(const VerifyResult& result) const;
};

/// What beams a renderer casts, or a case needs. Each kind contains the ones before it.
enum class BeamKind : std::uint8_t {
  pinhole,
  scanner,  ///< rows of equal elevation, columns of equal azimuth
  any,
};

/// The beams that a renderer of this kind casts.
BeamKind beams_of_renderer(std::string_view kind);

/// A renderer to verify.
struct VerifySubject {
  std::string renderer;  ///< its kind, by which known failures are listed
  BeamKind casts = BeamKind::any;
  std::function<std::unique_ptr<Renderer>(const Scene&)> make;
};

/// What became of a row.
enum class Verdict : std::uint8_t {
  passed,          ///< within all bounds
  failed,          ///< a row that has to pass, or by more than is known
  known_failure,   ///< failed as known; not an error
  fixed,           ///< passed, though listed as a known failure; not an error: drivers differ
  not_applicable,  ///< the renderer does not cast such beams
};

/// One case with one shape at one distance.
struct AccuracyCase {
  std::string name;  ///< of the case
  std::string shape;
  double distance_m = 0.0;
  VerifyResult result = {};
  KnownFailure known = {};  ///< of this renderer
  bool applies = true;

  [[nodiscard]] Verdict verdict() const;
};

/// The word for a verdict that tables and JSON show.
std::string_view verdict_name(Verdict verdict);

/// Measures the accuracy of ranges, normals and ids on this machine (docs/accuracy.md): every shape
/// at every distance from 0.1 m to 10 km, and the special cases, judged by closed forms.
std::vector<AccuracyCase> verify(const VerifySubject& subject, const ProgressCallback& progress);
std::vector<AccuracyCase> verify(const RendererOptions& options, const ProgressCallback& progress);

/// True when no row failed, but as known.
bool all_passed(const std::vector<AccuracyCase>& rows);

}  // namespace glidar
