// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <import/model_files.hpp>
#include <import/source_model.hpp>

#include <filesystem>
#include <map>
#include <string>

namespace glidar::import {

/// Replaces a model file, for Assimp, by one without what Assimp fails on although the shape is
/// complete:
///  - COLLADA, also in archives (.zae): see mend_collada();
///  - 3MF: thumbnails and other pictures that no material names; archives in ZIP64;
///  - XML in UTF-16.
/// Notes what is left out. Throws Refusal for what Assimp would silently omit: 3MF with
/// extensions that it requires, or with parts in files of their own.
/// Returns the names that nodes of COLLADA and objects of 3MF have in the file, by those that
/// Assimp makes of their ids.
std::map<std::string, std::string> mend_model(const std::filesystem::path& model, ModelFiles& files,
                                              Notes& notes);

}  // namespace glidar::import
