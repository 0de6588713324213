// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "convert.hpp"

#include <glidar/motion/motion.hpp>

#include <vector>

namespace glidar::python {

/// Trajectories in Python: one, or those of many objects or frames.
struct Trajectories {
  std::vector<Trajectory> all;
};

}  // namespace glidar::python
