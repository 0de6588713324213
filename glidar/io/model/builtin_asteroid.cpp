// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/builtin_asteroid.hpp>
#include <glidar/math/random.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace glidar {
namespace {

constexpr int kIcosphereLevels = 6;  // 81,920 triangles
constexpr double kLength_m = 2.0;
// Proportions of Itokawa-like bodies: clearly longer than wide.
constexpr std::array<double, 3> kHalfAxes = {1.0, 0.70, 0.60};

/// Purposes of random numbers; the second word of the Philox key.
enum class Stream : std::uint32_t { relief, craters };
constexpr std::uint32_t kShapeSeed = 25143;  // the number of (25143) Itokawa

RandomWords draw(Stream stream, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                 std::uint32_t d) {
  return philox4x32({a, b, c, d}, {kShapeSeed, static_cast<std::uint32_t>(stream)});
}

/// A random word as a number in -1..1.
double centred(std::uint32_t word) {
  return 2.0 * uniform(word) - 1.0;
}

/// Perlin's quintic: no crease in the first and second derivative at the lattice planes.
double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double mix(double a, double b, double t) {
  return a + t * (b - a);
}

/// Gradient noise in about -1..1 on the integer lattice (K. Perlin, "Improving Noise", SIGGRAPH
/// 2002) with a random gradient per lattice point.
double noise(const Eigen::Vector3d& p, std::uint32_t octave) {
  const Eigen::Vector3d cell(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  const Eigen::Vector3d inside = p - cell;
  std::array<double, 8> corners{};
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d step(i & 1U, (i >> 1U) & 1U, (i >> 2U) & 1U);
    const auto lattice = [&](int axis) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell[axis] + step[axis]));
    };
    const RandomWords words = draw(Stream::relief, lattice(0), lattice(1), lattice(2), octave);
    const Eigen::Vector3d slope(centred(words[0]), centred(words[1]), centred(words[2]));
    corners[i] = dot(slope, inside - step);
  }
  const double u = fade(inside.x());
  const double v = fade(inside.y());
  const double w = fade(inside.z());
  return mix(mix(mix(corners[0], corners[1], u), mix(corners[2], corners[3], u), v),
             mix(mix(corners[4], corners[5], u), mix(corners[6], corners[7], u), v), w);
}

/// Lumps and fine roughness, as a fraction of the radius.
double relief(const Eigen::Vector3d& p) {
  struct Octave {
    double frequency;
    double amplitude;
  };
  // The smallest wavelength, 1/26 of a half-axis, is still two edges of the mesh.
  constexpr std::array<Octave, 6> kOctaves = {
      {{1.1, 0.26}, {2.3, 0.10}, {4.9, 0.030}, {9.7, 0.013}, {17.0, 0.007}, {26.0, 0.005}}};
  double height = 0.0;
  for (std::uint32_t i = 0; i < kOctaves.size(); ++i) {
    height += kOctaves[i].amplitude * noise(kOctaves[i].frequency * p, i);
  }
  return height;
}

struct Crater {
  Eigen::Vector3d centre;  // on the ellipsoid
  double radius = 0.0;
  double depth = 0.0;
  double rim = 0.0;  // height above the ground around
};

Eigen::Vector3d on_ellipsoid(const Eigen::Vector3d& direction) {
  return {kHalfAxes[0] * direction.x(), kHalfAxes[1] * direction.y(), kHalfAxes[2] * direction.z()};
}

/// A uniform direction on the sphere: the first random point of the cube inside the unit ball.
Eigen::Vector3d random_direction(std::uint32_t index) {
  for (std::uint32_t attempt = 0;; ++attempt) {
    const RandomWords words = draw(Stream::craters, index, 0, attempt, 0);
    const Eigen::Vector3d p(centred(words[0]), centred(words[1]), centred(words[2]));
    const double length = dot(p, p);
    if (length <= 1.0 && length > 1e-4) return unit(p);
  }
}

