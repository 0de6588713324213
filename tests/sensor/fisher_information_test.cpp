// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/fisher_information.hpp>

#include <glidar/core/error.hpp>
#include <glidar/math/random.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kSigma_m = 0.02;

/// normal . p = distance_m, in the sensor's frame.
struct Plane {
  Vector3d normal;
  double distance_m = 0.0;
};

/// Directions spread evenly over the sphere (a Fibonacci lattice).
Beams all_around(std::size_t count) {
  Beams beams;
  beams.rows = 1;
  beams.cols = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    beams.directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return beams;
}

Frame empty_frame(const Beams& beams) {
  Frame frame;
  frame.ground_truth.range_m.assign(beams.size(), std::nan(""));
  frame.ground_truth.instance.assign(beams.size(), kInvalidId);
  frame.ground_truth.normal.assign(beams.size(), Eigen::Vector3f::Constant(std::nanf("")));
  frame.status.assign(beams.size(), Status::miss);
  frame.sigma_m.assign(beams.size(), static_cast<float>(kSigma_m));
  return frame;
}

void hit(Frame& frame, std::size_t beam, double range_m, const Vector3d& normal) {
  frame.ground_truth.range_m[beam] = range_m;
  frame.ground_truth.normal[beam] = normal.cast<float>();
  frame.ground_truth.instance[beam] = 0;
  frame.status[beam] = Status::hit;
}

/// The nearest plane on a beam from `from`: its number and the range; no plane: infinity.
std::pair<std::size_t, double> nearest(const std::vector<Plane>& planes, const Vector3d& from,
                                       const Vector3d& direction) {
  std::pair<std::size_t, double> found{0, std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const double along = planes[k].normal.dot(direction);
    const double range_m = (planes[k].distance_m - planes[k].normal.dot(from)) / along;
    if (range_m > 0.0 && range_m < found.second) found = {k, range_m};
  }
  return found;
}

Frame scan(const Beams& beams, const std::vector<Plane>& planes) {
  Frame frame = empty_frame(beams);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto [plane, range_m] = nearest(planes, Vector3d::Zero(), beams.directions[i]);
    if (range_m < 50.0) hit(frame, i, range_m, planes[plane].normal);
  }
  return frame;
}

std::vector<std::string> degenerate_words(const FisherInformation& information) {
  std::vector<std::string> words;
  for (const EigenDirection& direction : information.directions) {
    if (direction.degenerate) words.push_back(direction.words);
  }
  std::sort(words.begin(), words.end());
  return words;
}

/// Four walls along x.
const std::vector<Plane>& corridor() {
  static const std::vector<Plane> kWalls = {{-Vector3d::UnitY(), -1.5},
                                            {Vector3d::UnitY(), -1.0},
                                            {-Vector3d::UnitZ(), -1.2},
                                            {Vector3d::UnitZ(), -0.8}};
  return kWalls;
}

/// The corridor with an end, and a wall across.
std::vector<Plane> room() {
  std::vector<Plane> planes = corridor();
  planes.push_back({-Vector3d::UnitX(), -3.0});
  planes.push_back({Vector3d(1.0, 0.3, 0.2).normalized(), -2.0});
  return planes;
}

TEST(FisherInformation, PlaneHasThreeDegenerateDirections) {
  const FisherInformation found =
      pose_information(scan(all_around(4000), {{-Vector3d::UnitZ(), -2.0}}), all_around(4000));
  const auto words = degenerate_words(found);
  ASSERT_EQ(words.size(), 3U);
  EXPECT_THAT(words[0], HasSubstr("rotation about z"));
  EXPECT_EQ(words[1], "translation along x");
  EXPECT_EQ(words[2], "translation along y");
  EXPECT_TRUE(std::isinf(found.bound[2]) && std::isinf(found.bound[3]) &&
              std::isinf(found.bound[4]));
  EXPECT_TRUE(std::isfinite(found.bound[0]) && std::isfinite(found.bound[1]) &&
              std::isfinite(found.bound[5]));
  EXPECT_TRUE(std::isinf(found.condition));
}

