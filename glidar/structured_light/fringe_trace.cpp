// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/structured_light/fringe_trace.hpp>

#include <glidar/core/decimal_text.hpp>
#include <glidar/core/error.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/structured_light/fringe_evidence.hpp>

namespace glidar {
namespace {

using structured_light::Decoder;
using structured_light::FringeEvidence;

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
  const Decoder decoder = structured_light::make_decoder(images, patterns, decoding);
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
