// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/fringes.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <support/error_text.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace glidar {
namespace {

using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

/// The camera sees the projector's pixels one to one, in shades a + b times the light, 16 bits.
std::vector<GreyImage> see(const FringePatterns& patterns, double a = 3000.0, double b = 50000.0) {
  std::vector<GreyImage> images;
  for (std::size_t i = 0; i < image_count(patterns); ++i) {
    GreyImage image = {patterns.width, patterns.height, 65535};
    for (std::uint32_t y = 0; y < patterns.height; ++y) {
      for (std::uint32_t x = 0; x < patterns.width; ++x) {
        const std::uint32_t place = patterns.axis == FringeAxis::columns ? x : y;
        image.level.push_back(
            static_cast<std::uint16_t>(std::lround(a + b * fringe_light(patterns, i, place))));
      }
    }
    images.push_back(std::move(image));
  }
  return images;
}

FringePatterns small_patterns() {
  return {.width = 200, .height = 3, .period_px = 18.0};
}

TEST(FringePatterns, GrayCodesOfNeighbouringStripesDifferInOneBit) {
  const FringePatterns patterns = {.width = 640, .steps = 0, .period_px = 2.0};
  ASSERT_EQ(image_count(patterns), 20U);
  for (std::uint32_t x = 0; x + 1 < patterns.width; ++x) {
    int changes = 0;
    for (std::size_t i = 0; i < image_count(patterns); ++i) {
      changes += fringe_light(patterns, i, x) != fringe_light(patterns, i, x + 1) ? 1 : 0;
    }
    EXPECT_EQ(changes, 2) << x;  // and its inverse
  }
}

TEST(FringePatterns, InversesAreInverse) {
  const FringePatterns patterns = small_patterns();
  for (std::size_t i = patterns.steps; i < image_count(patterns); i += 2) {
    for (std::uint32_t x = 0; x < patterns.width; ++x) {
      EXPECT_EQ(fringe_light(patterns, i, x) + fringe_light(patterns, i + 1, x), 1.0);
    }
  }
}

TEST(FringePatterns, FringesAreCosinesOfTheirPeriod) {
  const FringePatterns patterns = {
      .steps = 5, .period_px = 24.0, .min_level = 0.1, .max_level = 0.9};
  for (std::size_t k = 0; k < 5; ++k) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      const double phase = 2.0 * kPi * ((x + 0.5) / 24.0 - static_cast<double>(k) / 5.0);
      EXPECT_NEAR(fringe_light(patterns, k, x), 0.5 + 0.4 * std::cos(phase), 1e-12);
    }
  }
}

TEST(FringePatterns, LevelsCompensateTheGammaOfTheProjector) {
  const FringePatterns patterns = {.width = 64, .height = 2, .period_px = 64.0, .gamma = 2.2};
  const GreyImage image = make_pattern(patterns, 0);
  ASSERT_EQ(image.level.size(), 128U);
  for (std::uint32_t x = 0; x < patterns.width; ++x) {
    EXPECT_NEAR(std::pow(image.level[x] / 255.0, 2.2), fringe_light(patterns, 0, x), 0.0045);
  }
}

TEST(FringePatterns, RowsAreColumnsTurned) {
  FringePatterns patterns = {.width = 30, .height = 40, .period_px = 20.0};
  patterns.axis = FringeAxis::rows;
  const GreyImage image = make_pattern(patterns, 1);
  for (std::uint32_t y = 0; y < 40; ++y) {
    for (std::uint32_t x = 1; x < 30; ++x) EXPECT_EQ(image.level[y * 30 + x], image.level[y * 30]);
  }
}

TEST(FringeDecoder, GrayCodeWithoutNoiseIsExact) {
  const FringePatterns patterns = {.width = 640, .height = 1, .steps = 0, .period_px = 2.0};
  const DecodedFringes decoded = decode_fringes(see(patterns), patterns, {});
  for (std::uint32_t x = 0; x < patterns.width; ++x) {
    EXPECT_EQ(decoded.coordinate_px[x], static_cast<float>(x));
    EXPECT_EQ(decoded.mean_level[x], 28000.0F);
  }
}

TEST(FringeDecoder, CodesWithoutInversesAreComparedWithTheMeanOfTheFringes) {
  FringePatterns patterns = small_patterns();
  patterns.has_inverses = false;
  ASSERT_EQ(image_count(patterns), 9U);
  const DecodedFringes decoded = decode_fringes(see(patterns), patterns, {});
  for (std::uint32_t x = 0; x < patterns.width; ++x) EXPECT_NEAR(decoded.coordinate_px[x], x, 1e-3);
}

