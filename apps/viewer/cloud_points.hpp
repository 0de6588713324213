// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/viewer/measurement_thread.hpp>

#include <Eigen/Core>
#include <vector>

namespace glidar::app {

/// The measured point of each beam in the world, relative to the anchor; NaN without a return.
void make_cloud_points(const Snapshot& snapshot, const Eigen::Vector3d& anchor_m,
                       std::vector<Eigen::Vector3f>& points);

}  // namespace glidar::app
