// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/structured_light/fringe_evidence.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace glidar::structured_light {
namespace {

double level(const Decoder& decoder, std::size_t image, std::size_t pixel) {
  return decoder.images[image].level[pixel];
}

bool has_fringes(const Decoder& decoder) {
  return !decoder.steps.empty();
}

void measure_fringes(const Decoder& decoder, std::size_t pixel, FringeEvidence& evidence) {
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

}  // namespace

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
    measure_fringes(decoder, pixel, evidence);
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

FringeStatus status_of(const Decoder& decoder, const FringeEvidence& pixel) {
  if (!is_unsaturated(decoder, pixel)) return FringeStatus::saturated;
  if (!has_modulation(decoder, pixel)) return FringeStatus::low_modulation;
  if (!is_code_certain(decoder, pixel)) return FringeStatus::weak_code;
  if (!is_consistent(decoder, pixel)) return FringeStatus::inconsistent;
  return is_inside(decoder, pixel) ? FringeStatus::valid : FringeStatus::outside;
}

double min_code_difference(const Decoder& decoder) {
  return decoder.decoding.min_code_difference * (decoder.patterns.has_inverses ? 1.0 : 0.5);
}

}  // namespace glidar::structured_light
