// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>

#include <filesystem>
#include <functional>

namespace glidar::import {

/// Reads the formats for which GLIDAR has no reader. Throws Refusal with Assimp's text.
SourceModel read_with_assimp(const std::filesystem::path& model, const ModelFolder& folder,
                             ModelFiles& files, FileLog& log,
                             const std::function<void(double)>& progress);

}  // namespace glidar::import
