// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/lanes.hpp>
#include <glidar/render/planes.hpp>

namespace glidar {

/// Cosines of incidence below which a plane has lost 20 of its 52 bits.
inline constexpr double kGrazing = 0x1p-20;

/// Vectors of the vertices of one mesh at the lanes' triangles.
struct TrianglesToGather {
  const float* of_vertex;          ///< three numbers per vertex
  const std::uint32_t* vertices;   ///< three per triangle
  const std::uint32_t* primitive;  ///< per lane
};

/// Input of BlockKernel::intersect: a block whose lanes all hit the same instance.
struct OneInstanceHits {
  const double* object_from_sensor;  ///< InstanceView's, column by column
  const double* sensor_in_object;    ///< where the beams start
  const Lanes3<double>* direction;   ///< of the beams, in the sensor's frame
  TrianglesToGather positions;       ///< relative to the mesh's origin
  bool is_one_triangle;              ///< all lanes hit the same one
  const TrianglePlane* planes;       ///< per triangle; nullptr: not stored
};

/// Where BlockKernel::intersect writes: the members of ExactHits.
struct HitsToFind {
  CornerBlock* corners;  ///< unless the planes are stored
  Lanes3<double>* normal;
  Lanes3<double>* origin;
  Lanes3<double>* direction;
  Lanes<double>* offset;
  Lanes<double>* cosine;
  Lanes<double>* distance;
};

/// The inner loops over the hits of a block, compiled for one instruction set as those of the ray
/// caster. Each does all of its work at once, because calls and memory take longer than numbers.
struct BlockKernel {
  const char* name;  ///< as rays::Kernel::name
  /// Gathers planes; or gathers corners, and computes planes as plane_of(), cosine = n.d and
  /// distance = (offset - n.o) / (n.d) as distance_to(). False when a lane needs
  /// intersect_grazing().
  bool (*intersect)(const OneInstanceHits& block, const HitsToFind& exact);
  /// Turns normals to the sensor and into its frame, and writes them lane after lane.
  void (*orient)(const double* sensor_from_object, const Lanes3<double>& front,
                 const Lanes<double>& cosine, float* normals);
  /// Computes planes as plane_of().
  void (*find_planes)(const CornerBlock& corners, Lanes3<double>& normal, Lanes<double>& offset);
  void (*gather)(const TrianglesToGather& from, CornerBlock& to);
};

}  // namespace glidar
