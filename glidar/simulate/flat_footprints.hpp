// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/distributions.hpp>
#include <glidar/simulate/simulation.hpp>

#include <span>

namespace glidar {

/// Echoes of the pulses of a run that are in closed form.
struct FlatEchoes {
  Batch<double> range_m;
  Batch<double> signal;   ///< sum
  Batch<double> peak;     ///< of the widened pulse
  Batch<double> sigma_m;  ///< of it
};

/// Pulses that need no samples of the surface: they are measured by integrals over a plane. At
/// edges pulses have sub-rays; those of a pulse that touches an edge give the same echo up to the
/// fourth order of the beam's width. Which pulses it are depends on hits, not on how they were
/// found.
class FlatFootprints {
 public:
  explicit FlatFootprints(const Simulation& s);

  /// Finds how these pulses are measured. Requires the ids of all hits of their sub-rays, and all
  /// columns of the first of each.
  void find(BeamRange pulses) const;

  /// Finds the echoes of pulses in closed form among these, at most kSampleBatch. Requires the
  /// signals of their central rays alone, and all diffuse colours where they differ.
  void measure(BeamRange pulses, FlatEchoes& echoes) const;

 private:
  struct Surface;
  [[nodiscard]] FlatFootprint::Kind kind_of(std::size_t first, Surface& last) const;
  [[nodiscard]] FlatFootprint::Kind kind_on(std::uint32_t instance, std::uint32_t triangle) const;
  [[nodiscard]] bool continues(const Surface& surface, std::uint32_t triangle) const;
  void integrate(PlaneBatch& planes, std::span<FlatFootprint* const> footprints) const;
  void measure(BeamRange pulses, FlatFootprint::Kind kind, FlatEchoes& echoes) const;

  const Simulation& s_;
  const Hits& hits_;
  Eigen::Vector3d up_;
  double pulse_sigma_m_;
};

}  // namespace glidar
