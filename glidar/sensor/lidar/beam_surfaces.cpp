// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/lidar/beam_surfaces.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace glidar {
namespace {

constexpr double kBend = 0.25;                   // of the distance between two points
constexpr double kRounding = 1e-6;               // of the range
constexpr double kSmooth = 0.70710678118654752;  // cosine of 45 degrees

double tolerance_m(const SubRayHit& a, const SubRayHit& b, double distance_m) {
  return kBend * distance_m + kRounding * std::max(a.range_m, b.range_m);
}

/// Distance of b in front of a's plane, along a's ray, m; negative: behind.
double in_front_m(const SubRayHit& a, const Eigen::Vector3d& from_a_to_b) {
  constexpr double kGrazing = 1e-9;
  return a.normal.dot(from_a_to_b) / std::max(a.cos_incidence, kGrazing);
}

using Labels = std::vector<std::uint16_t>;

/// Union of the sets of two members; the representative of a set is its first member.
void join(Labels& sets, std::size_t a, std::size_t b) {
  const auto first_of = [&](std::size_t member) {
    while (sets[member] != member) member = sets[member];
    return member;
  };
  const std::size_t one = first_of(a);
  const std::size_t other = first_of(b);
  sets[std::max(one, other)] = static_cast<std::uint16_t>(std::min(one, other));
}

/// Replaces every member's parent by the representative of its set. Parents precede members.
void flatten(Labels& sets) {
  for (std::uint16_t& set : sets) set = sets[set];
}

}  // namespace

bool is_one_triangle(const Hits& hits, std::size_t first, std::size_t count) {
  unsigned others = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    others |= static_cast<unsigned>(hits.instance[i] != hits.instance[first]) |
              static_cast<unsigned>(hits.primitive[i] != hits.primitive[first]);
  }
  return others == 0;
}

bool has_gap(const SubRayHit& a, const SubRayHit& b) {
  const Eigen::Vector3d from_a_to_b = b.position_m - a.position_m;
  const double b_front_m = in_front_m(a, from_a_to_b);
  const double a_front_m = in_front_m(b, -from_a_to_b);
  if (b_front_m * a_front_m >= 0.0) return false;
  return std::min(std::abs(a_front_m), std::abs(b_front_m)) > tolerance_m(a, b, from_a_to_b.norm());
}

void BeamSurfaces::find(const Beams& rays, const Hits& hits, std::size_t first, std::size_t count) {
  points_.clear();
  of_ray_.assign(count, 0);
  if (is_one_triangle(hits, first, count)) return;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = first + k;
    if (hits.instance[i] == kInvalidId) continue;
    SubRayHit& point = points_.emplace_back();
    point.position_m = hits.range_m[i] * rays.directions[i];
    if (!rays.origins_m.empty()) point.position_m += rays.origins_m[i];
    point.normal = hits.normal[i].cast<double>();
    point.cos_incidence = std::abs(point.normal.dot(rays.directions[i]));
    point.range_m = hits.range_m[i];
    point.ray = static_cast<std::uint32_t>(k);
  }
  label();
}

void BeamSurfaces::find(std::vector<SubRayHit> points, std::size_t count) {
  points_ = std::move(points);
  of_ray_.assign(count, 0);
  label();
}

void BeamSurfaces::label() {
  if (points_.size() < 2 || is_one_face()) return;
  find_faces();
  join_faces();
  for (std::size_t i = 0; i < points_.size(); ++i) of_ray_[points_[i].ray] = surface_[i];
}

/// A fast test that succeeds for most beams: all points are near the plane of the first.
bool BeamSurfaces::is_one_face() const {
  const SubRayHit& a = points_.front();
  return std::all_of(points_.begin() + 1, points_.end(), [&](const SubRayHit& b) {
    const Eigen::Vector3d from_a_to_b = b.position_m - a.position_m;
    return std::abs(in_front_m(a, from_a_to_b)) <= tolerance_m(a, b, from_a_to_b.norm()) &&
           a.normal.dot(b.normal) >= kSmooth;
  });
}

void BeamSurfaces::find_faces() {
  face_.resize(points_.size());
  std::iota(face_.begin(), face_.end(), std::uint16_t{0});
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const SubRayHit& a = points_[j];
      const SubRayHit& b = points_[i];
      if (a.normal.dot(b.normal) >= kSmooth && !has_gap(a, b)) join(face_, j, i);
    }
  }
  flatten(face_);
}

void BeamSurfaces::join_faces() {
  const std::size_t count = points_.size();
  apart_.assign(count * count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (face_[i] == face_[j] || !has_gap(points_[j], points_[i])) continue;
      apart_[face_[i] * count + face_[j]] = 1;
      apart_[face_[j] * count + face_[i]] = 1;
    }
  }
  surface_ = face_;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (apart_[face_[i] * count + face_[j]] == 0) join(surface_, face_[j], face_[i]);
    }
  }
  flatten(surface_);
}

}  // namespace glidar
