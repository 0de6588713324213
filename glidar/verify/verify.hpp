// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/report.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/simulate/simulator.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Error bounds of verify().
inline constexpr double kRangeBound_ulp = 1e-3;   ///< of float32, at the range
inline constexpr double kNormalBound_rad = 1e-6;  ///< normals are stored in float32

/// Errors over many rays.
struct VerifyResult {
  std::size_t rays = 0;
  std::size_t compared_hits = 0;
  std::size_t compared_misses = 0;
  std::size_t near_edges = 0;  ///< not compared
  std::size_t wrong_hits = 0;
  std::size_t wrong_misses = 0;
  std::size_t wrong_ids = 0;      ///< wrong instance, or a triangle without the exact point
  double range_error_m = 0.0;     ///< maximum
  double range_error_ulp = 0.0;   ///< maximum, in float32 steps at the exact range
  double normal_error_rad = 0.0;  ///< maximum
  /// Maximum of the errors of all other columns and of measurements, as a share of their bounds.
  double other_error = 0.0;
  bool may_miss = true;  ///< false: no beam of the case can miss

  void add(const VerifyResult& other);
  /// Adds an error of another column; NaN counts as infinite.
  void check(double error, double bound);
  [[nodiscard]] std::size_t wrong() const { return wrong_hits + wrong_misses + wrong_ids; }
  /// True if all errors are within the bounds, and hits and misses were compared.
  [[nodiscard]] bool passed() const;
};

/// The tolerated errors of a renderer in a row.
struct KnownFailure {
  std::string reason = {};       ///< empty: the row must pass
  double max_wrong_share = 0.0;  ///< wrong hits, misses and ids, as a share of the rays
  double max_range_error_ulp = kRangeBound_ulp;

  /// True if a result is within these errors. Normals of wrong triangles are ignored.
  [[nodiscard]] bool covers(const VerifyResult& result) const;
};

/// The beams that a renderer casts, or a case requires.
enum class BeamKind : std::uint8_t { pinhole, any };

/// The beams that a renderer of this kind supports.
BeamKind beams_of_renderer(std::string_view kind);

/// The simulation and the optics of the library.
void measure_frame(Simulator& simulator, const Motion& motion, Frame& frame);
Beams camera_beams(const Pinhole& camera);

/// A renderer to verify, and what measures with it.
struct VerifySubject {
  std::string renderer;  ///< kind of the renderer, the key of known failures
  BeamKind casts = BeamKind::any;
  std::function<std::unique_ptr<Renderer>(const Scene&)> make;
  /// Simulates the frame that its stamp and number state, with all ground truth.
  std::function<void(Simulator&, const Motion&, Frame&)> measure = measure_frame;
  std::function<Beams(const Pinhole&)> beams_of_camera = camera_beams;
};

/// The outcome of a row.
enum class Verdict : std::uint8_t {
  passed,          ///< within all bounds
  failed,          ///< beyond the bounds, or beyond those of the known failure
  known_failure,   ///< within the bounds of the known failure; not an error
  fixed,           ///< passed, although listed as a known failure; not an error: drivers differ
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

/// The name of a verdict in tables and JSON.
std::string_view verdict_name(Verdict verdict);

/// Measures the accuracy of hits, of all their geometric columns and of measurements on this
/// machine (docs/internals/accuracy.md): compares every shape at every distance from 0.1 m to 10
/// km, and the special cases, with closed forms.
std::vector<AccuracyCase> verify(const VerifySubject& subject, const ProgressCallback& progress);
std::vector<AccuracyCase> verify(const RendererOptions& options, const ProgressCallback& progress);

/// True if no row has the verdict `failed`.
bool all_passed(const std::vector<AccuracyCase>& rows);

}  // namespace glidar
