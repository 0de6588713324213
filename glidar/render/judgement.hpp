// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/resolve.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>

namespace glidar {

/// Who was hit; instance kNoHit: nobody.
struct Found {
  std::uint32_t instance = kNoHit;
  std::uint32_t primitive = kNoHit;

  bool operator==(const Found&) const = default;
};

/// The order of triangles in a scene: by instance, then by their index in its mesh.
inline bool is_lower(const Found& a, const Found& b) {
  return std::tie(a.instance, a.primitive) < std::tie(b.instance, b.primitive);
}

/// How far inside a triangle a point of its plane lies, object units: the smallest signed distance
/// to an edge.
double distance_inside(const Mesh& mesh, std::uint32_t triangle, const Eigen::Vector3d& normal,
                       const Eigen::Vector3d& point);

/// Rounding in double of a point at most `length` from the zero of its frame: a beam this far
/// outside a border is on it, and two surfaces this far apart, measured across them, coincide.
inline double slack(double length) {
  constexpr double kSlackPerLength = 0x1p-44;  // 256 roundings of a coordinate
  return kSlackPerLength * length;
}

/// False where a triangle lets a beam through: by its side when back faces are culled, or by a hole
/// of its alpha mask.
bool stops(const Resolver& resolver, const Beams& beams, std::size_t beam, bool cull_back_faces,
           const Found& candidate);

/// Weighs triangles for one beam, exactly: for renderers that found one in single precision.
/// First consider() all candidates, then consider_tie() all of them once more.
struct Judgement {
  const Resolver& resolver;
  const Beams& beams;
  std::size_t beam;
  double slack_m;      ///< of the candidates considered next
  Found nearest = {};  ///< of those the beam meets
  Found closest = {};  ///< to the beam, of those it misses by more than rounding
  double nearest_range_m = std::numeric_limits<double>::infinity();
  double nearest_cosine = 0.0;  ///< of its normal and the beam
  double nearest_slack_m = 0.0;
  double nearest_inside_m = 0.0;  ///< how far the nearest's borders are from the beam
  double closest_inside_m = -std::numeric_limits<double>::infinity();

  void consider(const Found& candidate);

  /// Takes the candidate instead of the nearest when both coincide where the beam meets them and
  /// the candidate is the lower in the scene's order. They coincide when they are no farther apart
  /// than slack(), measured across the one that the beam meets more steeply.
  void consider_tie(const Found& candidate);

  /// True when the beam meets the nearest clearly inside of its borders. Rounding moves the place
  /// along the beam by slack() over the cosine: in the plane of a triangle nothing is clear.
  [[nodiscard]] bool is_clear() const {
    return nearest.instance != kNoHit &&
           nearest_inside_m * std::abs(nearest_cosine) > nearest_slack_m;
  }

 private:
  /// Where the beam meets a candidate's plane.
  struct Meeting {
    double range_m;   ///< not positive or NaN: nowhere
    double inside_m;  ///< of the triangle's borders; negative outside
    double cosine;    ///< of plane normal and beam
  };
  [[nodiscard]] Meeting meet(const Found& candidate) const;
};

}  // namespace glidar
