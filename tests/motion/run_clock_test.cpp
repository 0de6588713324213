// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/run_clock.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace glidar {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kRecorded = 1'700'000'000'123'456'789;

/// Moves along x by 1 m/s for two seconds; x is 10 at the first pose.
Trajectory drive(std::int64_t first_ns) {
  return TimedPoses({{.t_ns = first_ns, .position_m = {10.0, 0.0, 0.0}},
                     {.t_ns = first_ns + 2 * kSecond, .position_m = {12.0, 0.0, 0.0}}});
}

double x_at(const Trajectory& trajectory, std::int64_t t_ns) {
  return pose_at(trajectory, t_ns).translation().x();
}

/// A run with a sensor and one object.
struct StartedRun {
  Trajectory sensor;
  std::vector<Trajectory> objects;
  std::int64_t start_ns = 0;

  StartedRun(const RunStart& start, Trajectory world_from_sensor, Trajectory world_from_object)
      : sensor(std::move(world_from_sensor)), objects{std::move(world_from_object)} {
    start_ns = set_run_clock(start, sensor, objects);
  }
  [[nodiscard]] double sensor_x(double since_s) const {
    return x_at(sensor, start_ns + std::llround(since_s * 1e9));
  }
  [[nodiscard]] double object_x(double since_s) const {
    return x_at(objects[0], start_ns + std::llround(since_s * 1e9));
  }
};

const Trajectory kAtRest = ConstantPose{};
const Trajectory kTwist = ConstantTwist{.linear_m_s = {1.0, 0.0, 0.0}};

