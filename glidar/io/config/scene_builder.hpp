// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/config/scene_plan.hpp>

#include <functional>
#include <string>

namespace glidar {

using ModelLoader = std::function<Model(const std::string& source, const ModelOptions& options)>;

/// Loads every model once and places its instances, in a scene that may have others. Errors of
/// `load` state their place in the scene file.
SceneFile build_scene(const ScenePlan& plan, const ModelLoader& load, Scene into = {});

}  // namespace glidar