/// Largest first, as many of radius above R as 1 / R^2: the population of a surface in
/// equilibrium (D. E. Gault, "Saturation and equilibrium conditions for impact cratering on the
/// lunar surface", Radio Science 5(2), 1970). Fresh craters are about a fifth of their diameter
/// deep, old ones shallower.
std::vector<Crater> make_craters() {
  constexpr std::uint32_t kCount = 420;
  constexpr double kMin = 0.030;
  constexpr double kMax = 0.34;
  std::vector<Crater> craters(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const RandomWords words = draw(Stream::craters, i, 1, 0, 0);
    const double radius = std::min(kMax, kMin * std::sqrt(kCount / (i + uniform(words[0]))));
    const double freshness = uniform(words[1]);
    craters[i] = {.centre = on_ellipsoid(random_direction(i)),
                  .radius = radius * (0.75 + 0.25 * uniform(words[2])),
                  .depth = radius * (0.12 + 0.24 * freshness),
                  .rim = radius * (0.025 + 0.075 * freshness)};
  }
  return craters;
}

/// The smaller of two numbers, rounded off where they meet to within `width` (I. Quilez's quadratic
/// smooth minimum).
double soft_min(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - overlap * overlap * width / 4.0;
}

constexpr double kReach = 1.9;       // extent of the ejecta blanket in crater radii
constexpr double kCrestWidth = 0.1;  // of the radius; a sharper crest would alias on this mesh

/// Adds a crater to the height so far: a bowl that meets the blanket at the rim. It removes half
/// of the older relief inside it. `t` is the distance from its centre in crater radii.
double cratered(double height, const Crater& crater, double t) {
  const double s = (kReach - t) / (kReach - 1.0);
  const double blanket = crater.rim * s * s * s;
  const double bowl = (crater.depth + crater.rim) * t * t - crater.depth;
  const double wiped = 0.5 * std::max(1.0 - t * t, 0.0);
  return height * (1.0 - wiped) + soft_min(bowl, blanket, kCrestWidth * crater.radius);
}

double crater_height(const Eigen::Vector3d& p, const std::vector<Crater>& craters) {
  double height = 0.0;
  for (const Crater& crater : craters) {
    // By components: this line runs 17 million times, unoptimised builds included.
    const double dx = p.x() - crater.centre.x();
    const double reach = kReach * crater.radius;
    if (std::abs(dx) >= reach) continue;
    const Eigen::Vector3d away(dx, p.y() - crater.centre.y(), p.z() - crater.centre.z());
    const double squared = dot(away, away);
    if (squared >= reach * reach) continue;
    height = cratered(height, crater, std::sqrt(squared) / crater.radius);
  }
  return height;
}

/// Sums the tetrahedra between the origin and the triangles.
Eigen::Vector3d centre_of_volume(const PointMesh& mesh) {
  double volume = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.points_m[i];
    const Eigen::Vector3d& b = mesh.points_m[j];
    const Eigen::Vector3d& c = mesh.points_m[k];
    const double six_volumes = dot(a, b.cross(c));
    volume += six_volumes;
    moment += six_volumes * ((a + b) + c) / 4.0;
  }
  return moment / volume;
}

}  // namespace

PointMesh make_asteroid() {
  PointMesh mesh = icosphere(kIcosphereLevels);
  const std::vector<Crater> craters = make_craters();
  for (Eigen::Vector3d& point : mesh.points_m) {
    const Eigen::Vector3d direction = point;
    const Eigen::Vector3d ground = on_ellipsoid(direction);
    // Points move radially, so the surface cannot intersect itself.
    point = ground * (1.0 + relief(ground)) + direction * crater_height(ground, craters);
  }
  const Eigen::Vector3d centre = centre_of_volume(mesh);
  const auto by_x = [](const auto& a, const auto& b) { return a.x() < b.x(); };
  const auto [low, high] = std::minmax_element(mesh.points_m.begin(), mesh.points_m.end(), by_x);
  const double scale = kLength_m / (high->x() - low->x());
  for (Eigen::Vector3d& point : mesh.points_m) point = scale * (point - centre);
  return mesh;
}

}  // namespace glidar
