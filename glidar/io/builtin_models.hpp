// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model.hpp>

#include <span>
#include <string>
#include <string_view>

namespace glidar {

/// What the name of a built-in model starts with where a file could be named too.
inline constexpr std::string_view kBuiltinPrefix = "builtin:";

/// Names after kBuiltinPrefix.
std::span<const std::string> builtin_model_names();

/// A closed mesh made in code, the same bytes on every machine:
///  sphere   radius 1 m, icosphere of 5,120 triangles, smooth normals
///  box      sides of 2 m, 12 triangles, flat, with uvs on every face
///  torus    ring radius 1 m, tube radius 0.4 m, around z, 16,384 triangles
///  plane    2 m x 2 m at z = 0, front to +z (not closed), with uvs
///  asteroid cratered rock 2 m long in x, 81,920 triangles, about its centre of volume
/// Throws Error on an unknown name, with the nearest one.
Model make_builtin_model(std::string_view name);

}  // namespace glidar
