// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolver.hpp>

// Barycentric weights and what is interpolated with them, lane by lane.
namespace glidar {

/// Barycentric weights of corners 1 and 2 at the hit point.
void interpolate_weights(const ExactHits& e, const CornerBlock& c, Lanes<float>& w1,
                         Lanes<float>& w2);

/// w0 a + w1 b + w2 c, normalised; `flat` where that has no length.
void blend_normals(const CornerBlock& n, const Lanes<float>& w1, const Lanes<float>& w2,
                   const Lanes3<double>& flat, Lanes3<double>& out);

/// Cosines between -beams and normals; normals are on the side of the plane's and are turned to the
/// sensor.
void cosines(const ExactHits& e, const Lanes3<double>& normal, Lanes<float>& out);

}  // namespace glidar
