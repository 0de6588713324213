// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/simulation.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

namespace glidar {

/// The camera whose rays are in the workspace's hits.
struct ShadowView {
  const PreparedImager& imager;
  const Pose& world_from_eye;
  std::uint32_t time_ns = 0;  ///< of the image, since the start of the frame
};

/// A source of light in the frame of that camera: a point, or the sun.
struct ShadowLight {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> sun_direction = {};  ///< towards it; empty: the light is a point
};

/// Sets the radiance of rays to 0 whose surface does not see the light. One ray of each pixel is
/// tested; all are where neighbouring pixels differ, in light or shadow, in the object, or by more
/// than 3 % in range. Shadows of details that are narrower than that miss rays.
void remove_shadows(const Simulation& s, const ShadowView& view, const ShadowLight& light,
                    std::span<float> radiance);

}  // namespace glidar