TEST(FisherInformation, CorridorIsDegenerateAlongItsAxis) {
  const Beams beams = all_around(4000);
  const FisherInformation found = pose_information(scan(beams, corridor()), beams);
  EXPECT_EQ(degenerate_words(found), std::vector<std::string>{"translation along x"});
  for (int axis = 0; axis < 6; ++axis) EXPECT_EQ(std::isinf(found.bound[axis]), axis == 3) << axis;
}

TEST(FisherInformation, SphereIsDegenerateForRotationsAboutItsCentre) {
  const Vector3d centre(1.0, 2.0, 5.0);
  const Beams beams = all_around(20000);
  Frame frame = empty_frame(beams);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double middle = beams.directions[i].dot(centre);
    const double root2 = 1.0 - (centre.squaredNorm() - middle * middle);
    if (root2 <= 0.0 || middle < 0.0) continue;
    const double range_m = middle - std::sqrt(root2);
    hit(frame, i, range_m, range_m * beams.directions[i] - centre);
  }
  const FisherInformation found = pose_information(frame, beams);
  ASSERT_EQ(degenerate_words(found).size(), 3U);
  for (const EigenDirection& direction : found.directions) {
    if (!direction.degenerate) continue;
    // a turn about the centre leaves the centre where it is
    const Vector3d moved =
        direction.displacement.head<3>().cross(centre) + direction.displacement.tail<3>();
    EXPECT_LT(moved.norm(), 1e-5);  // normals are single precision
    EXPECT_GT(direction.displacement.head<3>().norm(), 0.1);
    EXPECT_THAT(direction.words, HasSubstr("rotation about"));
  }
  // counted at the centre, the three rotations are the axes' own
  Pose at_centre = Pose::Identity();
  at_centre.translation() = centre;
  const FisherInformation there =
      pose_information(frame, beams, {.sensor_from_reference = at_centre});
  EXPECT_EQ(degenerate_words(there),
            (std::vector<std::string>{"rotation about x", "rotation about y", "rotation about z"}));
}

TEST(FisherInformation, OneRangeMatchesTheRowComputedByHand) {
  // d = z, p = (0, 0, 2), n = (0, -0.6, -0.8): n d = -0.8, p x n = (1.2, 0, 0)
  Beams beams;
  beams.directions = {Vector3d::UnitZ()};
  Frame frame = empty_frame(beams);
  hit(frame, 0, 2.0, {0.0, -0.6, -0.8});
  const FisherInformation found = pose_information(frame, beams);
  Vector6 row;
  row << 1.2, 0.0, 0.0, 0.0, -0.6, -0.8;
  const Matrix6 expected = row * row.transpose() / std::pow(kSigma_m * 0.8, 2);
  EXPECT_LT((found.matrix - expected).norm(), 1e-6 * expected.norm());  // single precision
  EXPECT_EQ(found.returns, 1U);
  EXPECT_EQ(degenerate_words(found).size(), 5U);
}

TEST(FisherInformation, FacingWallGivesTheBoundsOfALineFit) {
  // a wall at z = D seen by a beam fan: the depth's bound is sigma / sqrt(N) for parallel beams
  constexpr int kSide = 11;
  Beams beams;
  Frame frame;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      beams.directions.push_back(Vector3d::UnitZ());
      beams.origins_m.emplace_back(0.1 * (u - 5), 0.1 * (v - 5), 0.0);
    }
  }
  frame = empty_frame(beams);
  for (std::size_t i = 0; i < beams.size(); ++i) hit(frame, i, 3.0, -Vector3d::UnitZ());
  const FisherInformation found = pose_information(frame, beams);
  double squares = 0.0;
  for (int u = -5; u <= 5; ++u) squares += kSide * 0.01 * u * u;
  EXPECT_NEAR(found.bound[5], kSigma_m / kSide, 1e-8);
  EXPECT_NEAR(found.bound[0], kSigma_m / std::sqrt(squares), 1e-8);
  EXPECT_NEAR(found.bound[1], kSigma_m / std::sqrt(squares), 1e-8);
}

