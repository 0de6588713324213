// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/sensor/sensor.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace glidar {
namespace {

/// Returns at these ranges on beams that are 60 degrees from the boresight, in two rows for two
/// returns.
struct Returns {
  Beams beams;
  Frame frame;

  explicit Returns(const std::vector<double>& ranges_m) {
    beams.rows = 2;
    beams.cols = static_cast<std::uint32_t>(ranges_m.size() / 2);
    beams.returns = 2;
    beams.boresight = Eigen::Vector3d::UnitX();
    beams.directions.assign(ranges_m.size(), {0.5, std::sqrt(0.75), 0.0});
    resize(frame, ranges_m.size());
    frame.range_m = ranges_m;
    frame.intensity.assign(ranges_m.size(), 1.0F);
    frame.sigma_m.assign(ranges_m.size(), 0.1F);
    frame.status.assign(ranges_m.size(), Status::hit);
  }

  std::vector<Status> statuses(const Limits& limits) {
    ThreadPool threads(2);
    remove_returns_outside(limits, beams, threads, frame);
    return frame.status;
  }
};

TEST(RemoveReturnsOutside, JudgesEveryReturnByItsMeasuredRange) {
  Returns at({0.49, 0.5, 0.75, 1.0, 1.01, 3.0});
  const Limits limits{.near_m = 0.5, .far_m = 1.0, .along = Limits::Along::range};
  EXPECT_EQ(at.statuses(limits),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::hit,
                                 Status::too_far, Status::too_far}));
  EXPECT_TRUE(std::isnan(at.frame.range_m[0]));
  EXPECT_EQ(at.frame.intensity[4], 0.0F);
  EXPECT_EQ(at.frame.sigma_m[4], 0.0F);
  EXPECT_EQ(at.frame.range_m[3], 1.0);
}

TEST(RemoveReturnsOutside, JudgesDepthsAlongTheBoresight) {
  Returns at({0.9, 1.1, 3.9, 4.1});
  EXPECT_EQ(at.statuses({.near_m = 0.5, .far_m = 2.0, .along = Limits::Along::depth}),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::too_far}));
}

TEST(RemoveReturnsOutside, JudgesRangesAsReportedFromTheAxis) {
  Returns at({0.45, 0.46, 0.95, 0.96});
  at.beams.range_offset_m = 0.045;
  EXPECT_EQ(at.statuses({.near_m = 0.5, .far_m = 1.0, .along = Limits::Along::range}),
            (std::vector<Status>{Status::too_near, Status::hit, Status::hit, Status::too_far}));
}

TEST(RemoveReturnsOutside, KeepsTheReasonOfBeamsWithoutAReturn) {
  Returns at({kNaN, 5.0});
  at.frame.status[0] = Status::dropped;
  EXPECT_EQ(at.statuses({.far_m = 1.0, .along = Limits::Along::range}),
            (std::vector<Status>{Status::dropped, Status::too_far}));
}

TEST(ToWholeUnits, NeverRoundsOutOfTheLimits) {
  const Limits limits{.near_m = 0.5015, .far_m = 29.99, .along = Limits::Along::range};
  for (const double unit_m : {0.001, 0.002, 0.004, 0.008, 0.01}) {
    for (double range_m = limits.near_m; range_m <= limits.far_m; range_m += 0.00037) {
      const double units = to_whole_units(limits, Limits::Along::range, range_m, unit_m);
      EXPECT_EQ(units, std::floor(units));
      EXPECT_GE(units * unit_m, limits.near_m - 1e-12) << range_m;
      EXPECT_LE(units * unit_m, limits.far_m + 1e-12) << range_m;
      EXPECT_LT(std::abs(units * unit_m - range_m), unit_m) << range_m;
    }
  }
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 29.99, 0.001), 29990.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 29.99, 0.004), 7497.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 0.5015, 0.004), 126.0);
}

TEST(ToWholeUnits, RoundsToTheNearestWhereLimitsDoNotApply) {
  const Limits limits{.near_m = 0.5, .far_m = 0.9996};
  EXPECT_EQ(to_whole_units(limits, Limits::Along::depth, 0.9996, 0.001), 999.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::range, 0.9996, 0.001), 1000.0);
  EXPECT_EQ(to_whole_units(limits, Limits::Along::depth, 3.0004, 0.001), 3000.0);
  EXPECT_EQ(to_whole_units({}, Limits::Along::depth, -0.0006, 0.001), -1.0);
  EXPECT_TRUE(std::isnan(to_whole_units(limits, Limits::Along::depth, kNaN, 0.001)));
}

}  // namespace
}  // namespace glidar
