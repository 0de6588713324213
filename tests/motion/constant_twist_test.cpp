// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/motion/constant_twist.hpp>

#include <glidar/motion/spin.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace glidar {
namespace {

constexpr double kExact = 1e-13;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

Pose somewhere() {
  return make_pose({1.0, -2.0, 3.0}, Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3));
}

/// The exponential as its power series, after halving the twist often.
Eigen::Matrix4d series(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation) {
  constexpr int kHalvings = 12;
  Eigen::Matrix4d twist = Eigen::Matrix4d::Zero();
  twist.topLeftCorner<3, 3>() << 0.0, -rotation.z(), rotation.y(), rotation.z(), 0.0, -rotation.x(),
      -rotation.y(), rotation.x(), 0.0;
  twist.topRightCorner<3, 1>() = translation;
  twist /= std::ldexp(1.0, kHalvings);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  for (int k = 1; k < 12; ++k) {
    term = (term * twist / k).eval();
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = (sum * sum).eval();
  return sum;
}

TEST(Se3Exp, IsItsPowerSeries) {
  const Eigen::Vector3d translation(0.3, -1.2, 2.0);
  for (const double angle : {0.0, 1e-9, 1e-4, 0.0999, 0.1001, 1.0, 3.0, 6.0}) {
    const Eigen::Vector3d rotation = angle * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
    const Eigen::Matrix4d found = se3_exp(rotation, translation).matrix();
    // squaring twelve times multiplies roundings by 4096
    EXPECT_LT((found - series(rotation, translation)).norm(), 4e-12) << angle;
  }
}

TEST(ConstantTwist, CircleClosesAfterAFullTurn) {
  const ConstantTwist circle{.pose = somewhere(),
                             .angular_rad_s = {0.0, 0.0, 2.0 * std::numbers::pi},
                             .linear_m_s = {3.0, 0.0, 0.0}};
  EXPECT_LT((pose_at(circle, 5 * kSecond_ns).matrix() - somewhere().matrix()).norm(), kExact * 10);
  // half a turn later it is across the circle, whose radius is v / w, to the left of the velocity
  const Eigen::Vector3d across(0.0, 2.0 * 3.0 / (2.0 * std::numbers::pi), 0.0);
  const Pose half = pose_at(circle, kSecond_ns / 2);
  EXPECT_LT((half.translation() - somewhere() * across).norm(), kExact);
}

TEST(ConstantTwist, BodyTwistIsTheVelocityInTheBody) {
  const ConstantTwist twist{
      .pose = somewhere(), .angular_rad_s = {0.1, 0.2, -0.3}, .linear_m_s = {1.0, 2.0, 3.0}};
  const std::int64_t h_ns = 1000;
  const double h = 1e-6;
  const Pose now = pose_at(twist, kSecond_ns);
  const Eigen::Vector3d moved = pose_at(twist, kSecond_ns + h_ns).translation() -
                                pose_at(twist, kSecond_ns - h_ns).translation();
  // central difference: rounding 1e-16 * 5 m / 1e-6
  EXPECT_LT((now.linear().transpose() * moved / (2.0 * h) - twist.linear_m_s).norm(), 1e-8);
}

TEST(ConstantTwist, WorldTwistRotatesAboutTheWorldsOrigin) {
  const ConstantTwist twist{.pose = somewhere(),
                            .angular_rad_s = {0.0, 0.0, std::numbers::pi / 2.0},
                            .frame = TwistFrame::world};
  const Pose turned = pose_at(twist, kSecond_ns);
  EXPECT_LT((turned.translation() - Eigen::Vector3d(2.0, 1.0, 3.0)).norm(), kExact);
}

TEST(ConstantTwist, BodyAndWorldTwistsAreRelatedByTheAdjoint) {
  const Eigen::Vector3d w(0.4, -0.3, 0.9);
  const Eigen::Vector3d v(1.0, 0.5, -2.0);
  const Pose pose = somewhere();
  const Eigen::Vector3d w_world = pose.linear() * w;
  const ConstantTwist body{.pose = pose, .angular_rad_s = w, .linear_m_s = v};
  const ConstantTwist world{.pose = pose,
                            .angular_rad_s = w_world,
                            .linear_m_s = pose.linear() * v + pose.translation().cross(w_world),
                            .frame = TwistFrame::world};
  for (int t = -3; t < 4; ++t) {
    EXPECT_LT(
        (pose_at(body, t * kSecond_ns).matrix() - pose_at(world, t * kSecond_ns).matrix()).norm(),
        1e-12);
  }
}

TEST(ConstantTwist, FarTimesKeepTheirNanoseconds) {
  const std::int64_t epoch_ns = 1'700'000'000'123'456'789;
  const ConstantTwist twist{.linear_m_s = {1.0, 0.0, 0.0}, .t0_ns = epoch_ns};
  EXPECT_DOUBLE_EQ(pose_at(twist, epoch_ns + 1).translation().x(), 1e-9);
  EXPECT_DOUBLE_EQ(pose_at(twist, epoch_ns - 1).translation().x(), -1e-9);
  // no overflow between the extreme times
  const ConstantTwist early{.linear_m_s = {1.0, 0.0, 0.0},
                            .t0_ns = std::numeric_limits<std::int64_t>::min()};
  EXPECT_DOUBLE_EQ(pose_at(early, std::numeric_limits<std::int64_t>::max()).translation().x(),
                   18446744073.709551615);
}

TEST(Spin, RotatesInPlaceAboutItsOwnAxes) {
  const Spin spin{.pose = somewhere(), .rate_rad_s = {0.0, std::numbers::pi / 4.0, 0.0}};
  const Pose pose = pose_at(spin, 2 * kSecond_ns);
  EXPECT_EQ(pose.translation(), somewhere().translation());
  const Eigen::Vector3d x_now =
      somewhere().linear().transpose() * pose.linear() * Eigen::Vector3d::UnitX();
  EXPECT_LT((x_now + Eigen::Vector3d::UnitZ()).norm(), kExact);
}

}  // namespace
}  // namespace glidar
