// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "trajectory_state.hpp"

#include <string>

namespace glidar::python {

/// Hash over all meshes, materials, textures, objects and classes of a scene, not over the names of
/// the files they came from. Equal scenes have equal digests.
std::string digest_of(const Scene& scene);

/// The arrays of a mesh that Python made, and the mesh of such arrays, to the last bit. The second
/// throws Error or a Python error when the state is malformed.
nb::dict mesh_state(const SceneHandle& handle, std::size_t index);
Mesh mesh_from(const nb::dict& state);

}  // namespace glidar::python
