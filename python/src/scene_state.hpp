// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "trajectory_state.hpp"

#include <string>

namespace glidar::python {

/// Hash over all objects of a scene with their meshes, materials, textures and classes; neither
/// over the names of the files they came from, nor over what no object has. Equal scenes have equal
/// digests.
std::string digest_of(const Scene& scene);

/// The arrays of a mesh that Python made, and the mesh of such arrays, to the last bit. `index`
/// counts meshes without stretched copies. The second throws Error or a Python error when the state
/// is malformed.
nb::dict mesh_state(const SceneHandle& handle, std::size_t index);
Mesh mesh_from(const nb::dict& state);

}  // namespace glidar::python
