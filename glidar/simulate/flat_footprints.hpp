// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/lidar/echo.hpp>
#include <glidar/simulate/simulation.hpp>

namespace glidar {

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

  /// The echo of a flat footprint and its only contribution. `signal` is that of the central ray
  /// alone. Requires the diffuse colours of all hits if they differ.
  [[nodiscard]] PulseEcho measure(const FlatFootprint& flat, std::size_t first, double signal,
                                  WaveformBuffer& waveform) const;

 private:
  struct Surface;
  [[nodiscard]] FlatFootprint::Kind kind_of(std::size_t first, Surface& last) const;
  [[nodiscard]] FlatFootprint::Kind kind_on(std::uint32_t instance, std::uint32_t triangle) const;
  [[nodiscard]] bool continues(const Surface& surface, std::uint32_t triangle) const;
  void integrate(PlaneBatch& planes, std::span<FlatFootprint* const> footprints) const;

  const Simulation& s_;
  const Hits& hits_;
  Eigen::Vector3d up_;
  double pulse_sigma_m_;
};

}  // namespace glidar
