// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

/// The paper's light: a lamp at the sensor. Equation (3): a = 1 / (constant + linear d + quadratic
/// d^2). The defaults are those of the 2015 program.
struct PhongHeadlight {
  double attenuation_constant = 1.0;
  double attenuation_linear_per_m = 1e-4;
  double attenuation_quadratic_per_m2 = 1e-8;
  double ambient = 0.2;  ///< of the whole scene, multiplies the materials' ambient colour
};

}  // namespace glidar
