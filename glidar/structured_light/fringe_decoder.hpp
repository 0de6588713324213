// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/math/thread_pool.hpp>
#include <glidar/structured_light/fringe_patterns.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar {

/// Why a pixel has no coordinate: the first test that it fails, in this order.
enum class FringeStatus : std::uint8_t {
  valid,
  saturated,       ///< an image is saturated there
  low_modulation,  ///< the fringes hardly change: shadow, dark or far surface, defocus
  weak_code,       ///< bits of the Gray code are not certain, other than between two stripes
  inconsistent,    ///< phase and Gray code contradict each other
  outside          ///< the code is beyond the projector's image
};
inline constexpr std::size_t kFringeStatusCount = 6;

/// "valid", "saturated", "low_modulation", "weak_code", "inconsistent" or "outside".
const char* to_string(FringeStatus status);

/// Thresholds of decode_fringes(). Levels are those of the images.
struct FringeDecoding {
  double min_modulation = 4.0;         ///< amplitude of the fringes, levels
  double min_code_difference = 4.0;    ///< between an image of the code and its inverse, levels
  double max_code_error = 0.4;         ///< between phase and code, periods; at most 0.5
  std::uint32_t saturation_level = 0;  ///< 0: the greatest of the pixel type
};

/// Keys of `decoding`, with bounds and defaults.
void describe(FringeDecoding& decoding, FieldVisitor& visitor);

/// What decode_fringes() finds for each pixel of the camera, row by row from the top.
struct DecodedFringes {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  /// Column (or row) of the projector, whole numbers are centres of pixels; NaN unless valid.
  std::vector<float> coordinate_px = {};
  std::vector<float> phase_rad = {};   ///< of the fringes, 0 to 2 pi; NaN without fringes
  std::vector<float> modulation = {};  ///< amplitude B of the fringes, levels
  std::vector<float> mean_level = {};  ///< A, levels: of the fringes; without fringes of the code
  std::vector<FringeStatus> status = {};
};

/// Decodes the images that a camera took of make_pattern(patterns, 0), (patterns, 1) ... With
/// I_k = A + B cos(phi - 2 pi k / N) the phase is phi = atan2(sum I_k sin, sum I_k cos) and
/// B = 2/N sqrt(sin^2 + cos^2) (Srinivasan, Liu and Halioua 1984). White noise of standard
/// deviation s in the levels gives the phase one of sqrt(2 / N) s / B. The Gray code, whose stripes
/// are half a period wide, selects the period k that is nearest to (stripe + 1/2) / 2 - phi / 2 pi,
/// so that stripes which are displaced by up to a quarter of a period cause no error; between two
/// stripes, where one bit is not certain, either serves. Without inverses a bit is compared with A.
/// Throws Error when the number of images or their sizes differ from the patterns, or a threshold
/// is not allowed. `pool` may be null.
DecodedFringes decode_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                              const FringeDecoding& decoding, ThreadPool* pool = nullptr);

}  // namespace glidar
