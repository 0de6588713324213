// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>

#include <glidar/io/model/model.hpp>

#include <string>
#include <vector>

struct aiScene;

namespace glidar::import {

/// Returns the unit and the up axis that the file declares or its format's standard defines, and
/// converts the importer's scene back to the file's own numbers and axes. `format` is
/// Model::format. Unusable declarations are reported in notes. Sources: COLLADA 1.5 (asset: unit,
/// up_axis), glTF 2.0 section 3.4, 3MF core specification 1.3 section 3.2 (model: unit; the part of
/// the package that _rels/.rels names), AMF (ISO/ASTM 52915, unit), FBX GlobalSettings
/// (UnitScaleFactor in cm, UpAxis).
ModelFrame extract_declared_frame(aiScene& scene, const std::string& format, FileContent& file,
                                  Notes& notes);

}  // namespace glidar::import