TEST(FringeDecoder, FringesWithoutNoiseAreExactToTheRoundingOfLevels) {
  for (const std::uint32_t steps : {3U, 4U, 8U}) {
    for (const double period_px : {18.0, 25.7, 200.0}) {
      FringePatterns patterns = small_patterns();
      patterns.steps = steps;
      patterns.period_px = period_px;
      const DecodedFringes decoded = decode_fringes(see(patterns), patterns, {});
      // Levels are rounded by up to 1/2, which moves the phase by at most 2/N sum |sin| / 2 / B <
      // 1/B.
      const double tolerance_px = period_px / (2.0 * kPi) / 25000.0 + 1e-5;
      for (std::uint32_t x = 0; x < patterns.width; ++x) {
        ASSERT_EQ(decoded.status[x], FringeStatus::valid);
        EXPECT_NEAR(decoded.coordinate_px[x], x, tolerance_px) << steps << " " << period_px;
        EXPECT_NEAR(decoded.modulation[x], 25000.0, 1.0);
        EXPECT_NEAR(decoded.mean_level[x], 28000.0, 1.0);
      }
    }
  }
}

TEST(FringeDecoder, RowsOfTheProjectorAreFoundAsWell) {
  FringePatterns patterns = {
      .width = 3, .height = 150, .axis = FringeAxis::rows, .period_px = 20.0};
  const DecodedFringes decoded = decode_fringes(see(patterns), patterns, {});
  for (std::uint32_t y = 0; y < 150; ++y) EXPECT_NEAR(decoded.coordinate_px[3 * y + 1], y, 1e-3);
}

TEST(FringeDecoder, DisplacedCodesOfUpToAQuarterPeriodCauseNoError) {
  const FringePatterns patterns = small_patterns();
  std::vector<GreyImage> images = see(patterns);
  const std::vector<GreyImage> original = images;
  for (std::size_t i = patterns.steps; i < images.size(); ++i) {
    for (std::size_t x = 0; x + 4 < patterns.width; ++x) {
      images[i].level[x] = original[i].level[x + 4];  // of 18 pixels
    }
  }
  const DecodedFringes decoded = decode_fringes(images, patterns, {.max_code_error = 0.5});
  for (std::uint32_t x = 0; x + 4 < patterns.width; ++x) {
    EXPECT_NEAR(decoded.coordinate_px[x], x, 1e-3);
  }
}

TEST(FringeDecoder, OneUncertainBitBetweenTwoStripesCausesNoHole) {
  const FringePatterns patterns = small_patterns();  // stripes of 9 pixels
  std::vector<GreyImage> images = see(patterns);
  for (const std::size_t edge : {9U, 18U, 72U, 180U}) {
    for (std::size_t i = patterns.steps; i < images.size(); ++i) {
      // the camera sees half of the stripe on the left and half of the one on the right
      const int left = images[i].level[edge - 1];
      images[i].level[edge] = static_cast<std::uint16_t>((left + images[i].level[edge]) / 2);
    }
  }
  const DecodedFringes decoded = decode_fringes(images, patterns, {});
  for (std::uint32_t x = 0; x < patterns.width; ++x) {
    ASSERT_EQ(decoded.status[x], FringeStatus::valid) << x;
    EXPECT_NEAR(decoded.coordinate_px[x], x, 1e-3);
  }
}

/// sqrt(2 / N) sigma / B (docs/structured-light.md).
double phase_law(std::uint32_t steps, double sigma, double amplitude) {
  return std::sqrt(2.0 / steps) * sigma / amplitude;
}

TEST(FringeDecoder, NoiseOfThePhaseFollowsItsLaw) {
  constexpr double kSigma = 300.0;
  for (const std::uint32_t steps : {3U, 4U, 8U}) {
    FringePatterns patterns = {.width = 256, .height = 100, .period_px = 64.0};
    patterns.steps = steps;
    std::vector<GreyImage> images = see(patterns);
    std::mt19937 random(steps);
    std::normal_distribution<double> noise(0.0, kSigma);
    for (std::size_t i = 0; i < steps; ++i) {
      for (std::uint16_t& level : images[i].level) {
        level = static_cast<std::uint16_t>(std::lround(level + noise(random)));
      }
    }
    const DecodedFringes decoded = decode_fringes(images, patterns, {});
    double sum = 0.0;
    for (std::size_t i = 0; i < decoded.coordinate_px.size(); ++i) {
      ASSERT_EQ(decoded.status[i], FringeStatus::valid);
      const double error_px = decoded.coordinate_px[i] - static_cast<double>(i % 256);
      sum += error_px * error_px;
    }
    const double count = static_cast<double>(decoded.coordinate_px.size());
    const double sigma_rad = std::sqrt(sum / count) * 2.0 * kPi / patterns.period_px;
    // 25,600 samples: the standard error is 0.44 %.
    EXPECT_NEAR(sigma_rad / phase_law(steps, kSigma, 25000.0), 1.0, 0.02) << steps;
  }
}

