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

/// match_stereo() with the costs that lead to the result, whose memory `volume` keeps for the next
/// pair. Its sums are complete only if the run keeps costs. Throws Error as match_stereo() does.
StereoMatch match_pair(const GreyImage& left, const GreyImage& right, const StereoOptions& options,
                       const StereoRun& run, CostVolume& volume);

/// The evidence of a pixel of a match, computed again from complete sums.
PixelEvidence gather_evidence(const CostVolume& volume, const StereoMatch& match,
                              const GreyImage& left, const StereoOptions& options,
                              std::size_t pixel);

}  // namespace glidar::stereo
