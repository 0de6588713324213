// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field_visitor.hpp>
#include <glidar/core/raw_images.hpp>
#include <glidar/math/thread_pool.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glidar {

class FieldVisitor;

/// Which coordinate of the projector the patterns encode: fringes are columns or rows.
enum class FringeAxis : std::uint8_t { columns, rows };

/// Greatest level of the images: they have 8 bits.
inline constexpr double kMaxPatternLevel = 255.0;

/// A sequence of images that a projector shows one after the other: phase-shifted fringes, then a
/// Gray code whose stripes are half a fringe wide, the coarsest first, each followed by its
/// inverse.
struct FringePatterns {
  std::uint32_t width = 1280;  ///< of the projector's image
  std::uint32_t height = 800;  ///< of it
  FringeAxis axis = FringeAxis::columns;
  std::uint32_t steps = 4;   ///< images of fringes; 0: Gray code alone
  double period_px = 32.0;   ///< of a fringe; stripes of the Gray code are half as wide
  bool has_inverses = true;  ///< of the images of the Gray code; true with steps 0
  double gamma = 1.0;        ///< of the projector, which the levels compensate: level^(1 / gamma)
  double min_level = 0.0;    ///< of the light, as a share of the greatest; 0 to below max_level
  double max_level = 1.0;
};

/// Keys of `patterns`, with bounds and defaults; width and height are those of the projector.
void describe(FringePatterns& patterns, FieldVisitor& visitor);

/// Throws Error naming the first value that is not allowed.
void validate(const FringePatterns& patterns);

/// The encoded coordinate of a pixel (column, row): 0 or 1.
inline int axis_index(const FringePatterns& patterns) {
  return patterns.axis == FringeAxis::columns ? 0 : 1;
}

/// Pixels of the projector along the encoded axis.
std::uint32_t encoded_size(const FringePatterns& patterns);

/// Images of the Gray code, without inverses.
std::uint32_t gray_code_bits(const FringePatterns& patterns);

/// Images of the sequence.
std::size_t image_count(const FringePatterns& patterns);

/// The number of the stripe of half a period in which a pixel is.
std::uint32_t stripe_of(const FringePatterns& patterns, std::uint32_t pixel);

/// The light of image i at pixel x along the encoded axis, as a share of the projector's greatest:
/// for fringes (1 + cos(2 pi ((x + 1/2) / period - i / steps))) / 2 from min_level to max_level.
double fringe_light(const FringePatterns& patterns, std::size_t image, std::uint32_t pixel);

/// The levels of image i of the sequence along the encoded axis, 0 to 255: the light with the
/// projector's gamma compensated, rounded.
std::vector<std::uint16_t> pattern_line(const FringePatterns& patterns, std::size_t image);

/// Image i of the sequence as the projector takes it, 8 bits, see pattern_line(). Throws Error
/// when there is no such image.
GreyImage make_pattern(const FringePatterns& patterns, std::size_t image);

/// Allowed widths and heights of FringePatterns, pixels.
inline constexpr WholeRule kPatternSideRule = {1, 16384};

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

/// One test of a pixel.
struct FringeTest {
  FringeStatus failure = FringeStatus::valid;  ///< the status of a pixel that fails it
  bool has_passed = true;
  std::string finding;  ///< the numbers that were compared
};

/// How a pixel got its coordinate or status.
struct FringeTrace {
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  FringeStatus status = FringeStatus::valid;
  std::uint32_t steps = 0;                 ///< images of fringes, which come first
  std::vector<std::uint16_t> levels = {};  ///< of each image
  double phase_rad = 0.0;                  ///< of the fringes, 0 to 2 pi; 0 without fringes
  double modulation = 0.0;                 ///< levels
  double mean_level = 0.0;
  std::uint32_t stripe = 0;            ///< number of the stripe by the Gray code
  double period = 0.0;                 ///< whole periods that the stripe selects
  double code_error = 0.0;             ///< between phase and code, periods
  double coordinate_px = 0.0;          ///< also of pixels that fail a test
  std::vector<FringeTest> tests = {};  ///< all of them, in their order
};

/// Decodes one pixel as decode_fringes() does, and reports on it. Throws Error as decode_fringes(),
/// and when the pixel is outside the images.
FringeTrace explain_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                            const FringeDecoding& decoding,
                            std::array<std::uint32_t, 2> column_row);

/// The trace as lines of text: grey levels, phase, code and tests.
std::string format_fringe_trace(const FringeTrace& trace);

}  // namespace glidar
