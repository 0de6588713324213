// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/render/renderer.hpp>
#include <glidar/verify/comparison.hpp>
#include <glidar/verify/shapes.hpp>
#include <glidar/verify/verify.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glidar {

/// Four uniform random numbers in (0, 1), a function of a case's number and an index.
std::array<double, 4> probe_uniforms(std::uint32_t number, std::uint32_t index);

/// A uniformly distributed rotation (Shoemake, "Uniform random rotations", Graphics Gems III).
Eigen::Quaterniond random_rotation(const std::array<double, 4>& u);

/// A unit direction, uniformly distributed within an angle of +z, from two uniform numbers.
Eigen::Vector3d random_direction(double u0, double u1, double half_angle_rad);

/// The beams of a small camera with this half field of view.
Beams camera_probes(double half_view_rad);

/// The beams of a spinning scanner: 32 rows with uneven elevations, staggered by up to a column,
/// and 1024 columns.
Beams scanner_probes();

/// Beams of one row without structure; empty origins: all zero.
Beams unstructured_probes(std::vector<Eigen::Vector3d> directions,
                          std::vector<Eigen::Vector3d> origins_m = {});

/// 4096 beams in random directions within an angle of +z, with origins in a square of width
/// spread_m around the sensor's. Uses probe_uniforms() 1 to 4096 of the case.
Beams random_probes(std::uint32_t number, double half_view_rad, double spread_m);

/// A shape that beams are aimed at, relative to the sensor's position.
struct AimTarget {
  const PlacedShape& placed;
  Eigen::Matrix3d sensor_from_axes;
  std::uint32_t number;  ///< key of the random numbers
};

/// Beams at all vertices and edges whose faces are all front-facing, and beams through the scaled
/// vertices, most of which miss the shape.
Beams beams_at_vertices_and_edges(const AimTarget& at);

/// Beams that pass the silhouette edges (between a front face and a back face) at a distance of
/// 1e-9 to 1e-6 of the shape's radius, on either side.
Beams beams_beside_outline(const AimTarget& at);

/// Rays that pass an edge nearer than this fraction of the shape's radius are not compared.
/// Renderers may search in float32 relative to a point near the shape, so that vertices and rays
/// are off by a few roundings (2^-24 = 6e-8 of the radius); the tolerance is 32 roundings.
inline constexpr double kEdgeTolerance = 2e-6;

/// One shape at one position, measured from one pose.
struct VerifyCase {
  std::size_t shape = 0;        ///< index into make_shapes()
  double distance_m = 1.0;      ///< between the sensor and the sphere around the shape
  double radius_m = 0.5;        ///< of that sphere
  double offset_m = 0.0;        ///< of the shape from the world's origin
  bool offset_in_mesh = false;  ///< the offset is in the mesh's origin, not in the pose
  std::uint32_t number = 0;     ///< of the case; key of the attitudes and random rays
};

/// All offsets and sizes of one shape at this distance.
std::vector<VerifyCase> make_cases(std::size_t shape, double distance_m);

/// The distances of make_cases(), 0.1 m to 10 km.
const std::vector<double>& verify_distances();

/// Casts the rays of a camera and random rays at the shape, and compares the hits with the closed
/// form.
VerifyResult run_case(const VerifyCase& verify_case, const Shape& shape,
                      const VerifySubject& subject);

/// Beams with different firing times from a moving and rotating sensor, at a moving and a static
/// target. The exact hits follow the motion in extended precision.
VerifyResult moving_sensor_and_target(const VerifySubject& subject,
                                      const std::vector<Shape>& shapes);

/// Such beams among many bodies, most of which move.
VerifyResult sensor_in_traffic(const VerifySubject& subject, const std::vector<Shape>& shapes);

/// The beams at the target measured by a sensor: also the poses of sensor and target, the beams
/// without the motion, and radial velocities.
VerifyResult measured_motion(const VerifySubject& subject, const std::vector<Shape>& shapes);

/// A scene that is difficult for renderers, with its own beams.
struct SpecialCase {
  std::string name;
  std::string shape;
  double distance_m = 0.0;
  BeamKind needs = BeamKind::pinhole;  ///< the renderer must cast at least these beams
  std::function<VerifyResult(const VerifySubject&)> run;
};

/// Several instances 10 km and 100 km away and one nearby, a sensor 1.5 m above a planet, a scanner
/// among bodies, a moving sensor and a moving target, sensors on vertices, beams at vertices and
/// edges, beams beside silhouettes, large casts and scenes, and measurements. The shapes must
/// outlive the cases.
std::vector<SpecialCase> special_cases(const std::vector<Shape>& shapes);

}  // namespace glidar
