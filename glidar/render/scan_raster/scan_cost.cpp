// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/scan_raster/scan_cost.hpp>

#include <glidar/math/portable.hpp>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <numbers>

namespace glidar::scan_raster {
namespace {

/// Maximum number of sampled clusters, and minimum per instance.
constexpr std::size_t kSamples = 2048;
constexpr std::size_t kMinSamples = 8;
/// An instance costs a sector about as much as this many triangles.
constexpr double kTrianglesPerInstance = 15.0;

/// Normalised position of a point in a view, from 0 to 1; outside of that, it is not in view.
struct ViewPosition {
  double across;
  double up;
};

/// The view of a scanner, by azimuth and elevation.
class ScannerView {
 public:
  ScannerView(const ScannerGrid& grid, const Beams& beams)
      : axes_(axes_of(beams)), columns_(grid.columns()), tangents_(grid.tangents()) {}

  [[nodiscard]] ViewPosition operator()(const Eigen::Vector3d& point) const {
    const double x = axes_.ahead.dot(point);
    const double y = axes_.left.dot(point);
    const double tangent = axes_.up.dot(point) / std::sqrt(x * x + y * y);
    const double columns_per_rotation = 2.0 * std::numbers::pi / std::abs(columns_.step_rad);
    const double column =
        (portable_atan2(y, x) - columns_.phase_rad) / columns_.step_rad - columns_.first;
    const double height = tangents_.high - tangents_.low;
    const bool is_level = !(height > 0.0) && tangent == tangents_.low;
    return {(column - columns_per_rotation * std::floor(column / columns_per_rotation)) /
                columns_.count,
            is_level ? 0.0 : (tangent - tangents_.low) / height};
  }

 private:
  SensorAxes axes_;
  GridColumns columns_;
  TangentRange tangents_;
};

/// The view of a camera.
class CameraView {
 public:
  explicit CameraView(const CameraGrid& grid) : points_(grid.points()) {}

  [[nodiscard]] ViewPosition operator()(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d part =
        (stereographic_point(point) - points_.min()).cwiseQuotient(points_.sizes());
    return {part.x(), part.y()};
  }

 private:
  Eigen::AlignedBox2d points_;
};

/// The cells of a view in which something is visible.
class ViewCoverage {
 public:
  /// True when the position is in view.
  bool take(const ViewPosition& position) {
    if (!(position.across >= 0.0 && position.across < 1.0 && position.up >= 0.0 &&
          position.up <= 1.0)) {
      return false;
    }
    const auto row = std::min(static_cast<std::size_t>(position.up * kRows), kRows - 1);
    const auto col = std::min(static_cast<std::size_t>(position.across * kCols), kCols - 1);
    visible_.set(row * kCols + col);
    return true;
  }

  /// Fraction of the view.
  [[nodiscard]] double share() const {
    return static_cast<double>(visible_.count()) / (kRows * kCols);
  }

 private:
  static constexpr std::size_t kRows = 16;
  static constexpr std::size_t kCols = 64;
  std::bitset<kRows * kCols> visible_;
};

/// Estimates the number of the instance's triangles in view.
template <class View>
double count_triangles(const rays::MeshTree& tree, const InstanceView& from, std::size_t samples,
                       const View& view, ViewCoverage& parts) {
  const std::size_t clusters = tree.clusters.size();
  const std::size_t stride = std::max<std::size_t>(1, clusters / samples);
  std::size_t visible = 0;
  std::size_t sampled = 0;
  for (std::size_t i = 0; i < clusters; i += stride) {
    const Eigen::Vector3d centre =
        Eigen::Map<const Eigen::Vector3f>(tree.clusters[i].centre).cast<double>();
    const Eigen::Vector3d point =
        from.object_from_sensor.transpose() * (centre - from.sensor_in_object);
    visible += parts.take(view(point)) ? 1 : 0;
    ++sampled;
  }
  return static_cast<double>(kBlockSize * tree.blocks.size()) * static_cast<double>(visible) /
         static_cast<double>(sampled);
}

template <class View>
VisibleCounts count_in(const View& view, const BeamGrid& grid, std::size_t beams,
                       const CpuBase& base) {
  const rays::SceneTrees& trees = base.search.trees();
  const std::vector<std::uint32_t>& instances = trees.instances();
  ViewCoverage parts;
  const std::size_t samples = kSamples / std::max<std::size_t>(instances.size(), 1);
  double triangles = kTrianglesPerInstance * static_cast<double>(instances.size()) *
                     static_cast<double>(grid.sectors().size());
  for (const std::uint32_t i : instances) {
    triangles += count_triangles(trees.of_instance(i), base.resolver.view(i),
                                 std::max(samples, kMinSamples), view, parts);
  }
  return {triangles, parts.share() * static_cast<double>(beams)};
}

}  // namespace

VisibleCounts estimate_visible(const BeamGrid& grid, const Beams& beams, const CpuBase& base) {
  return grid.is_camera() ? count_in(CameraView(grid.camera()), grid, beams.size(), base)
                          : count_in(ScannerView(grid.scanner(), beams), grid, beams.size(), base);
}

}  // namespace glidar::scan_raster
