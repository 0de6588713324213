// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/scene_walk.hpp>

#include <glidar/io/model/imported_model.hpp>

#include <filesystem>
#include <functional>

namespace glidar::import {

/// Reads a model file by Assimp. Throws Refusal with the importer's words; whatever else goes wrong
/// (damage, memory) is the caller's to tell.
ImportedModel import_model(const std::filesystem::path& canonical_model, double crease_angle_rad,
                           const std::function<void(double)>& progress);

}  // namespace glidar::import
