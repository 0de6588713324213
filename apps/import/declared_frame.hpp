// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>

#include <glidar/io/model/model.hpp>

#include <string>
#include <vector>

struct aiScene;

namespace glidar::import {

/// Takes the unit and the up axis that the file declares, or that the standard of its format fixes,
/// and makes sure that the importer's scene is in the file's own numbers and axes. `format` is
/// Model::format. What is declared but of no use is reported in notes.
/// Sources: COLLADA 1.5 (asset: unit, up_axis), glTF 2.0 section 3.4, 3MF core specification 1.3
/// section 3.2 (model: unit; the part of the package that _rels/.rels names), AMF (ISO/ASTM 52915,
/// unit), FBX GlobalSettings (UnitScaleFactor in cm, UpAxis).
ModelFrame take_declared_frame(aiScene& scene, const std::string& format, FileContent& file,
                               std::vector<std::string>& notes);

}  // namespace glidar::import
