// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/tof/tof_trace.hpp>

#include <glidar/core/decimal_text.hpp>
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/tof/decoding.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glidar {
namespace {

using tof::Decoding;
using tof::EdgeEvidence;
using tof::PixelEvidence;

std::string limit_text(double limit, unsigned decimals) {
  return limit == kInfinity ? "none" : decimal_text(limit, decimals);
}

std::string edge_text(const EdgeEvidence& edge, const TofOptions& options) {
  if (!options.edge_test && !options.filter) return "no test";
  if (edge.is_border) return "no test at the border of the image";
  std::string text;
  if (options.edge_test) {
    const TofEdgeTest& test = *options.edge_test;
    text = "amplitude deviation " + decimal_text(edge.amplitude_deviation, 3) + " (edge from " +
           decimal_text(test.amplitude_deviation, 3) + "), steps to the nearest " +
           decimal_text(edge.near_step_m, 3) + " m (above " + decimal_text(test.near_step_m, 3) +
           ") and farthest depth " + decimal_text(edge.far_step_m, 3) + " m (above " +
           decimal_text(test.far_step_m, 3) + ")";
  }
  if (!options.filter) return text;
  return text + (text.empty() ? "" : ", ") + "phase change " + decimal_text(edge.phase_change, 3) +
         " (edge from " + decimal_text(options.filter->max_phase_change, 3) + ")";
}

std::vector<TofTest> list_tests(const PixelEvidence& pixel, const EdgeEvidence& edge,
                                const TofOptions& options) {
  const std::string depth = "depth " + decimal_text(pixel.depth_m, 3) + " m, ";
  return {{TofStatus::not_illuminated, pixel.is_illuminated,
           pixel.is_illuminated ? "the illuminator lights the pixel"
                                : "the illuminator does not light the pixel"},
          {TofStatus::saturated, !pixel.is_saturated,
           "saturation level: " + limit_text(options.saturation_level, 0)},
          {TofStatus::low_signal, has_signal(pixel, options),
           "least amplitude " + decimal_text(pixel.min_amplitude) + ", needed: " +
               decimal_text(options.min_amplitude) + "; sum " + decimal_text(pixel.amplitude_sum) +
               ", needed: " + decimal_text(options.min_amplitude_sum)},
          {TofStatus::ambiguous, has_fit(pixel),
           "misfit of the phases " + decimal_text(pixel.unwrapped.misfit_rad, 3) +
               " rad, allowed: " + decimal_text(pixel.misfit_limit_rad, 3)},
          {TofStatus::too_near, !(pixel.depth_m < options.near_m),
           depth + "limit: " + decimal_text(options.near_m, 3)},
          {TofStatus::too_far, !(pixel.depth_m > options.far_m),
           depth + "limit: " + limit_text(options.far_m, 3)},
          {TofStatus::edge, !is_depth_edge(edge, options) && !is_phase_edge(edge, options),
           edge_text(edge, options)}};
}

std::vector<TofCandidate> list_candidates(const tof::Unwrapping& unwrapping,
                                          const tof::PerFrequency& turns) {
  std::vector<TofCandidate> candidates;
  for (std::size_t period = 0; period < unwrapping.periods; ++period) {
    const tof::Unwrapped found = unwrap_candidate(unwrapping, turns, period);
    TofCandidate candidate{found.range_m, found.misfit_rad};
    for (std::size_t f = 0; f < unwrapping.frequencies; ++f) {
      candidate.periods.push_back(std::floor(found.turns[f] - turns[f] + 0.5));
    }
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const TofCandidate& a, const TofCandidate& b) { return a.misfit_rad < b.misfit_rad; });
  return candidates;
}

void copy_frequencies(const TofImages& images, const TofOptions& options,
                      const PixelEvidence& pixel, std::size_t index, TofTrace& trace) {
  trace.frequencies_hz = options.frequencies_hz;
  for (std::size_t f = 0; f < images.frequencies; ++f) {
    trace.amplitude.push_back(pixel.amplitude[f]);
    trace.phase_rad.push_back(kTwoPi * pixel.turns[f]);
    std::vector<double> levels;
    for (std::size_t k = 0; k < images.taps; ++k) {
      levels.push_back(static_cast<double>(images.level[tap_offset(images, f, k) + index]));
    }
    trace.levels.push_back(std::move(levels));
  }
}

std::string frequency_line(const TofTrace& trace, std::size_t f) {
  std::string text = "  " + decimal_text(trace.frequencies_hz[f] * 1e-6, 3) + " MHz: raw";
  for (const double level : trace.levels[f]) text += " " + decimal_text(level, 1);
  return text + "; amplitude " + decimal_text(trace.amplitude[f]) + ", phase " +
         decimal_text(trace.phase_rad[f], 3) + " rad\n";
}

std::string candidate_line(const TofCandidate& candidate) {
  std::string text = "  range " + decimal_text(candidate.range_m, 3) + " m: misfit " +
                     decimal_text(candidate.misfit_rad, 3) + " rad, whole periods";
  for (const double period : candidate.periods) text += " " + decimal_text(period, 0);
  return text + "\n";
}

void require_pixel(const TofImages& images, std::array<std::uint32_t, 2> column_row) {
  const auto [column, row] = column_row;
  if (column < images.width && row < images.height) return;
  throw Error({"pixel to explain",
               std::to_string(column) + "," + std::to_string(row) + " is outside the image",
               "columns 0 to " + std::to_string(images.width - 1) + ", rows 0 to " +
                   std::to_string(images.height - 1),
               ""});
}

}  // namespace

TofTrace explain_tof(const TofImages& images, const TofOptions& options,
                     std::array<std::uint32_t, 2> column_row, const TofCalibration& calibration,
                     const TofRun& run) {
  const Decoding decoding = tof::decode(images, options, calibration, run.pool);
  require_pixel(images, column_row);
  const auto [column, row] = column_row;
  const std::size_t index = std::size_t{row} * images.width + column;
  const PixelEvidence pixel =
      gather_evidence(decoding.phasors, decoding.unwrapping, options, calibration, index);
  const EdgeEvidence edge = gather_edge_evidence(decoding.depths, decoding.phasors, options, index);
  TofTrace trace{.column = column,
                 .row = row,
                 .status = decoding.measurement.status[index],
                 .range_m = pixel.unwrapped.range_m,
                 .depth_m = pixel.depth_m,
                 .misfit_rad = pixel.unwrapped.misfit_rad};
  copy_frequencies(images, options, pixel, index, trace);
  trace.candidates = list_candidates(decoding.unwrapping, pixel.turns);
  trace.tests = list_tests(pixel, edge, options);
  return trace;
}

std::string format_tof_trace(const TofTrace& trace) {
  constexpr std::size_t kShown = 3;
  std::string text = "pixel " + std::to_string(trace.column) + "," + std::to_string(trace.row) +
                     ": " + to_string(trace.status) + "\nrange " + decimal_text(trace.range_m, 4) +
                     " m, depth " + decimal_text(trace.depth_m, 4) + " m\n";
  for (std::size_t f = 0; f < trace.frequencies_hz.size(); ++f) text += frequency_line(trace, f);
  for (const TofTest& test : trace.tests) {
    text += std::string(test.has_passed ? "  passed  " : "  failed  ") + to_string(test.failure) +
            ": " + test.finding + "\n";
  }
  for (std::size_t i = 0; i < std::min(kShown, trace.candidates.size()); ++i) {
    text += candidate_line(trace.candidates[i]);
  }
  return text;
}

}  // namespace glidar
