// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/tof/tof_options.hpp>

#include <cstdint>
#include <vector>

namespace glidar {

class FieldVisitor;

/// The correlation of the received light with the reference, as a function of the phase.
enum class TofWaveform : std::uint8_t {
  sine,     ///< cos(phi)
  triangle  ///< of a square wave with a square wave: 1 at phase 0, -1 at pi
};

/// A continuous-wave camera that is simulated from its raw images. Each of N phase steps of each
/// frequency exposes two wells with (B + A (1 +- m c(phi - 2 pi k / N))) / 2 electrons, where A is
/// the signal, B the background, m the contrast and c the correlation. The decoder gets their
/// difference.
struct TofCamera {
  static constexpr TypeInfo kType = {"time_of_flight",
                                     "raw images of modulated light, decoded to ranges",
                                     "Lange and Seitz, IEEE JQE 37 (2001)"};
  /// A of a phase step from a white diffuse surface at normal incidence at 1 m. It falls with the
  /// square of the range and with the backscatter of the surface.
  double signal_electrons = 0.0;
  double ambient_electrons = 0.0;  ///< B of a phase step from a white surface in the ambient light
  double dark_electrons = 0.0;     ///< B of a phase step without light
  std::vector<double> contrast = {};  ///< m, one for each frequency; empty: 1
  TofWaveform waveform = TofWaveform::sine;
  double read_noise_electrons = 0.0;       ///< standard deviation, of each well
  double full_well_electrons = kInfinity;  ///< from which a well is saturated
  double electrons_per_level = 1.0;        ///< unit of the raw values
  bool has_whole_levels = false;           ///< raw values are rounded
  double step_interval_s = 0.0;            ///< between starts of phase steps; all: at most 4 s
  std::uint32_t sub_rays = 4;              ///< n: each pixel is n x n rays
  std::uint32_t bounces = 1;               ///< diffuse bounces of the light before the surface
  std::uint32_t bounce_rays = 16;          ///< rays per pixel that sample them
  /// Bounced light is averaged over the square of this radius around each pixel; 0: not at all.
  std::uint32_t bounce_filter_px = 3;
  TofOptions decoder = {};
};

/// Keys of `depth_camera` with `type: time_of_flight`.
void describe(TofCamera& camera, FieldVisitor& visitor);

/// Throws Error naming the first value that is not allowed.
void validate(const TofCamera& camera);

}  // namespace glidar