TEST(FisherInformation, AnotherReferenceIsTheSameInformation) {
  const Beams beams = all_around(3000);
  const Frame frame = scan(beams, room());
  Pose reference = make_pose({1.0, -2.0, 0.5}, Eigen::Quaterniond(0.8, 0.1, -0.5, 0.2));
  const FisherInformation here = pose_information(frame, beams);
  const FisherInformation there =
      pose_information(frame, beams, {.sensor_from_reference = reference});
  // sensor displacement = adjoint of the reference's (Lynch & Park, definition 3.20)
  Matrix6 adjoint = Matrix6::Zero();
  adjoint.topLeftCorner<3, 3>() = reference.linear();
  adjoint.bottomRightCorner<3, 3>() = reference.linear();
  for (int axis = 0; axis < 3; ++axis) {
    adjoint.block<3, 1>(3, axis) =
        reference.translation().cross(Vector3d(reference.linear().col(axis)));
  }
  const Matrix6 expected = adjoint.transpose() * here.matrix * adjoint;
  EXPECT_LT((there.matrix - expected).norm(), 1e-9 * expected.norm());
  const Matrix6 covariance = adjoint * there.covariance * adjoint.transpose();
  EXPECT_LT((covariance - here.covariance).norm(), 1e-9 * here.covariance.norm());
}

TEST(FisherInformation, BoundIsTheInverseOfTheMatrix) {
  const Beams beams = all_around(3000);
  const FisherInformation found = pose_information(scan(beams, room()), beams);
  EXPECT_TRUE(degenerate_words(found).empty());
  EXPECT_LT((found.matrix * found.covariance - Matrix6::Identity()).norm(), 1e-9);
  EXPECT_LT(found.condition, 1e3);
}

/// What the ranges of all beams would be from a displaced pose, each still on its own plane.
Eigen::VectorXd ranges(const Beams& beams, const std::vector<Plane>& planes,
                       const std::vector<std::size_t>& plane_of, const Vector6& displacement) {
  const Pose moved = se3_exp(displacement.head<3>(), displacement.tail<3>());
  Eigen::VectorXd out(static_cast<Eigen::Index>(beams.size()));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Plane& plane = planes[plane_of[i]];
    const Vector3d direction = moved.linear() * beams.directions[i];
    out[static_cast<Eigen::Index>(i)] =
        (plane.distance_m - plane.normal.dot(moved.translation())) / plane.normal.dot(direction);
  }
  return out;
}

/// The noise of a trial: Box and Muller's transform of Philox's words.
Eigen::VectorXd noise(std::size_t size, std::uint32_t trial) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i) {
    const RandomWords words =
        random_words({.seed = 20, .frame = trial, .beam = static_cast<std::uint32_t>(i)});
    const double radius = std::sqrt(-2.0 * std::log(uniform(words[0])));
    out[static_cast<Eigen::Index>(i)] =
        kSigma_m * radius * std::cos(2.0 * std::numbers::pi * uniform(words[1]));
  }
  return out;
}

TEST(FisherInformation, LeastSquaresOfNoisyRangesScatterAsTheBound) {
  const Beams beams = all_around(300);
  const std::vector<Plane> planes = room();
  std::vector<std::size_t> plane_of;
  for (const Vector3d& d : beams.directions) {
    plane_of.push_back(nearest(planes, Vector3d::Zero(), d).first);
  }
  // slopes of the measurement by differences: nothing of pose_information's formulas
  Eigen::MatrixXd slopes(300, 6);
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6 step = kStep * Vector6::Unit(axis);
    slopes.col(axis) =
        (ranges(beams, planes, plane_of, step) - ranges(beams, planes, plane_of, -step)) /
        (2.0 * kStep);
  }
  const Eigen::MatrixXd solve = (slopes.transpose() * slopes).inverse() * slopes.transpose();
  const Eigen::VectorXd exact = ranges(beams, planes, plane_of, Vector6::Zero());
  constexpr int kTrials = 2000;
  Matrix6 sample = Matrix6::Zero();
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const Eigen::VectorXd measured = exact + noise(beams.size(), trial);
    Vector6 estimate = Vector6::Zero();
    for (int i = 0; i < 4; ++i) {
      estimate += solve * (measured - ranges(beams, planes, plane_of, estimate));
    }
    sample += estimate * estimate.transpose() / kTrials;
  }
  const FisherInformation found =
      pose_information(scan(beams, planes), beams, {.least_cosine = 1e-4});
  ASSERT_EQ(found.returns, 300U);
  // a variance of 2000 trials is within sqrt(2 / 2000) = 3.2 %; four of those: 1 of 16000 fails
  for (int axis = 0; axis < 6; ++axis) {
    EXPECT_NEAR(sample(axis, axis) / found.covariance(axis, axis), 1.0, 0.13) << axis;
  }
  // all directions together: the mean of chi-square with 6 degrees, +- sqrt(12 / 2000), four times
  EXPECT_NEAR((found.matrix * sample).trace(), 6.0, 4.0 * std::sqrt(12.0 / kTrials));
}

