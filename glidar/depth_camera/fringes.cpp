// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/fringes.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/text.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr const char* kSideText = "a whole number from 1 to 16384";
constexpr WholeRule kStepRule = {0, 64};
constexpr NumberRule kPeriodRule = {2.0, 16384.0, false, "pixels from 2 to 16384"};
constexpr NumberRule kGammaRule = {0.1, 10.0, false, "a number from 0.1 to 10"};
constexpr std::array<Named<FringeAxis>, 2> kAxisNames = {
    {{"columns", FringeAxis::columns}, {"rows", FringeAxis::rows}}};

bool within(const WholeRule& rule, std::uint32_t value) {
  return value >= rule.min && value <= rule.max;
}

ErrorParts fault_at(const char* key, double found, const std::string& allowed) {
  return {key, number_text(found), allowed};
}

std::optional<ErrorParts> find_image_fault(const FringePatterns& patterns) {
  if (!within(kPatternSideRule, patterns.width)) {
    return fault_at("width", patterns.width, kSideText);
  }
  if (!within(kPatternSideRule, patterns.height)) {
    return fault_at("height", patterns.height, kSideText);
  }
  const bool has_steps =
      patterns.steps == 0 || (patterns.steps >= 3 && within(kStepRule, patterns.steps));
  if (!has_steps) return fault_at("steps", patterns.steps, "0, or 3 to 64");
  if (patterns.steps > 0 || patterns.has_inverses) return {};
  return ErrorParts{"has_inverses", "is false without fringes, to which bits compare",
                    "true with steps 0", "add inverses, or fringes"};
}

std::optional<ErrorParts> find_level_fault(const FringePatterns& patterns) {
  if (!accepts(kPeriodRule, patterns.period_px)) {
    return fault_at("period_px", patterns.period_px, kPeriodRule.allowed);
  }
  if (!accepts(kGammaRule, patterns.gamma)) {
    return fault_at("gamma", patterns.gamma, kGammaRule.allowed);
  }
  if (!accepts(kZeroToOne, patterns.min_level)) {
    return fault_at("min_level", patterns.min_level, kZeroToOne.allowed);
  }
  if (!accepts(kZeroToOne, patterns.max_level) || patterns.max_level <= patterns.min_level) {
    return fault_at("max_level", patterns.max_level, "a number above min_level, up to 1");
  }
  if (image_count(patterns) > 0) return {};
  return fault_at("period_px", patterns.period_px,
                  "a stripe, half a period, narrower than the projector's image");
}

/// The first value that is not allowed, at its key; empty: none.
std::optional<ErrorParts> find_fault(const FringePatterns& patterns) {
  std::optional<ErrorParts> fault = find_image_fault(patterns);
  return fault ? fault : find_level_fault(patterns);
}

/// Whether a stripe is bright in an image of the Gray code.
bool is_bright(const FringePatterns& patterns, std::size_t code_image, std::uint32_t stripe) {
  const std::size_t images_per_bit = patterns.has_inverses ? 2 : 1;
  const std::size_t bit = gray_code_bits(patterns) - 1 - code_image / images_per_bit;
  const bool is_inverse = code_image % images_per_bit == 1;
  const std::uint32_t gray = stripe ^ (stripe >> 1U);
  return ((gray >> bit & 1U) != 0) != is_inverse;
}

/// The level for which a projector of this gamma emits the light.
double encoded_level(double light, double gamma) {
  return gamma == 1.0 || light == 0.0 ? light : portable_pow(light, 1.0 / gamma);
}

}  // namespace

void describe(FringePatterns& patterns, FieldVisitor& visitor) {
  visit_choice(visitor, {"axis", "the coordinate of the projector that is encoded"}, kAxisNames,
               patterns.axis);
  visitor.whole_number({"steps", "images of fringes, at least 3; 0: Gray code alone"}, kStepRule,
                       patterns.steps);
  visitor.number(
      {"period_px", "of a fringe; stripes of the Gray code are half as wide", kUnitPixel},
      kPeriodRule, patterns.period_px);
  visitor.boolean({"has_inverses", "each image of the Gray code is followed by its inverse"},
                  patterns.has_inverses);
  visitor.number({"gamma", "of the projector, which the levels of the images compensate"},
                 kGammaRule, patterns.gamma);
  visitor.number({"min_level", "least light, as a share of the projector's greatest"}, kZeroToOne,
                 patterns.min_level);
  visitor.number({"max_level", "greatest light, above `min_level`"}, kZeroToOne,
                 patterns.max_level);
  if (!visitor.is_reading()) return;
  const std::optional<ErrorParts> fault = find_fault(patterns);
  if (!fault) return;
  const char* key = fault->where.c_str();
  const std::string name = visitor.has(key) ? "" : fault->where + ": ";  // a default does not fit
  visitor.reject(key, name + fault->found, fault->allowed, fault->remedy);
}