std::string run_error(const RunStart& start, Trajectory sensor) {
  std::vector<Trajectory> none;
  try {
    set_run_clock(start, sensor, none);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(RunClock, ARunStartsAtTheFirstPoseOfTheSensorWithItsTime) {
  for (const std::int64_t first_ns : {kRecorded, 5 * kSecond, std::int64_t{0}, -3 * kSecond}) {
    const StartedRun run({}, drive(first_ns), kAtRest);
    EXPECT_EQ(run.start_ns, first_ns);
    EXPECT_EQ(run.sensor_x(0.0), 10.0);
    EXPECT_EQ(run.sensor_x(1.0), 11.0);
  }
}

TEST(RunClock, WithoutATrajectoryItStartsAtTheOrigin) {
  EXPECT_EQ(StartedRun({}, kAtRest, kAtRest).start_ns, 0);
  const StartedRun run({.origin_ns = kDefaultDate_ns}, kTwist, kTwist);
  EXPECT_EQ(run.start_ns, kDefaultDate_ns);
  EXPECT_EQ(run.sensor_x(1.5), 1.5);
  EXPECT_EQ(run.object_x(1.5), 1.5);
}

TEST(RunClock, TimesThatAreNoDatesCountFromTheOrigin) {
  const StartedRun run({.origin_ns = kDefaultDate_ns}, drive(5 * kSecond), drive(6 * kSecond));
  EXPECT_EQ(run.start_ns, kDefaultDate_ns + 5 * kSecond);
  EXPECT_EQ(run.sensor_x(0.5), 10.5);
  EXPECT_EQ(run.object_x(0.5), 10.0);
  EXPECT_EQ(run.object_x(1.5), 10.5);
  EXPECT_EQ(StartedRun({.origin_ns = kDefaultDate_ns}, drive(kRecorded), kAtRest).start_ns,
            kRecorded);
}

TEST(RunClock, AStartTimeIsLookedUpOnATrajectoryWithDates) {
  const StartedRun run({.time_ns = kRecorded + kSecond}, drive(kRecorded),
                       drive(kRecorded + kSecond));
  EXPECT_EQ(run.start_ns, kRecorded + kSecond);
  EXPECT_EQ(run.sensor_x(0.5), 11.5);
  EXPECT_EQ(run.object_x(0.5), 10.5);
}

TEST(RunClock, AStartTimeDatesTheFirstPoseOfATrajectoryWithoutDates) {
  const StartedRun run({.time_ns = kRecorded}, drive(5 * kSecond), kTwist);
  EXPECT_EQ(run.start_ns, kRecorded);
  EXPECT_EQ(run.sensor_x(0.5), 10.5);
  EXPECT_EQ(run.object_x(0.5), 5.5);  // its clock is that of the trajectory
}

TEST(RunClock, ASegmentStartsThereAtItsOwnTimeOrAtAnother) {
  const StartedRun own({.from_ns = kRecorded + kSecond}, drive(kRecorded), kTwist);
  EXPECT_EQ(own.start_ns, kRecorded + kSecond);
  EXPECT_EQ(own.sensor_x(0.25), 11.25);
  EXPECT_EQ(own.object_x(0.25), 0.25);  // without a date, it starts with the run
  const StartedRun other({.time_ns = kSecond, .from_ns = kRecorded + kSecond}, drive(kRecorded),
                         drive(kRecorded));
  EXPECT_EQ(other.start_ns, kSecond);
  EXPECT_EQ(other.sensor_x(0.25), 11.25);
  EXPECT_EQ(other.object_x(0.25), 11.25);
}

TEST(RunClock, NowMovesTrajectoriesWhateverTheirTimes) {
  const StartedRun run({.time_ns = kDefaultDate_ns, .moves_trajectory = true}, drive(kRecorded),
                       drive(kRecorded + kSecond));
  EXPECT_EQ(run.start_ns, kDefaultDate_ns);
  EXPECT_EQ(run.sensor_x(1.5), 11.5);
  EXPECT_EQ(run.object_x(1.5), 10.5);
}

TEST(RunClock, DatesOfObjectsAloneGiveTheStart) {
  const StartedRun run({.origin_ns = kDefaultDate_ns}, kTwist, drive(kRecorded));
  EXPECT_EQ(run.start_ns, kRecorded);
  EXPECT_EQ(run.sensor_x(0.5), 0.5);
  EXPECT_EQ(run.object_x(0.5), 10.5);
  const StartedRun later({.time_ns = kRecorded + kSecond}, kAtRest, drive(kRecorded));
  EXPECT_EQ(later.start_ns, kRecorded + kSecond);
  EXPECT_EQ(later.object_x(0.5), 11.5);
  const StartedRun now({.time_ns = kDefaultDate_ns, .moves_trajectory = true}, kAtRest,
                       drive(kRecorded));
  EXPECT_EQ(now.object_x(0.5), 10.5);
}

TEST(RunClock, PosesAreTheSameBitsAtAnyStart) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.3 * i * i;
    poses.push_back({.t_ns = i * 333'333'333LL,
                     .position_m = {0.1 * i, std::sqrt(i), 1.0},
                     .orientation = Eigen::Quaterniond(
                         Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0))});
  }
  const TorqueFreeRotation tumbling(
      {.moments_kg_m2 = {1.0, 2.0, 2.5}, .rate_rad_s = {0.1, 2.0, 0.3}});
  const Pose lever(Eigen::Translation3d(1.0, 2.0, 3.0));
  for (const Trajectory& trajectory :
       {Trajectory(TimedPoses(poses)), Trajectory(TimedPoses(poses, Interpolation::spline)),
        Trajectory(tumbling), Trajectory(Mounted{TimedPoses(poses), lever}),
        Trajectory(Mounted{tumbling, lever}), Trajectory(Spin{.rate_rad_s = {1.0, 2.0, 3.0}}),
        Trajectory(
            ConstantTwist{.angular_rad_s = {1.0, 2.0, 3.0}, .linear_m_s = {3.0, 2.0, 1.0}})}) {
    const Trajectory moved = retimed(trajectory, 7, kRecorded);
    for (std::int64_t t_ns = 0; t_ns < 2 * kSecond; t_ns += 123'456'789) {
      EXPECT_EQ(pose_at(trajectory, t_ns).matrix(), pose_at(moved, t_ns - 7 + kRecorded).matrix());
    }
  }
}

TEST(RunClock, ErrorsStateTheTimesOfTheTrajectory) {
  EXPECT_EQ(run_error({.time_ns = kRecorded + 3 * kSecond}, drive(kRecorded)),
            "start time: 1700000003.123456789 s, outside of the trajectory of the sensor; allowed: "
            "1700000000.123456789 to 1700000002.123456789 s; state also where on the trajectory "
            "the run starts then (--from 1700000000.123456789 for example)");
  EXPECT_THAT(run_error({.time_ns = 0}, drive(kRecorded)),
              ::testing::StartsWith("start time: 0 s"));
  EXPECT_EQ(
      run_error({.from_ns = 8 * kSecond}, drive(5 * kSecond)),
      "start on the trajectory: 8 s, outside of the trajectory of the sensor; allowed: 5 to 7 "
      "s; times are those of the trajectory");
  EXPECT_EQ(
      run_error({.from_ns = 0}, kTwist),
      "start on the trajectory: the sensor has none; allowed: a file of timed poses; leave it "
      "out, or give a trajectory");
  EXPECT_THAT(run_error({.time_ns = std::numeric_limits<std::int64_t>::max()}, drive(kSecond)),
              ::testing::HasSubstr("times that leave the range of nanoseconds"));
}

}  // namespace
}  // namespace glidar
