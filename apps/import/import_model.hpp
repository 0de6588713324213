// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/source_model.hpp>

#include <glidar/io/model/mesh_blob.hpp>

#include <filesystem>
#include <functional>

namespace glidar::import {

/// Reads a model file. Throws Refusal if it is unusable; the caller reports other errors (memory,
/// invalid data).
ImportedModel import_model(const std::filesystem::path& canonical_model, ModelFolder folder,
                           double crease_angle_rad, const std::function<void(double)>& progress);

}  // namespace glidar::import
