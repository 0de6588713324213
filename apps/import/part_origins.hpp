// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace glidar::import {

/// The origin of each placed mesh, to which its single-precision coordinates are relative.
/// Along an axis on which the whole model is farther from zero than its own size, that is the
/// centre of its box, else zero; in both cases single precision represents coordinates of single
/// precision without rounding (Sterbenz 1974), and others to 1e-7 of the model's size. If it rounds
/// a part by more than kMaxShare of the part's size, and by more than kMaxRounding units or
/// kMaxShare of the model's size, parts far from the common origin get their own origins, at most
/// kMaxOrigins in all. Parts that share a vertex position share their origin, so that no gaps open.
/// `box`: of the model.
std::vector<Eigen::Vector3d> part_origins(const SourceModel& source,
                                          const Eigen::AlignedBox3d& box);

inline constexpr double kMaxRounding = 1e-6;
inline constexpr double kMaxShare = 1e-7;
inline constexpr std::size_t kMaxOrigins = 64;

/// The bounding box of all vertices of triangles.
Eigen::AlignedBox3d box_of(const SourceModel& source);

}  // namespace glidar::import
