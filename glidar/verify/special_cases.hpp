// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <functional>
#include <string>
#include <vector>

namespace glidar {

/// A scene that is difficult for renderers, with its own beams.
struct SpecialCase {
  std::string name;
  std::string shape;
  double distance_m = 0.0;
  BeamKind needs = BeamKind::pinhole;  ///< the renderer must cast at least these beams
  std::function<VerifyResult(const VerifySubject&)> run;
};

/// Several instances 10 km and 100 km away and one nearby, a sensor 1.5 m above a planet, a scanner
/// among bodies, a moving sensor and a moving target, sensors on vertices, beams at vertices and
/// edges, beams beside silhouettes, large casts and scenes, and measurements. The shapes must
/// outlive the cases.
std::vector<SpecialCase> special_cases(const std::vector<Shape>& shapes);

}  // namespace glidar