void validate(const FringePatterns& patterns) {
  std::optional<ErrorParts> fault = find_fault(patterns);
  if (!fault) return;
  fault->where = "fringe patterns, " + fault->where;
  throw Error(*std::move(fault));
}

std::uint32_t encoded_size(const FringePatterns& patterns) {
  return patterns.axis == FringeAxis::columns ? patterns.width : patterns.height;
}

std::uint32_t gray_code_bits(const FringePatterns& patterns) {
  const std::uint32_t last = stripe_of(patterns, encoded_size(patterns) - 1);
  return static_cast<std::uint32_t>(std::bit_width(last));
}

std::size_t image_count(const FringePatterns& patterns) {
  return patterns.steps + std::size_t{gray_code_bits(patterns)} * (patterns.has_inverses ? 2 : 1);
}

std::uint32_t stripe_of(const FringePatterns& patterns, std::uint32_t pixel) {
  return static_cast<std::uint32_t>(std::floor((pixel + 0.5) / (0.5 * patterns.period_px)));
}

double fringe_light(const FringePatterns& patterns, std::size_t image, std::uint32_t pixel) {
  double share = 0.0;
  if (image < patterns.steps) {
    const double turns =
        (pixel + 0.5) / patterns.period_px - static_cast<double>(image) / patterns.steps;
    share = 0.5 * (1.0 + sincos_turns(turns).cosine);
  } else {
    share = is_bright(patterns, image - patterns.steps, stripe_of(patterns, pixel)) ? 1.0 : 0.0;
  }
  return patterns.min_level + (patterns.max_level - patterns.min_level) * share;
}

std::vector<std::uint16_t> pattern_line(const FringePatterns& patterns, std::size_t image) {
  std::vector<std::uint16_t> line;
  line.reserve(encoded_size(patterns));
  for (std::uint32_t i = 0; i < encoded_size(patterns); ++i) {
    const double level = encoded_level(fringe_light(patterns, image, i), patterns.gamma);
    line.push_back(static_cast<std::uint16_t>(std::floor(level * kMaxPatternLevel + 0.5)));
  }
  return line;
}

GreyImage make_pattern(const FringePatterns& patterns, std::size_t image) {
  validate(patterns);
  if (image >= image_count(patterns)) {
    throw Error({"fringe patterns", "there is no image " + std::to_string(image),
                 "0 to " + std::to_string(image_count(patterns) - 1), ""});
  }
  const std::vector<std::uint16_t> line = pattern_line(patterns, image);
  GreyImage pattern = {patterns.width, patterns.height};
  pattern.level.reserve(std::size_t{patterns.width} * patterns.height);
  for (std::uint32_t y = 0; y < patterns.height; ++y) {
    if (patterns.axis == FringeAxis::columns) {
      pattern.level.insert(pattern.level.end(), line.begin(), line.end());
    } else {
      pattern.level.insert(pattern.level.end(), patterns.width, line[y]);
    }
  }
  return pattern;
}

