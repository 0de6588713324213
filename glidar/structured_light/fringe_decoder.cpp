// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/structured_light/fringe_decoder.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace glidar {
namespace {

constexpr NumberRule kCodeErrorRule = {0.25, 0.5, false, "periods from 0.25 to 0.5"};
constexpr WholeRule kLevelRule = {0, 65535};
constexpr std::size_t kGrain = 4096;

/// What is the same for all pixels.
struct Decoder {
  std::span<const GreyImage> images;
  const FringePatterns& patterns;
  const FringeDecoding& decoding;
  std::vector<SineCosine> steps;  ///< of 2 pi k / N
  std::uint32_t bits;
  std::uint32_t saturation_level;
};

struct Fringe {
  double turns = 0.0;  ///< phase / 2 pi, 0 to 1
  double modulation = 0.0;
  double mean = 0.0;
};

double level(const Decoder& decoder, std::size_t image, std::size_t pixel) {
  return decoder.images[image].level[pixel];
}

Fringe measure_fringe(const Decoder& decoder, std::size_t pixel) {
  const auto count = static_cast<double>(decoder.steps.size());
  double sine = 0.0;
  double cosine = 0.0;
  Fringe fringe;
  for (std::size_t k = 0; k < decoder.steps.size(); ++k) {
    const double value = level(decoder, k, pixel);
    fringe.mean += value / count;
    sine += value * decoder.steps[k].sine;
    cosine += value * decoder.steps[k].cosine;
  }
  fringe.turns = atan2_turns(sine, cosine);
  fringe.modulation = 2.0 / count * std::sqrt(sine * sine + cosine * cosine);
  return fringe;
}

/// The mean of the images of the code, which have inverses.
double mean_of_code(const Decoder& decoder, std::size_t pixel) {
  double sum = 0.0;
  const std::size_t first = decoder.patterns.steps;
  for (std::size_t i = first; i < decoder.images.size(); ++i) sum += level(decoder, i, pixel);
  const std::size_t count = decoder.images.size() - first;
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// A stripe by its Gray code.
struct Stripe {
  std::uint32_t number = 0;
  std::uint32_t weak_bits = 0;  ///< how many are not certain
  std::uint32_t other = 0;      ///< the number if the last uncertain bit is the other one
};

Stripe read_stripe(const Decoder& decoder, std::size_t pixel, double mean) {
  const std::size_t images_per_bit = decoder.patterns.has_inverses ? 2 : 1;
  const double min_difference =
      decoder.decoding.min_code_difference / (images_per_bit == 2 ? 1.0 : 2.0);
  bool bit = false;
  Stripe stripe;
  std::uint32_t flipped = 0;  // from a bit of the Gray code on, all bits of the number
  for (std::uint32_t i = 0; i < decoder.bits; ++i) {
    const std::size_t image = decoder.patterns.steps + i * images_per_bit;
    const double rival = images_per_bit == 2 ? level(decoder, image + 1, pixel) : mean;
    const double difference = level(decoder, image, pixel) - rival;
    if (!(std::abs(difference) >= min_difference)) {
      ++stripe.weak_bits;
      flipped = (std::uint32_t{2} << (decoder.bits - 1 - i)) - 1;
    }
    bit = bit != (difference > 0.0);  // from Gray code to binary
    stripe.number = stripe.number << 1U | (bit ? 1U : 0U);
  }
  stripe.other = stripe.number ^ flipped;
  return stripe;
}

/// Between two stripes, one bit is not certain. Either of them leads to the same period.
bool is_certain(const Decoder& decoder, const Stripe& stripe) {
  if (stripe.weak_bits == 0) return true;
  const bool is_between = stripe.other == stripe.number + 1 || stripe.number == stripe.other + 1;
  return stripe.weak_bits == 1 && is_between && decoder.patterns.steps > 0;
}

bool is_saturated(const Decoder& decoder, std::size_t pixel) {
  return std::any_of(decoder.images.begin(), decoder.images.end(), [&](const GreyImage& image) {
    return image.level[pixel] >= decoder.saturation_level;
  });
}

/// Sets the coordinate of a pixel, or returns why it has none.
FringeStatus find_coordinate(const Decoder& decoder, std::size_t pixel, const Fringe& fringe,
                             float& coordinate_px) {
  const bool has_fringes = decoder.patterns.steps > 0;
  if (is_saturated(decoder, pixel)) return FringeStatus::saturated;
  if (has_fringes && !(fringe.modulation >= decoder.decoding.min_modulation)) {
    return FringeStatus::low_modulation;
  }
  const Stripe stripe = read_stripe(decoder, pixel, fringe.mean);
  if (!is_certain(decoder, stripe)) return FringeStatus::weak_code;
  double periods = 0.5 * (stripe.number + 0.5);
  if (has_fringes) {
    const double period = std::floor(periods - fringe.turns + 0.5);
    const double error = std::abs(periods - fringe.turns - period);
    if (error > decoder.decoding.max_code_error) return FringeStatus::inconsistent;
    periods = period + fringe.turns;
  }
  const double place = decoder.patterns.period_px * periods - 0.5;
  if (!(place >= -0.5 && place <= encoded_size(decoder.patterns) - 0.5)) {
    return FringeStatus::outside;
  }
  coordinate_px = static_cast<float>(place);
  return FringeStatus::valid;
}

void decode_pixel(const Decoder& decoder, std::size_t pixel, DecodedFringes& decoded) {
  Fringe fringe;
  if (decoder.patterns.steps > 0) {
    fringe = measure_fringe(decoder, pixel);
    decoded.phase_rad[pixel] = static_cast<float>(2.0 * std::numbers::pi * fringe.turns);
  } else {
    fringe.mean = mean_of_code(decoder, pixel);
  }
  decoded.modulation[pixel] = static_cast<float>(fringe.modulation);
  decoded.mean_level[pixel] = static_cast<float>(fringe.mean);
  decoded.status[pixel] = find_coordinate(decoder, pixel, fringe, decoded.coordinate_px[pixel]);
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
  require_number(accepts(kCodeErrorRule, decoding.max_code_error),
                 "fringe decoding, max_code_error", decoding.max_code_error,
                 kCodeErrorRule.allowed);
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
                 kCodeErrorRule, decoding.max_code_error);
  visitor.whole_number(
      {"saturation_level", "grey level of saturated pixels; 0: the greatest of the pixel type"},
      kLevelRule, decoding.saturation_level);
}

DecodedFringes decode_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                              const FringeDecoding& decoding, ThreadPool* pool) {
  validate(patterns);
  validate_decoding(decoding);
  require_images(images, patterns);
  const GreyImage& first = images.front();
  const std::size_t pixels = first.level.size();
  Decoder decoder = {images,
                     patterns,
                     decoding,
                     {},
                     gray_code_bits(patterns),
                     decoding.saturation_level > 0 ? decoding.saturation_level : first.max_level};
  for (std::uint32_t k = 0; k < patterns.steps; ++k) {
    decoder.steps.push_back(sincos_turns(static_cast<double>(k) / patterns.steps));
  }
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

}  // namespace glidar
