// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model_folder.hpp>

#include <string>

namespace glidar {

/// The result of a texture search.
struct TextureLookup {
  std::string name;    ///< as in the model
  std::string found;   ///< canonical path of the file; empty: none
  std::string reason;  ///< reason for a failure, in words

  bool operator==(const TextureLookup&) const = default;
};

/// The text with percent-encoding such as %20 decoded.
std::string percent_decoded(const std::string& text);

/// Searches for the file of a texture name, never outside the model's root and the texture folders.
/// The name is used as it is and normalised (surrounding spaces, backslashes, %20, `file://`,
/// `model://`, `package://`), absolute and `C:\` paths are cut to their base name, and it is
/// searched as given, then by its base name, in the model's folder, `textures/`,
/// `materials/textures/` and, in a model package, `../materials/textures/` and `../textures/`, then
/// in the folders of material files; then by its last components, most of them first, below each
/// texture folder; finally by its base name in all these folders ignoring letter case.
TextureLookup find_texture(const std::string& name, const ModelFolder& folder);

}  // namespace glidar
