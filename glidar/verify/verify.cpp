// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/verify.hpp>

#include <glidar/math/constants.hpp>
#include <glidar/verify/cases.hpp>
#include <glidar/verify/comparison.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace glidar {
namespace {

AccuracyCase run_row(const std::vector<Shape>& shapes, std::size_t shape, double distance_m,
                     const VerifySubject& subject) {
  AccuracyCase row{
      .name = "one shape at rest", .shape = shapes[shape].name, .distance_m = distance_m};
  for (const VerifyCase& c : make_cases(shape, distance_m)) {
    row.result.add(run_case(c, shapes[shape], subject));
  }
  return row;
}

AccuracyCase run_row(const SpecialCase& special, const VerifySubject& subject) {
  AccuracyCase row{.name = special.name, .shape = special.shape, .distance_m = special.distance_m};
  row.applies = subject.casts >= special.needs;
  if (row.applies) row.result = special.run(subject);
  return row;
}

}  // namespace

void VerifyResult::add(const VerifyResult& other) {
  rays += other.rays;
  compared_hits += other.compared_hits;
  compared_misses += other.compared_misses;
  near_edges += other.near_edges;
  wrong_hits += other.wrong_hits;
  wrong_misses += other.wrong_misses;
  wrong_ids += other.wrong_ids;
  range_error_m = std::max(range_error_m, other.range_error_m);
  range_error_ulp = std::max(range_error_ulp, other.range_error_ulp);
  normal_error_rad = std::max(normal_error_rad, other.normal_error_rad);
  other_error = std::max(other_error, other.other_error);
  may_miss = may_miss || other.may_miss;
}

void VerifyResult::check(double error, double bound) {
  const double share = std::abs(error) / bound;
  other_error = std::isnan(share) ? kInfinity : std::max(other_error, share);
}

bool VerifyResult::passed() const {
  return KnownFailure().covers(*this);
}

bool KnownFailure::covers(const VerifyResult& result) const {
  constexpr std::size_t kMinRaysPerSkipped = 50;
  const double max_wrong = max_wrong_share * static_cast<double>(result.rays);
  return result.compared_hits > 0 && (result.compared_misses > 0 || !result.may_miss) &&
         result.near_edges * kMinRaysPerSkipped < result.rays &&
         static_cast<double>(result.wrong()) <= max_wrong &&
         result.range_error_ulp <= max_range_error_ulp &&
         (result.wrong_ids > 0 || result.normal_error_rad <= kNormalBound_rad) &&
         result.other_error <= 1.0;
}

Verdict AccuracyCase::verdict() const {
  if (!applies) return Verdict::not_applicable;
  const bool is_listed = !known.reason.empty();
  if (result.passed()) return is_listed ? Verdict::fixed : Verdict::passed;
  return is_listed && known.covers(result) ? Verdict::known_failure : Verdict::failed;
}

std::string_view verdict_name(Verdict verdict) {
  constexpr std::array<std::string_view, 5> kNames = {"passed", "FAILED", "known failure", "FIXED",
                                                      "not applicable"};
  return kNames[static_cast<std::size_t>(verdict)];
}

void measure_frame(Simulator& simulator, const Motion& motion, Frame& frame) {
  simulator.simulate(motion, kAllHitColumns, frame);
}

Beams camera_beams(const Pinhole& camera) {
  return make_beams(camera);
}

std::vector<AccuracyCase> verify(const VerifySubject& subject, const ProgressCallback& progress) {
  const std::vector<Shape> shapes = make_shapes();
  const std::vector<double>& distances = verify_distances();
  const std::vector<SpecialCase> specials = special_cases(shapes);
  const auto count = static_cast<double>(shapes.size() * distances.size() + specials.size());
  std::vector<AccuracyCase> rows;
  const auto add = [&](AccuracyCase row) {
    row.known = known_failure(row);
    rows.push_back(std::move(row));
    if (progress) progress(static_cast<double>(rows.size()) / count);
  };
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    for (const double distance_m : distances) add(run_row(shapes, shape, distance_m, subject));
  }
  for (const SpecialCase& special : specials) add(run_row(special, subject));
  return rows;
}

std::vector<AccuracyCase> verify(const RendererOptions& options, const ProgressCallback& progress) {
  VerifySubject subject;
  subject.renderer = options.kind;
  subject.casts = beams_of_renderer(options.kind);
  subject.make = [&](const Scene& scene) { return make_renderer(scene, options); };
  return verify(subject, progress);
}

BeamKind beams_of_renderer(std::string_view kind) {
  return kind == "raster" ? BeamKind::pinhole : BeamKind::any;
}

bool all_passed(const std::vector<AccuracyCase>& rows) {
  return std::none_of(rows.begin(), rows.end(),
                      [](const AccuracyCase& row) { return row.verdict() == Verdict::failed; });
}

}  // namespace glidar
