// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/spoiled_subject.hpp"

#include <glidar/verify/cases.hpp>
#include <glidar/verify/comparison.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace glidar::testing {
namespace {

AccuracyCase row_of(const SpecialCase& c, const VerifySubject& subject) {
  AccuracyCase row{.name = c.name, .shape = c.shape, .distance_m = c.distance_m};
  row.result = c.run(subject);
  row.known = known_failure(row);
  return row;
}

TEST(VerifyCases, RaysAreWithinBoundsAtBothEndsOfTheDistances) {
  const std::vector<Shape> shapes = make_shapes();
  for (const double distance_m : {0.1, 10000.0}) {
    for (const VerifyCase& c : make_cases(0, distance_m)) {
      const VerifyResult result = run_case(c, shapes[c.shape], subject("rays"));
      EXPECT_TRUE(result.passed()) << result.range_error_ulp << " ulp, offset " << c.offset_m;
    }
  }
}

TEST_F(SpecialCases, EveryRayRendererPassesOrHasAKnownFailure) {
  for (const SpecialCase& c : all()) {
    const AccuracyCase row = row_of(c, subject("rays"));
    EXPECT_TRUE(all_passed({row})) << c.name << ", " << c.shape << ", " << c.distance_m;
    EXPECT_NE(row.verdict(), Verdict::fixed) << "remove it from the list: " << c.name;
    EXPECT_GT(row.result.compared_hits, 100U) << c.name << ", " << c.shape;
    EXPECT_GT(row.result.compared_misses, 20U) << c.name << ", " << c.shape;
  }
}

TEST_F(SpecialCases, TheRasterPassesCasesWithItsBeamsOrHasAKnownFailure) {
  std::size_t applied = 0;
  for (const SpecialCase& c : all()) {
    if (beams_of_renderer("raster") < c.needs) continue;
    ++applied;
    const AccuracyCase row = row_of(c, subject("raster"));
    EXPECT_TRUE(all_passed({row})) << c.name << ", " << c.shape;
    EXPECT_NE(row.verdict(), Verdict::fixed) << "remove it from the list: " << c.name;
  }
  EXPECT_EQ(applied, 13U);
}

TEST_F(SpecialCases, ShiftedRangesAreDetectedInEach) {
  for (const char* name : {"several instances", "scanner among bodies", "moving sensor and target",
                           "sensor in traffic", "at vertices and edges"}) {
    const VerifyResult result = named(name).run(subject("rays", shift_ranges));
    EXPECT_GT(result.range_error_ulp, kRangeBound_ulp) << name;
    EXPECT_FALSE(result.passed()) << name;
  }
}

TEST_F(SpecialCases, SwappedIdsAreDetectedInEach) {
  for (const char* name : {"several instances", "moving sensor and target", "sensor in traffic",
                           "sensor on a vertex"}) {
    EXPECT_GT(named(name).run(subject("rays", swap_triangles)).wrong_ids, 100U) << name;
  }
  const VerifyResult swapped = named("several instances").run(subject("raster", swap_instances));
  EXPECT_GT(swapped.wrong_ids, 100U);
}

TEST_F(SpecialCases, ALostHitIsDetectedInEach) {
  for (const char* name : {"several instances", "scanner among bodies", "moving sensor and target",
                           "sensor in traffic", "at vertices and edges"}) {
    EXPECT_GT(named(name).run(subject("rays", lose_one_hit)).wrong_misses, 0U) << name;
  }
}

TEST_F(SpecialCases, ShiftedRangesAndSwappedIdsAreDetectedForOneStaticShape) {
  const VerifyCase c = make_cases(0, 10.0)[0];
  EXPECT_TRUE(run_case(c, shapes()[0], subject("raster")).passed());
  EXPECT_FALSE(run_case(c, shapes()[0], subject("raster", shift_ranges)).passed());
  EXPECT_FALSE(run_case(c, shapes()[0], subject("raster", swap_triangles)).passed());
  EXPECT_FALSE(run_case(c, shapes()[0], subject("raster", lose_one_hit)).passed());
}

TEST(VerifyResult, AnyErrorOverItsBoundFails) {
  const VerifyResult good{
      .rays = 1000, .compared_hits = 500, .compared_misses = 490, .near_edges = 10};
  EXPECT_TRUE(good.passed());
  const auto spoiled = [&](auto member, auto value) {
    VerifyResult result = good;
    result.*member = value;
    return result.passed();
  };
  EXPECT_FALSE(spoiled(&VerifyResult::wrong_hits, std::size_t{1}));
  EXPECT_FALSE(spoiled(&VerifyResult::wrong_misses, std::size_t{1}));
  EXPECT_FALSE(spoiled(&VerifyResult::wrong_ids, std::size_t{1}));
  EXPECT_FALSE(spoiled(&VerifyResult::range_error_ulp, 0.00101));
  EXPECT_FALSE(spoiled(&VerifyResult::normal_error_rad, 1.1e-6));
  EXPECT_FALSE(spoiled(&VerifyResult::compared_hits, std::size_t{0}));
  EXPECT_FALSE(spoiled(&VerifyResult::near_edges, std::size_t{100}));
  EXPECT_FALSE(spoiled(&VerifyResult::compared_misses, std::size_t{0}));
  EXPECT_FALSE(spoiled(&VerifyResult::other_error, 1.01));
}

TEST(VerifyResult, ErrorsOfOtherColumnsAreSharesOfTheirBounds) {
  VerifyResult result;
  result.check(-2e-6, 4e-6);
  EXPECT_DOUBLE_EQ(result.other_error, 0.5);
  result.check(1e-6, 1.0);
  EXPECT_DOUBLE_EQ(result.other_error, 0.5);
  result.check(kNaN, 1.0);
  EXPECT_EQ(result.other_error, kInfinity);
  result.check(0.1, 1.0);
  EXPECT_EQ(result.other_error, kInfinity);
}

TEST_F(SpecialCases, AKnownFailureBeyondItsBoundFails) {
  const auto verdict = [&](const char* name, const std::string& kind,
                           const std::function<void(Hits&)>& spoil) {
    return row_of(named(name), subject(kind, spoil)).verdict();
  };
  EXPECT_EQ(verdict("above a planet", "raster", [](Hits&) {}), Verdict::known_failure);
  EXPECT_EQ(verdict("above a planet", "raster", lose_every_hit), Verdict::failed);
  EXPECT_EQ(verdict("above a planet", "raster", swap_triangles), Verdict::failed);
  EXPECT_EQ(verdict("above a planet", "raster",
                    [](Hits& hits) {
                      for (int i = 0; i < 100; ++i) shift_ranges(hits);
                    }),
            Verdict::failed);
  EXPECT_EQ(verdict("several instances", "rays", swap_instances), Verdict::failed);
  EXPECT_EQ(verdict("beside the outline", "rays",
                    [](Hits& hits) {
                      for (double& range_m : hits.range_m) range_m *= 1.001;
                    }),
            Verdict::failed);
}

TEST(AccuracyCase, AKnownFailureIsAnErrorOnlyBeyondItsBound) {
  const VerifyResult good{
      .rays = 1000, .compared_hits = 500, .compared_misses = 490, .near_edges = 10};
  VerifyResult bad = good;
  bad.wrong_hits = 2;
  bad.wrong_ids = 1;
  bad.range_error_ulp = 3.0;
  bad.normal_error_rad = 1.5;
  const auto row = [](const VerifyResult& result, const char* known, bool applies) {
    return AccuracyCase{
        .name = "a",
        .shape = "b",
        .result = result,
        .known = {.reason = known, .max_wrong_share = 0.003, .max_range_error_ulp = 3},
        .applies = applies};
  };
  EXPECT_EQ(row(good, "", true).verdict(), Verdict::passed);
  EXPECT_EQ(row(bad, "", true).verdict(), Verdict::failed);
  EXPECT_EQ(row(bad, "why", true).verdict(), Verdict::known_failure);
  EXPECT_EQ(row(good, "why", true).verdict(), Verdict::fixed);
  EXPECT_EQ(row({}, "", false).verdict(), Verdict::not_applicable);
  EXPECT_EQ(row({}, "why", true).verdict(), Verdict::failed);
  VerifyResult worse = bad;
  worse.wrong_misses = 1;
  EXPECT_EQ(row(worse, "why", true).verdict(), Verdict::failed);
  worse = bad;
  worse.range_error_ulp = 3.1;
  EXPECT_EQ(row(worse, "why", true).verdict(), Verdict::failed);
  worse = bad;
  worse.wrong_ids = 0;  // then the normals are those of correct triangles
  EXPECT_EQ(row(worse, "why", true).verdict(), Verdict::failed);
  EXPECT_TRUE(all_passed({row(good, "", true), row(bad, "why", true), row({}, "", false)}));
  EXPECT_TRUE(all_passed({row(good, "why", true)}));
  EXPECT_FALSE(all_passed({row(good, "", true), row(bad, "", true)}));
}

}  // namespace
}  // namespace glidar::testing
