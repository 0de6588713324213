// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/structured_light/fringe_patterns.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/math/elementary.hpp>
#include <glidar/structured_light/pattern_size.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr const char* kSideText = "a whole number from 1 to 16384";
constexpr WholeRule kStepRule = {0, 64};
constexpr NumberRule kPeriodRule = {2.0, 16384.0, false, "pixels from 2 to 16384"};
constexpr NumberRule kGammaRule = {0.1, 10.0, false, "a number from 0.1 to 10"};
constexpr std::array<Named<FringeAxis>, 2> kAxisNames = {
    {{"columns", FringeAxis::columns}, {"rows", FringeAxis::rows}}};
constexpr double kMaxGrey = 255.0;

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
    line.push_back(static_cast<std::uint16_t>(std::floor(level * kMaxGrey + 0.5)));
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

}  // namespace glidar
