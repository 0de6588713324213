// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace glidar {

class FieldVisitor;

/// The point light at the sensor of the 2016 paper. Its equation (3), the attenuation at distance
/// d: a = 1 / (constant + linear d + quadratic d^2). The defaults are those of the original GLIDAR.
struct PhongHeadlight {
  double attenuation_constant = 1.0;
  double attenuation_linear_per_m = 1e-4;
  double attenuation_quadratic_per_m2 = 1e-8;
  double ambient = 0.2;  ///< factor of all materials' ambient colours
};

/// Keys of `light` in sensor files.
void describe(PhongHeadlight& light, FieldVisitor& visitor);

}  // namespace glidar
