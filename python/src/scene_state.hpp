// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "trajectory_state.hpp"

#include <string>

namespace glidar::python {

/// Hash over all objects of a scene with their meshes, materials, textures and classes; not
/// over file names, nor over data that no object uses. Equal scenes have equal
/// digests.
std::string digest_of(const Scene& scene);

/// The arrays of a mesh from Python, and the bit-identical mesh from such arrays. `index`
/// counts meshes without scaled copies. The second throws Error or a Python error when the state
/// is malformed.
nb::dict mesh_state(const SceneHandle& handle, std::size_t index);
Mesh mesh_from(const nb::dict& state);

}  // namespace glidar::python
