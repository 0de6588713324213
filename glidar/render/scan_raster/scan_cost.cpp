// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/scan_cost.hpp>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>

namespace glidar::scan_raster {
namespace {

/// Clusters that are looked at, at most, and of each instance at least.
constexpr std::size_t kSamples = 2048;
constexpr std::size_t kLeastSamples = 8;
/// An instance costs a sector about as much as this many triangles.
constexpr double kTrianglesPerInstance = 15.0;

/// What is in view, in bins of azimuth and elevation.
class View {
 public:
  View(const BeamGrid& grid, const Beams& beams)
      : axes_(axes_of(beams)), columns_(grid.columns()), tangents_(grid.tangents()) {}

  /// True when a point in the sensor's frame is in view; takes its bin.
  bool take(const Eigen::Vector3d& point) {
    const double x = axes_.ahead.dot(point);
    const double y = axes_.left.dot(point);
    const double tangent = axes_.up.dot(point) / std::sqrt(x * x + y * y);
    const double column = column_at(std::atan2(y, x));
    if (!(tangent >= tangents_.low && tangent <= tangents_.high) || column >= columns_.count) {
      return false;
    }
    const double height = tangents_.high - tangents_.low;
    const double part = height > 0.0 ? (tangent - tangents_.low) / height : 0.0;
    const auto row = std::min(static_cast<std::size_t>(part * kRows), kRows - 1);
    const auto col = static_cast<std::size_t>(column / columns_.count * kCols);
    seen_.set(row * kCols + std::min(col, kCols - 1));
    return true;
  }

  [[nodiscard]] double part_seen() const {
    return static_cast<double>(seen_.count()) / (kRows * kCols);
  }

 private:
  static constexpr std::size_t kRows = 16;
  static constexpr std::size_t kCols = 64;

  /// From the first column on.
  [[nodiscard]] double column_at(double azimuth_rad) const {
    const double turn = 2.0 * std::numbers::pi / std::abs(columns_.step_rad);
    const double column = (azimuth_rad - columns_.phase_rad) / columns_.step_rad - columns_.first;
    return column - turn * std::floor(column / turn);
  }

  SensorAxes axes_;
  GridColumns columns_;
  TangentRange tangents_;
  std::bitset<kRows * kCols> seen_;
};

/// The instance's triangles in view.
double count_triangles(const rays::MeshTree& tree, const InstanceView& from, std::size_t samples,
                       View& view) {
  const std::size_t clusters = tree.clusters.size();
  const std::size_t stride = std::max<std::size_t>(1, clusters / samples);
  std::size_t seen = 0;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < clusters; i += stride) {
    const Eigen::Vector3d centre =
        Eigen::Map<const Eigen::Vector3f>(tree.clusters[i].centre).cast<double>();
    const Eigen::Vector3d point =
        from.object_from_sensor.transpose() * (centre - from.sensor_in_object);
    seen += view.take(point) ? 1 : 0;
    ++looked_at;
  }
  return static_cast<double>(kBlockSize * tree.blocks.size()) * static_cast<double>(seen) /
         static_cast<double>(looked_at);
}

}  // namespace

double triangles_per_beam(const BeamGrid& grid, const Beams& beams, const CpuBase& base) {
  const rays::SceneTrees& trees = base.search.trees();
  const std::vector<std::uint32_t>& instances = trees.instances();
  if (instances.empty()) return 0.0;
  View view(grid, beams);
  const std::size_t samples = std::max(kSamples / instances.size(), kLeastSamples);
  double triangles = kTrianglesPerInstance * static_cast<double>(instances.size()) *
                     static_cast<double>(grid.sectors().size());
  for (const std::uint32_t i : instances) {
    triangles += count_triangles(trees.of_instance(i), base.resolver.view(i), samples, view);
  }
  const double seeing = view.part_seen() * static_cast<double>(beams.size());
  return triangles / std::max(seeing, 1.0);
}

}  // namespace glidar::scan_raster
