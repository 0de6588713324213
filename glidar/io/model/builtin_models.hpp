// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>

#include <span>
#include <string>
#include <string_view>

namespace glidar {

/// Prefix of built-in model names where a file name is possible too.
inline constexpr std::string_view kBuiltinPrefix = "builtin:";

/// Names after kBuiltinPrefix.
std::span<const std::string> builtin_model_names();

/// A generated closed mesh with the same bytes on every machine. `name` is one of these, optionally
/// followed by sizes in metres, each after a colon: "box:size=2,1,0.5",
/// "torus:radius=3:tube_radius=1".
///  sphere   radius (default 1), icosphere of 5,120 triangles, smooth normals
///  box      size, the lengths of its sides along x, y and z, or one for all (default 2), 12
///           triangles, flat, with uvs on every face
///  torus    radius (default 1) of the ring, tube_radius (default 0.4), around z, 16,384 triangles
///  plane    size along x and y, or one for both (default 2), at z = 0, front to +z (not closed),
///           with uvs
///  asteroid cratered rock 2 m long in x, 81,920 triangles, about its centre of volume
/// Throws Error on an unknown name or size, with the nearest one, and for sizes that are not above
/// 0.
Model make_builtin_model(std::string_view name);

}  // namespace glidar