TEST(FringeDecoder, GammaThatIsNotCompensatedCausesRipplesOfNPerPeriod) {
  FringePatterns patterns = {.width = 360, .height = 1, .steps = 3, .period_px = 120.0};
  std::vector<GreyImage> images = see(patterns);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::uint16_t& level : images[i].level) {
      level = static_cast<std::uint16_t>(
          std::lround(3000.0 + 50000.0 * std::pow((level - 3000.0) / 50000.0, 2.0)));
    }
  }
  const DecodedFringes decoded = decode_fringes(images, patterns, {});
  // ((1 + cos)/2)^2 = 3/8 + cos/2 + cos(2)/8: the second harmonic is 1/4 of the first, and three
  // steps turn it by -3 phi, so that tan(error) = -sin(3 phi) / (4 + cos(3 phi)).
  for (std::uint32_t x = 0; x < patterns.width; ++x) {
    const double phi = 2.0 * kPi * (x + 0.5) / 120.0;
    const double error = -std::atan2(std::sin(3.0 * phi), 4.0 + std::cos(3.0 * phi));
    EXPECT_NEAR((double{decoded.coordinate_px[x]} - x) * 2.0 * kPi / 120.0, error, 1e-4) << x;
  }
}

/// The status of pixel 50 after a change of its levels.
FringeStatus status_after(const std::function<void(std::vector<GreyImage>&)>& change,
                          const FringeDecoding& decoding = {}) {
  const FringePatterns patterns = small_patterns();
  std::vector<GreyImage> images = see(patterns);
  change(images);
  const DecodedFringes decoded = decode_fringes(images, patterns, decoding);
  EXPECT_EQ(std::isnan(decoded.coordinate_px[50]), decoded.status[50] != FringeStatus::valid);
  EXPECT_EQ(decoded.status[49], FringeStatus::valid);
  return decoded.status[50];
}

TEST(FringeDecoder, EveryHoleHasItsCause) {
  const std::size_t code = small_patterns().steps;
  EXPECT_EQ(status_after([](auto&) {}), FringeStatus::valid);
  EXPECT_EQ(status_after([](auto& images) { images[1].level[50] = 65535; }),
            FringeStatus::saturated);
  EXPECT_EQ(status_after([](auto& images) {
              for (GreyImage& image : images) image.level[50] = 3000;
            }),
            FringeStatus::low_modulation);
  EXPECT_EQ(status_after([&](auto& images) {
              images[code + 2].level[50] = images[code + 3].level[50] = 9000;
            }),
            FringeStatus::weak_code);
  EXPECT_EQ(status_after([&](auto& images) {  // the last bit: another stripe
              std::swap(images[images.size() - 2].level[50], images[images.size() - 1].level[50]);
            }),
            FringeStatus::inconsistent);
  EXPECT_EQ(status_after(
                [&](auto& images) {  // the first bit: 31 - 5 stripes of 9 pixels
                  std::swap(images[code].level[50], images[code + 1].level[50]);
                },
                {.max_code_error = 0.5}),
            FringeStatus::outside);
  EXPECT_STREQ(to_string(FringeStatus::weak_code), "weak_code");
}

TEST(FringeDecoder, ResultsAreTheSameForAnyNumberOfThreads) {
  const FringePatterns patterns = {.width = 300, .height = 60, .period_px = 20.0};
  const std::vector<GreyImage> images = see(patterns);
  const DecodedFringes alone = decode_fringes(images, patterns, {});
  for (const unsigned threads : {1U, 3U}) {
    ThreadPool pool(threads);
    const DecodedFringes decoded = decode_fringes(images, patterns, {}, &pool);
    EXPECT_EQ(decoded.coordinate_px, alone.coordinate_px);
    EXPECT_EQ(decoded.modulation, alone.modulation);
  }
}