namespace {

/// Allowed values of FringeDecoding::max_code_error.
constexpr NumberRule kMaxCodeErrorRule = {0.25, 0.5, false, "periods from 0.25 to 0.5"};

/// What is the same for all pixels.
struct Decoder {
  std::span<const GreyImage> images;
  const FringePatterns& patterns;
  const FringeDecoding& decoding;
  std::vector<SineCosine> steps;  ///< of 2 pi k / N
  std::uint32_t bits = 0;
  std::uint32_t saturation_level = 0;
};

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

double level(const Decoder& decoder, std::size_t image, std::size_t pixel) {
  return decoder.images[image].level[pixel];
}

bool has_fringes(const Decoder& decoder) {
  return !decoder.steps.empty();
}

void measure_phase(const Decoder& decoder, std::size_t pixel, FringeEvidence& evidence) {
  const auto count = static_cast<double>(decoder.steps.size());
  double sine = 0.0;
  double cosine = 0.0;
  for (std::size_t k = 0; k < decoder.steps.size(); ++k) {
    const double value = level(decoder, k, pixel);
    evidence.mean_level += value / count;
    sine += value * decoder.steps[k].sine;
    cosine += value * decoder.steps[k].cosine;
  }
  evidence.turns = atan2_turns(sine, cosine);
  evidence.modulation = 2.0 / count * std::sqrt(sine * sine + cosine * cosine);
}

/// The mean of the images of the code, which have inverses.
double mean_of_code(const Decoder& decoder, std::size_t pixel) {
  double sum = 0.0;
  const std::size_t first = decoder.patterns.steps;
  for (std::size_t i = first; i < decoder.images.size(); ++i) sum += level(decoder, i, pixel);
  const std::size_t count = decoder.images.size() - first;
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Least difference that makes a bit certain, levels.
double min_code_difference(const Decoder& decoder) {
  return decoder.decoding.min_code_difference * (decoder.patterns.has_inverses ? 1.0 : 0.5);
}

Stripe read_stripe(const Decoder& decoder, std::size_t pixel, double mean) {
  const std::size_t images_per_bit = decoder.patterns.has_inverses ? 2 : 1;
  const double needed = min_code_difference(decoder);
  bool bit = false;
  Stripe stripe{.min_difference = kInfinity};
  std::uint32_t flipped = 0;  // from a bit of the Gray code on, all bits of the number
  for (std::uint32_t i = 0; i < decoder.bits; ++i) {
    const std::size_t image = decoder.patterns.steps + i * images_per_bit;
    const double rival = images_per_bit == 2 ? level(decoder, image + 1, pixel) : mean;
    const double difference = level(decoder, image, pixel) - rival;
    stripe.min_difference = std::min(stripe.min_difference, std::abs(difference));
    if (!(std::abs(difference) >= needed)) {
      ++stripe.weak_bits;
      flipped = (std::uint32_t{2} << (decoder.bits - 1 - i)) - 1;
    }
    bit = bit != (difference > 0.0);  // from Gray code to binary
    stripe.number = stripe.number << 1U | (bit ? 1U : 0U);
  }
  stripe.other = stripe.number ^ flipped;
  return stripe;
}

void require_images(std::span<const GreyImage> images, const FringePatterns& patterns) {
  if (images.size() != image_count(patterns)) {
    throw Error({"structured light", std::to_string(images.size()) + " images",
                 std::to_string(image_count(patterns)) + ", one for each pattern", ""});
  }
  const GreyImage& first = images.front();
  for (std::size_t i = 0; i < images.size(); ++i) {
    const GreyImage& image = images[i];
    const std::size_t pixels = std::size_t{image.width} * image.height;
    if (pixels > 0 && image.level.size() == pixels && image.width == first.width &&
        image.height == first.height && image.max_level == first.max_level) {
      continue;
    }
    throw Error({"structured light, image " + std::to_string(i),
                 "has " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " pixels of up to " + std::to_string(image.max_level) + ", the first one " +
                     std::to_string(first.width) + "x" + std::to_string(first.height) +
                     " of up to " + std::to_string(first.max_level),
                 "images of equal size and type", ""});
  }
}

void validate_decoding(const FringeDecoding& decoding) {
  require_number(accepts(kFromZero, decoding.min_modulation), "fringe decoding, min_modulation",
                 decoding.min_modulation, kFromZero.allowed);
  require_number(accepts(kFromZero, decoding.min_code_difference),
                 "fringe decoding, min_code_difference", decoding.min_code_difference,
                 kFromZero.allowed);
  require_number(accepts(kMaxCodeErrorRule, decoding.max_code_error),
                 "fringe decoding, max_code_error", decoding.max_code_error,
                 kMaxCodeErrorRule.allowed);
}

/// Throws Error as decode_fringes(). Refers to its arguments.
Decoder make_decoder(std::span<const GreyImage> images, const FringePatterns& patterns,
                     const FringeDecoding& decoding) {
  validate(patterns);
  validate_decoding(decoding);
  require_images(images, patterns);
  Decoder decoder = {
      images,
      patterns,
      decoding,
      {},
      gray_code_bits(patterns),
      decoding.saturation_level > 0 ? decoding.saturation_level : images.front().max_level};
  for (std::uint32_t k = 0; k < patterns.steps; ++k) {
    decoder.steps.push_back(sincos_turns(static_cast<double>(k) / patterns.steps));
  }
  return decoder;
}

FringeEvidence gather_evidence(const Decoder& decoder, std::size_t pixel) {
  FringeEvidence evidence;
  for (std::size_t i = 0; i < decoder.images.size(); ++i) {
    evidence.max_level = std::max(evidence.max_level, level(decoder, i, pixel));
  }
  if (has_fringes(decoder)) {
    measure_phase(decoder, pixel, evidence);
  } else {
    evidence.mean_level = mean_of_code(decoder, pixel);
  }
  evidence.stripe = read_stripe(decoder, pixel, evidence.mean_level);
  double periods = 0.5 * (evidence.stripe.number + 0.5);
  if (has_fringes(decoder)) {
    evidence.period = std::floor(periods - evidence.turns + 0.5);
    evidence.code_error = std::abs(periods - evidence.turns - evidence.period);
    periods = evidence.period + evidence.turns;
  }
  evidence.place_px = decoder.patterns.period_px * periods - 0.5;
  return evidence;
}

bool is_unsaturated(const Decoder& decoder, const FringeEvidence& pixel) {
  return pixel.max_level < decoder.saturation_level;
}

bool has_modulation(const Decoder& decoder, const FringeEvidence& pixel) {
  return !has_fringes(decoder) || pixel.modulation >= decoder.decoding.min_modulation;
}

/// Between two stripes, one bit is not certain. Either of them leads to the same period.
bool is_code_certain(const Decoder& decoder, const FringeEvidence& pixel) {
  const Stripe& stripe = pixel.stripe;
  if (stripe.weak_bits == 0) return true;
  const bool is_between = stripe.other == stripe.number + 1 || stripe.number == stripe.other + 1;
  return stripe.weak_bits == 1 && is_between && has_fringes(decoder);
}

bool is_consistent(const Decoder& decoder, const FringeEvidence& pixel) {
  return pixel.code_error <= decoder.decoding.max_code_error;
}

bool is_inside(const Decoder& decoder, const FringeEvidence& pixel) {
  return pixel.place_px >= -0.5 && pixel.place_px <= encoded_size(decoder.patterns) - 0.5;
}

/// The first test that fails.
FringeStatus status_of(const Decoder& decoder, const FringeEvidence& pixel) {
  if (!is_unsaturated(decoder, pixel)) return FringeStatus::saturated;
  if (!has_modulation(decoder, pixel)) return FringeStatus::low_modulation;
  if (!is_code_certain(decoder, pixel)) return FringeStatus::weak_code;
  if (!is_consistent(decoder, pixel)) return FringeStatus::inconsistent;
  return is_inside(decoder, pixel) ? FringeStatus::valid : FringeStatus::outside;
}

constexpr WholeRule kLevelRule = {0, 65535};
constexpr std::size_t kGrain = 4096;

void decode_pixel(const Decoder& decoder, std::size_t pixel, DecodedFringes& decoded) {
  const FringeEvidence found = gather_evidence(decoder, pixel);
  if (decoder.patterns.steps > 0) {
    decoded.phase_rad[pixel] = static_cast<float>(kTwoPi * found.turns);
  }
  decoded.modulation[pixel] = static_cast<float>(found.modulation);
  decoded.mean_level[pixel] = static_cast<float>(found.mean_level);
  decoded.status[pixel] = status_of(decoder, found);
  if (decoded.status[pixel] == FringeStatus::valid) {
    decoded.coordinate_px[pixel] = static_cast<float>(found.place_px);
  }
}

}  // namespace

const char* to_string(FringeStatus status) {
  static constexpr const char* kNames[kFringeStatusCount] = {
      "valid", "saturated", "low_modulation", "weak_code", "inconsistent", "outside"};
  return kNames[static_cast<std::size_t>(status)];
}

void describe(FringeDecoding& decoding, FieldVisitor& visitor) {
  visitor.number({"min_modulation", "least amplitude of the fringes, grey levels"}, kFromZero,
                 decoding.min_modulation);
  visitor.number(
      {"min_code_difference",
       "least difference between an image of the Gray code and its inverse, grey levels; "
       "half of it to the mean, without inverses"},
      kFromZero, decoding.min_code_difference);
  visitor.number({"max_code_error",
                  "greatest difference between phase and Gray code, periods; 0.25 without noise"},
                 kMaxCodeErrorRule, decoding.max_code_error);
  visitor.whole_number(
      {"saturation_level", "grey level of saturated pixels; 0: the greatest of the pixel type"},
      kLevelRule, decoding.saturation_level);
}

DecodedFringes decode_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                              const FringeDecoding& decoding, ThreadPool* pool) {
  const Decoder decoder = make_decoder(images, patterns, decoding);
  const GreyImage& first = images.front();
  const std::size_t pixels = first.level.size();
  DecodedFringes decoded = {first.width,
                            first.height,
                            std::vector<float>(pixels, kNaNf),
                            std::vector<float>(pixels, kNaNf),
                            std::vector<float>(pixels),
                            std::vector<float>(pixels),
                            std::vector<FringeStatus>(pixels)};
  const auto decode_range = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) decode_pixel(decoder, i, decoded);
  };
  if (pool == nullptr) {
    decode_range(0, pixels);
  } else {
    pool->parallel_for(pixels, kGrain, decode_range);
  }
  return decoded;
}

