// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model_folder.hpp>

#include <string>

namespace glidar {

/// What the search for a texture came to.
struct TextureLookup {
  std::string name;    ///< as the model spells it
  std::string found;   ///< canonical path of the file; empty: none
  std::string reason;  ///< why none, in words

  bool operator==(const TextureLookup&) const = default;
};

/// The text with %20 and the like replaced by the characters that they stand for.
std::string percent_decoded(const std::string& text);

/// Looks for the file that a model means by a texture name, never outside the model's root.
/// The name is tidied (spaces around it, backslashes, `file://`, %20), absolute and `C:\` paths are
/// cut to their base name, and it is looked for as given, then by its base name, in the model's
/// folder, `textures/`, `materials/textures/` and, in a model package, `../materials/textures/`
/// and `../textures/`, then beside the material files; at last in the same places in any letter
/// case.
TextureLookup find_texture(const std::string& name, const ModelFolder& folder);

}  // namespace glidar
