// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/simulate/start_from_sensor.hpp>

#include <glidar/math/simd.hpp>

#include <array>
#include <cmath>

namespace glidar {
namespace {

/// Vectors component by component.
using VectorBlock = std::array<PoseBlock::Component, 3>;

void gather(std::span<const Eigen::Vector3d> vectors, VectorBlock& block) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    block[0][i] = vectors[i].x();
    block[1][i] = vectors[i].y();
    block[2][i] = vectors[i].z();
  }
}

void scatter(const VectorBlock& block, std::span<Eigen::Vector3d> vectors) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = {block[0][i], block[1][i], block[2][i]};
  }
}

// Products are added in the order of Eigen's products of 3x3 matrices, which add those of the third
// row from the last one. Blocks and single poses therefore give the same bits.

/// block = S0^-1 * block, with the rotation of S0^-1 and the position of S0.
GLIDAR_SIMD void multiply_from_left(const Eigen::Matrix3d& rotation,
                                    const Eigen::Vector3d& position_m, std::size_t count,
                                    PoseBlock& block) {
  const Eigen::Matrix3d& m = rotation;
  const auto multiply = [&](double& x, double& y, double& z) {
    const double a = (m(0, 0) * x + m(0, 1) * y) + m(0, 2) * z;
    const double b = (m(1, 0) * x + m(1, 1) * y) + m(1, 2) * z;
    const double c = m(2, 0) * x + (m(2, 1) * y + m(2, 2) * z);
    x = a;
    y = b;
    z = c;
  };
  for (std::size_t column = 0; column < 9; column += 3) {
    PoseBlock::Component& x = block.rotation[column];
    PoseBlock::Component& y = block.rotation[column + 1];
    PoseBlock::Component& z = block.rotation[column + 2];
    for (std::size_t i = 0; i < count; ++i) multiply(x[i], y[i], z[i]);
  }
  auto& [x, y, z] = block.position_m;
  const double x0 = position_m.x();
  const double y0 = position_m.y();
  const double z0 = position_m.z();
  for (std::size_t i = 0; i < count; ++i) {
    x[i] -= x0;
    y[i] -= y0;
    z[i] -= z0;
    multiply(x[i], y[i], z[i]);
  }
}

GLIDAR_SIMD void rotate(const PoseBlock& poses, std::size_t count, VectorBlock& vectors) {
  const auto& r = poses.rotation;
  auto& [x, y, z] = vectors;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = (r[0][i] * x[i] + r[3][i] * y[i]) + r[6][i] * z[i];
    const double b = (r[1][i] * x[i] + r[4][i] * y[i]) + r[7][i] * z[i];
    const double c = r[2][i] * x[i] + (r[5][i] * y[i] + r[8][i] * z[i]);
    const double squared = a * a + b * b + c * c;
    const double length = squared > 0.0 ? std::sqrt(squared) : 1.0;
    x[i] = a / length;
    y[i] = b / length;
    z[i] = c / length;
  }
}

/// As Eigen's product of a pose and a point: here all rows are added from their start.
GLIDAR_SIMD void transform(const PoseBlock& poses, const VectorBlock& points, std::size_t count,
                           VectorBlock& transformed) {
  const auto& [x, y, z] = points;
  for (std::size_t row = 0; row < 3; ++row) {
    const PoseBlock::Component& a = poses.rotation[row];
    const PoseBlock::Component& b = poses.rotation[row + 3];
    const PoseBlock::Component& c = poses.rotation[row + 6];
    const PoseBlock::Component& t = poses.position_m[row];
    PoseBlock::Component& out = transformed[row];
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = t[i] + ((a[i] * x[i] + b[i] * y[i]) + c[i] * z[i]);
    }
  }
}

}  // namespace

void find_start_from_sensor(const MovingSensor& sensor, const Beams& beams, BeamRange range,
                            PoseBlock& start_from_sensor) {
  const std::size_t count = range.end - range.begin;
  std::array<std::int64_t, PoseBlock::kSize> t_ns;
  for (std::size_t i = 0; i < count; ++i) {
    t_ns[i] = sensor.stamp_ns + (beams.times_ns.empty() ? 0 : beams.times_ns[range.begin + i]);
  }
  poses_at(sensor.world_from_sensor, {t_ns.data(), count}, start_from_sensor);
  multiply_from_left(sensor.at_start.linear().transpose(), sensor.at_start.translation(), count,
                     start_from_sensor);
}

void rotate_directions(const PoseBlock& poses, std::span<const Eigen::Vector3d> directions,
                       std::span<Eigen::Vector3d> rotated) {
  VectorBlock block;
  gather(directions, block);
  rotate(poses, directions.size(), block);
  scatter(block, rotated);
}

void transform_origins(const PoseBlock& poses, std::span<const Eigen::Vector3d> origins_m,
                       std::span<Eigen::Vector3d> transformed_m) {
  if (origins_m.empty()) return scatter(poses.position_m, transformed_m);
  VectorBlock block;
  VectorBlock transformed;
  gather(origins_m, block);
  transform(poses, block, origins_m.size(), transformed);
  scatter(transformed, transformed_m);
}

}  // namespace glidar
