// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/structured_light/fringe_decoder.hpp>

#include <glidar/core/field_visitor.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/structured_light/fringe_evidence.hpp>

namespace glidar {
namespace {

constexpr WholeRule kLevelRule = {0, 65535};
constexpr std::size_t kGrain = 4096;

void decode_pixel(const structured_light::Decoder& decoder, std::size_t pixel,
                  DecodedFringes& decoded) {
  const structured_light::FringeEvidence found = gather_evidence(decoder, pixel);
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
                 structured_light::kMaxCodeErrorRule, decoding.max_code_error);
  visitor.whole_number(
      {"saturation_level", "grey level of saturated pixels; 0: the greatest of the pixel type"},
      kLevelRule, decoding.saturation_level);
}

DecodedFringes decode_fringes(std::span<const GreyImage> images, const FringePatterns& patterns,
                              const FringeDecoding& decoding, ThreadPool* pool) {
  const structured_light::Decoder decoder =
      structured_light::make_decoder(images, patterns, decoding);
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

}  // namespace glidar
