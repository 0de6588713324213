// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>
#include <import/texture_store.hpp>

namespace glidar::import {

/// The material with its textures, which are read into the model.
///  - Cut-outs: AlphaMode::cut_out with its cutoff; an opacity texture, or a diffuse texture that
///    serves as one, with 0.5. Other transparency is solid, with a note.
///  - A bump strength that is not finite is ignored.
Material make_material(const SourceMaterial& source, TextureStore& textures, Model& model);

}  // namespace glidar::import
