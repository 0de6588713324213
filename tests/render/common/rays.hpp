// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/common/hit_rule.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace glidar::testing {

/// Random numbers with the same values on every machine.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(engine_() % count); }
  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  /// A number of any magnitude from 2^low to 2^high, of either sign.
  double of_any_size(int low, int high) {
    const double size = std::ldexp(
        in(1.0, 2.0), low + static_cast<int>(below(static_cast<std::size_t>(high - low))));
    return (bits() & 1U) != 0 ? size : -size;
  }
  Eigen::Vector3d in_cube(double half) {
    return {in(-half, half), in(-half, half), in(-half, half)};
  }
  Eigen::Vector3d direction() {
    const double z = in(-1.0, 1.0);
    const double angle = in(0.0, 2.0 * std::numbers::pi);
    const double radius = std::sqrt(1.0 - z * z);
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), z).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

/// A ray in the frame of a mesh.
struct TestRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

inline TestRay aimed(const Eigen::Vector3d& origin, const Eigen::Vector3d& target) {
  return {origin, (target - origin).normalized()};
}

/// A mesh of vertices and triangles only.
struct TestMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  [[nodiscard]] HitTriangle triangle(std::size_t index) const {
    const auto corner = [&](std::size_t k) {
      const Eigen::Vector3f& v = vertices[triangles[index][k]];
      return std::array<float, 3>{v.x(), v.y(), v.z()};
    };
    return {corner(0), corner(1), corner(2)};
  }
  /// A random corner, or a random point of a random edge.
  [[nodiscard]] Eigen::Vector3d corner_or_edge(Numbers& numbers) const {
    const auto& triangle = triangles[numbers.below(triangles.size())];
    const std::uint32_t k = numbers.below(3);
    const Eigen::Vector3d p = vertices[triangle[k]].cast<double>();
    if ((numbers.bits() & 1U) != 0) return p;
    const Eigen::Vector3d q = vertices[triangle[(k + 1) % 3]].cast<double>();
    return p + numbers.in(0.0, 1.0) * (q - p);
  }
};

/// A closed sphere around `centre` of 20 * 4^levels triangles: an icosahedron, subdivided.
TestMesh make_sphere(unsigned levels, double radius, const Eigen::Vector3d& centre);

/// A closed fan of `count` triangles around vertex 0; the others are on a wavy ring around it.
TestMesh make_fan(std::uint32_t count, const Eigen::Vector3d& centre, double size,
                  Numbers& numbers);

/// The first hit of a ray by the rule, from a test of every triangle; primitive UINT32_MAX: none.
HitCandidate nearest_of_all(const TestMesh& mesh, const TestRay& ray);

}  // namespace glidar::testing