namespace {

std::string certainty_text(const Decoder& decoder, const FringeEvidence& pixel) {
  return "least difference of a bit " + decimal_text(pixel.stripe.min_difference) +
         " levels, needed: " + decimal_text(min_code_difference(decoder)) + "; " +
         std::to_string(pixel.stripe.weak_bits) + " of " + std::to_string(decoder.bits) +
         " bits uncertain";
}

std::vector<FringeTest> list_tests(const Decoder& decoder, const FringeEvidence& pixel) {
  const FringeDecoding& decoding = decoder.decoding;
  return {
      {FringeStatus::saturated, is_unsaturated(decoder, pixel),
       "greatest level " + decimal_text(pixel.max_level, 0) +
           ", saturated from: " + std::to_string(decoder.saturation_level)},
      {FringeStatus::low_modulation, has_modulation(decoder, pixel),
       "modulation " + decimal_text(pixel.modulation) +
           " levels, needed: " + decimal_text(decoding.min_modulation)},
      {FringeStatus::weak_code, is_code_certain(decoder, pixel), certainty_text(decoder, pixel)},
      {FringeStatus::inconsistent, is_consistent(decoder, pixel),
       "phase and code differ by " + decimal_text(pixel.code_error, 3) +
           " periods, allowed: " + decimal_text(decoding.max_code_error, 3)},
      {FringeStatus::outside, is_inside(decoder, pixel),
       "coordinate " + decimal_text(pixel.place_px) + " px of " +
           std::to_string(encoded_size(decoder.patterns))}};
}

void require_pixel(const GreyImage& image, std::array<std::uint32_t, 2> column_row) {
  const auto [column, row] = column_row;
  if (column < image.width && row < image.height) return;
  throw Error({"pixel to explain",
               std::to_string(column) + "," + std::to_string(row) + " is outside the images",
               "columns 0 to " + std::to_string(image.width - 1) + ", rows 0 to " +
                   std::to_string(image.height - 1),
               ""});
}

std::string level_line(const FringeTrace& trace, const char* name, std::size_t begin,
                       std::size_t end) {
  if (begin == end) return "";
  std::string text = std::string(name) + ": grey levels";
  for (std::size_t i = begin; i < end; ++i) text += " " + std::to_string(trace.levels[i]);
  return text + "\n";
}

}  // namespace

