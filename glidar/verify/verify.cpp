// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/verify/verify.hpp>

#include <glidar/verify/cases.hpp>

#include <algorithm>

namespace glidar {
namespace {

VerifyRow run_row(const std::vector<Shape>& shapes, std::size_t shape, double distance_m,
                  const RendererOptions& options) {
  VerifyRow row{.shape = shapes[shape].name, .distance_m = distance_m, .result = {}};
  for (const VerifyCase& c : make_cases(shape, distance_m)) {
    row.result.add(run_case(c, shapes[shape], options));
  }
  return row;
}

}  // namespace

std::vector<VerifyRow> verify(const RendererOptions& options, const Progress& progress) {
  const std::vector<Shape> shapes = make_shapes();
  const std::vector<double>& distances = verify_distances();
  const auto count = static_cast<double>(shapes.size() * distances.size());
  std::vector<VerifyRow> rows;
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    for (const double distance_m : distances) {
      rows.push_back(run_row(shapes, shape, distance_m, options));
      if (progress) progress(static_cast<double>(rows.size()) / count);
    }
  }
  return rows;
}

bool all_passed(const std::vector<VerifyRow>& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const VerifyRow& row) { return row.result.passed(); });
}

}  // namespace glidar
