// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

namespace glidar {

/// Instance or primitive of a miss.
inline constexpr std::uint32_t kInvalidId = std::numeric_limits<std::uint32_t>::max();

/// The optional columns of Hits that a cast fills. Only these are computed.
struct HitColumnMask {
  bool depth = false;
  bool normal = false;
  bool shading_normal = false;
  bool incidence = false;
  bool shading = false;
  bool barycentrics = false;
  bool colour = false;
  bool diffuse = false;
  bool reflectance = false;
  bool object_point = false;
  bool noise_scale = false;
  bool poses = false;            ///< Frame::beam_poses, which is not a column of Hits
  bool radial_velocity = false;  ///< Frame::true_radial_velocity_m_s, which is not one either
  bool boxes = false;            ///< Frame::boxes; not in kAllHitColumns
};

inline constexpr HitColumnMask kAllHitColumns = {.depth = true,
                                                 .normal = true,
                                                 .shading_normal = true,
                                                 .incidence = true,
                                                 .shading = true,
                                                 .barycentrics = true,
                                                 .colour = true,
                                                 .diffuse = true,
                                                 .reflectance = true,
                                                 .object_point = true,
                                                 .noise_scale = true,
                                                 .poses = true,
                                                 .radial_velocity = true};

/// The columns of either mask.
HitColumnMask operator|(const HitColumnMask& a, const HitColumnMask& b);

/// Phong coefficients of a surface (2016 paper, equation 5): luminances after textures, and the
/// exponent. All zero for a miss.
struct Reflectance {
  float diffuse = 0.0F;
  float ambient = 0.0F;
  float specular = 0.0F;
  float shininess = 0.0F;
};

/// Geometric ground truth per beam: no noise, no radiometry. N = number of beams. Range, instance
/// and primitive are always present; the other columns are empty unless requested.
/// A miss has range NaN, ids kInvalidId and NaN in every other column (colour, diffuse and
/// reflectance: 0; noise scale: 1). Normals are unit vectors in the sensor frame, oriented towards
/// the sensor.
struct Hits {
  std::vector<double> range_m;           ///< N, along the beam from its origin
  std::vector<std::uint32_t> instance;   ///< N, index into Scene::instances
  std::vector<std::uint32_t> primitive;  ///< N, index into Mesh::triangles
  std::vector<double> depth_m;           ///< N, range along the boresight from the sensor's origin
  std::vector<Eigen::Vector3f> normal;   ///< N, of the triangle
  std::vector<Eigen::Vector3f>
      shading_normal;                ///< N, interpolated vertex normals with the normal map applied
  std::vector<float> cos_incidence;  ///< N, cosine between -beam and `normal`, 0..1
  std::vector<float> cos_shading;  ///< N, the same with `shading_normal`; below 0 where the shading
                                   ///< normal faces away although the triangle does not
  std::vector<Eigen::Vector2f> barycentrics;  ///< N, weights of corners 1 and 2
  std::vector<Eigen::Vector3f> colour;   ///< N, diffuse rgb: material x texture x vertex colour
  std::vector<float> diffuse;            ///< N, Reflectance::diffuse alone, for pulsed sensors
  std::vector<Reflectance> reflectance;  ///< N
  std::vector<Eigen::Vector3d>
      object_point_m;              ///< N, the hit in the object's own frame, before scale
  std::vector<float> noise_scale;  ///< N, factor of the surface on the sensor's random errors
};

/// Resizes every requested column to `size` entries (contents unspecified) and clears the others.
/// Keeps capacity, so a second call of the same size allocates nothing.
void resize(Hits& hits, std::size_t size, const HitColumnMask& hit_columns);

/// Writes misses to the beams [first, first + count).
void write_misses(const HitColumnMask& hit_columns, std::size_t first, std::size_t count,
                  Hits& hits);

/// Copies all requested columns of one hit.
void copy_hit(const Hits& from, std::size_t source, const HitColumnMask& hit_columns, Hits& to,
              std::size_t target);

}  // namespace glidar