FringeTrace explain_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                            const FringeDecoding& decoding,
                            std::array<std::uint32_t, 2> column_row) {
  const Decoder decoder = make_decoder(images, patterns, decoding);
  require_pixel(images.front(), column_row);
  const auto [column, row] = column_row;
  const std::size_t index = std::size_t{row} * images.front().width + column;
  const FringeEvidence pixel = gather_evidence(decoder, index);
  FringeTrace trace{.column = column,
                    .row = row,
                    .status = status_of(decoder, pixel),
                    .steps = patterns.steps,
                    .phase_rad = kTwoPi * pixel.turns,
                    .modulation = pixel.modulation,
                    .mean_level = pixel.mean_level,
                    .stripe = pixel.stripe.number,
                    .period = pixel.period,
                    .code_error = pixel.code_error,
                    .coordinate_px = pixel.place_px};
  for (const GreyImage& image : images) trace.levels.push_back(image.level[index]);
  trace.tests = list_tests(decoder, pixel);
  return trace;
}

std::string format_fringe_trace(const FringeTrace& trace) {
  std::string text = "pixel " + std::to_string(trace.column) + "," + std::to_string(trace.row) +
                     ": " + to_string(trace.status) + "\n";
  text += level_line(trace, "fringes", 0, trace.steps);
  text += level_line(trace, "Gray code", trace.steps, trace.levels.size());
  if (trace.steps > 0) {
    text += "phase " + decimal_text(trace.phase_rad, 4) + " rad, modulation " +
            decimal_text(trace.modulation) + " levels, mean " + decimal_text(trace.mean_level) +
            "\n";
  }
  text += "stripe " + std::to_string(trace.stripe) + " of the code, period " +
          decimal_text(trace.period, 0) + ", coordinate " + decimal_text(trace.coordinate_px, 4) +
          " px\n";
  for (const FringeTest& test : trace.tests) {
    text += std::string(test.has_passed ? "  passed  " : "  failed  ") + to_string(test.failure) +
            ": " + test.finding + "\n";
  }
  return text;
}

}  // namespace glidar
