// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/motion/motion.hpp>

#include "convert.hpp"

#include <string>
#include <vector>

namespace glidar::python {

/// Trajectories in Python: one, or those of many objects or frames.
struct Trajectories {
  std::vector<Trajectory> all;
};

/// All numbers of trajectories as dicts of plain values and arrays, for pickle.
nb::list states_of(const std::vector<Trajectory>& trajectories);

/// The bit-identical trajectories from such dicts. Throws Error or a Python error when one is
/// malformed.
std::vector<Trajectory> trajectories_from(const nb::list& states);

/// An unchanged pose, unlike pose_of(), which makes matrices exactly rigid. Throws Error naming it
/// when it is not a rigid transform.
Pose restored_pose(const Matrix4& matrix, const std::string& name);

}  // namespace glidar::python
