// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/stereo/cost_volume.hpp>
#include <glidar/stereo/pixel_tests.hpp>
#include <glidar/stereo/stereo_match.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace glidar::stereo {

/// A match with the costs that led to it, for match_stereo() and explain_stereo().
struct MatchTrace {
  StereoMatch match;
  CostVolume volume;  ///< its sums are complete only if the run keeps costs
};

/// Throws Error as match_stereo() does.
MatchTrace trace_match(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run);

/// The evidence of pixel (x, y), computed again from complete sums.
PixelEvidence gather_evidence(const CostVolume& volume, const GreyImage& left,
                              const StereoOptions& options, std::uint32_t x, std::uint32_t y);

}  // namespace glidar::stereo
