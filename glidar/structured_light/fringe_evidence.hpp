// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/structured_light/fringe_decoder.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glidar::structured_light {

/// Allowed values of FringeDecoding::max_code_error.
inline constexpr NumberRule kMaxCodeErrorRule = {0.25, 0.5, false, "periods from 0.25 to 0.5"};

/// What is the same for all pixels.
struct Decoder {
  std::span<const GreyImage> images;
  const FringePatterns& patterns;
  const FringeDecoding& decoding;
  std::vector<SineCosine> steps;  ///< of 2 pi k / N
  std::uint32_t bits = 0;
  std::uint32_t saturation_level = 0;
};

/// Throws Error as decode_fringes(). Refers to its arguments.
Decoder make_decoder(std::span<const GreyImage> images, const FringePatterns& patterns,
                     const FringeDecoding& decoding);

/// A stripe by its Gray code.
struct Stripe {
  std::uint32_t number = 0;
  std::uint32_t weak_bits = 0;  ///< how many are not certain
  std::uint32_t other = 0;      ///< the number if the last uncertain bit is the other one
  double min_difference = 0.0;  ///< least difference of a bit's levels
};

/// All that a pixel is decoded from.
struct FringeEvidence {
  double max_level = 0.0;   ///< of all images
  double turns = 0.0;       ///< phase / 2 pi, 0 to 1; 0 without fringes
  double modulation = 0.0;  ///< levels
  double mean_level = 0.0;  ///< of the fringes; without fringes of the code
  Stripe stripe;
  double period = 0.0;      ///< whole periods that the stripe selects; 0 without fringes
  double code_error = 0.0;  ///< between phase and code, periods
  double place_px = 0.0;    ///< coordinate, also of pixels that fail a test
};
FringeEvidence gather_evidence(const Decoder& decoder, std::size_t pixel);

// The tests, in their order.
bool is_unsaturated(const Decoder& decoder, const FringeEvidence& pixel);
bool has_modulation(const Decoder& decoder, const FringeEvidence& pixel);
/// Between two stripes, one bit is not certain. Either of them leads to the same period.
bool is_code_certain(const Decoder& decoder, const FringeEvidence& pixel);
bool is_consistent(const Decoder& decoder, const FringeEvidence& pixel);
bool is_inside(const Decoder& decoder, const FringeEvidence& pixel);

/// The first test that fails.
FringeStatus status_of(const Decoder& decoder, const FringeEvidence& pixel);

/// Least difference that makes a bit certain, levels.
double min_code_difference(const Decoder& decoder);

}  // namespace glidar::structured_light