TEST(FringeDecoder, ErrorsSayWhatIsAllowed) {
  const FringePatterns patterns = small_patterns();
  const auto error_of = [&](const FringePatterns& changed, const FringeDecoding& decoding = {}) {
    return error_text([&] { decode_fringes(see(patterns), changed, decoding); });
  };
  EXPECT_THAT(error_of({.width = 200, .height = 3, .steps = 2}), HasSubstr("steps: 2"));
  EXPECT_THAT(error_of({.width = 0}), HasSubstr("width"));
  EXPECT_THAT(error_of({.period_px = 1.0}), HasSubstr("period_px"));
  EXPECT_THAT(error_of({.steps = 0, .period_px = 4000.0}), HasSubstr("period_px"));
  EXPECT_THAT(error_of({.steps = 0, .has_inverses = false}), HasSubstr("has_inverses"));
  EXPECT_THAT(error_of({.min_level = 0.5, .max_level = 0.5}), HasSubstr("max_level"));
  EXPECT_THAT(error_of({.gamma = 0.0}), HasSubstr("gamma"));
  EXPECT_THAT(error_of({.width = 200, .height = 3, .steps = 5, .period_px = 18.0}),
              HasSubstr("14 images"));
  EXPECT_THAT(error_of(patterns, {.max_code_error = 0.6}), HasSubstr("max_code_error"));
  EXPECT_THAT(error_of(patterns, {.min_modulation = -1.0}), HasSubstr("min_modulation"));
  std::vector<GreyImage> images = see(patterns);
  images[3].width = 100;
  EXPECT_THAT(error_text([&] { decode_fringes(images, patterns, {}); }), HasSubstr("image 3"));
  EXPECT_THAT(error_text([&] { make_pattern(patterns, 14); }), HasSubstr("0 to 13"));
}

constexpr FringePatterns kPatterns = {.width = 200, .height = 2, .period_px = 18.0};

/// The camera sees the projector's pixels one to one, and pixel 50 of row 1 not at all.
std::vector<GreyImage> see_patterns() {
  std::vector<GreyImage> images;
  for (std::size_t i = 0; i < image_count(kPatterns); ++i) {
    images.push_back(make_pattern(kPatterns, i));
    for (std::uint16_t& level : images.back().level)
      level = static_cast<std::uint16_t>(level * 200);
    images.back().max_level = 65535;
    images.back().level[200 + 50] = 7;
  }
  return images;
}

TEST(FringeTrace, AgreesWithTheDecoderInEveryPixel) {
  const std::vector<GreyImage> images = see_patterns();
  const DecodedFringes decoded = decode_fringes(images, kPatterns, {});
  for (std::uint32_t row = 0; row < 2; ++row) {
    for (std::uint32_t column = 0; column < 200; ++column) {
      const FringeTrace trace = explain_fringes(images, kPatterns, {}, {column, row});
      const std::size_t i = row * 200 + column;
      ASSERT_EQ(trace.status, decoded.status[i]);
      EXPECT_EQ(static_cast<float>(trace.phase_rad), decoded.phase_rad[i]);
      EXPECT_EQ(static_cast<float>(trace.modulation), decoded.modulation[i]);
      EXPECT_EQ(static_cast<float>(trace.mean_level), decoded.mean_level[i]);
      ASSERT_EQ(trace.tests.size(), 5U);
      const auto failed = std::find_if(trace.tests.begin(), trace.tests.end(),
                                       [](const FringeTest& test) { return !test.has_passed; });
      const bool is_valid = failed == trace.tests.end();
      EXPECT_EQ(is_valid ? FringeStatus::valid : failed->failure, trace.status);
      if (!is_valid) continue;
      EXPECT_EQ(static_cast<float>(trace.coordinate_px), decoded.coordinate_px[i]);
      EXPECT_EQ(trace.stripe, stripe_of(kPatterns, column));
      EXPECT_EQ(trace.period, std::floor((column + 0.5) / 18.0));
    }
  }
}

TEST(FringeTrace, HasALineForEachTest) {
  const std::vector<GreyImage> images = see_patterns();
  const std::string valid = format_fringe_trace(explain_fringes(images, kPatterns, {}, {50, 0}));
  EXPECT_THAT(valid, HasSubstr("pixel 50,0: valid\n"));
  EXPECT_THAT(valid, HasSubstr("stripe 5 of the code, period 2, coordinate 50."));
  EXPECT_THAT(valid, HasSubstr("  passed  outside: coordinate 50."));
  const std::string dark = format_fringe_trace(explain_fringes(images, kPatterns, {}, {50, 1}));
  EXPECT_THAT(dark, HasSubstr("pixel 50,1: low_modulation\nfringes: grey levels 7 7 7 7\n"));
  EXPECT_THAT(dark, HasSubstr("  failed  low_modulation: modulation 0.00 levels, needed: 4.00"));
}

TEST(FringeTrace, RefusesPixelsOutsideTheImages) {
  const std::vector<GreyImage> images = see_patterns();
  EXPECT_THAT(error_text([&] {
                explain_fringes(images, kPatterns, {}, {200, 0});
              }),
              HasSubstr("columns 0 to 199, rows 0 to 1"));
}

}  // namespace

}  // namespace glidar