TEST(FisherInformation, SigmaIsTheFramesOrTheOptions) {
  const Beams beams = all_around(500);
  Frame frame = scan(beams, room());
  const FisherInformation own = pose_information(frame, beams, {.sigma_m = 99.0});
  EXPECT_FALSE(own.assumed_sigma_m);
  frame.sigma_m.clear();
  const FisherInformation assumed = pose_information(frame, beams, {.sigma_m = 2.0 * kSigma_m});
  EXPECT_EQ(assumed.assumed_sigma_m, 2.0 * kSigma_m);
  EXPECT_NEAR(assumed.bound[4] / own.bound[4], 2.0, 1e-6);
  frame.sigma_m.assign(beams.size(), 0.0F);
  EXPECT_THROW(pose_information(frame, beams), Error);
}

TEST(FisherInformation, OnlyReturnsOfTheInstanceCount) {
  const Beams beams = all_around(500);
  Frame frame = scan(beams, room());
  std::size_t marked = 0;
  for (std::size_t i = 0; i < beams.size(); i += 7, ++marked) frame.ground_truth.instance[i] = 3;
  EXPECT_EQ(pose_information(frame, beams, {.instance = 3}).returns, marked);
  EXPECT_EQ(pose_information(frame, beams, {.instance = 4}).returns, 0U);
}

TEST(FisherInformation, WithoutReturnsNothingIsKnown) {
  const Beams beams = all_around(10);
  const FisherInformation found = pose_information(empty_frame(beams), beams);
  EXPECT_EQ(found.returns, 0U);
  EXPECT_EQ(degenerate_words(found).size(), 6U);
  for (int axis = 0; axis < 6; ++axis) EXPECT_TRUE(std::isinf(found.bound[axis]));
}

TEST(FisherInformation, GrazingReturnsAreIgnoredAndCounted) {
  Beams beams = all_around(2);
  Frame frame = empty_frame(beams);
  hit(frame, 0, 1.0, beams.directions[0].unitOrthogonal());
  hit(frame, 1, 1.0, -beams.directions[1]);
  const FisherInformation found = pose_information(frame, beams);
  EXPECT_EQ(found.left_out, 1U);
  EXPECT_EQ(found.returns, 1U);
}

TEST(FisherInformation, FrameWithoutNormalsIsAnError) {
  const Beams beams = all_around(10);
  Frame frame = empty_frame(beams);
  frame.ground_truth.normal.clear();
  EXPECT_THROW(pose_information(frame, beams), Error);
}

TEST(DescribeDisplacement, DescribesTheScrewMotion) {
  const auto words = [](std::initializer_list<double> six) {
    Vector6 v;
    std::copy(six.begin(), six.end(), v.data());
    return describe_displacement(v, 1.0);
  };
  EXPECT_EQ(words({0, 0, 0, 0, -2, 0}), "translation along y");
  EXPECT_EQ(words({0, 0, 0, 1, 1, 0}), "translation along (0.7071, 0.7071, 0)");
  EXPECT_EQ(words({0, 0, 3, 0, 0, 0}), "rotation about z");
  // about x through (0, 0, 5): the origin moves by theta x (0 - point) = (0, 5, 0)
  EXPECT_EQ(words({1, 0, 0, 0, 5, 0}), "rotation about x through (0, 0, 5) m");
  EXPECT_EQ(words({0, 0, 2, 0, 0, 1}), "rotation about z, with 0.5 m along it per rad");
}

}  // namespace
}  // namespace glidar
