// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: boxes of objects as JSON.

#include <glidar/core/frame.hpp>
#include <glidar/core/scene.hpp>

#include <nlohmann/json.hpp>

namespace glidar {

/// A box as sidecars and messages have it, in the coordinate frame of a cloud. Keys keep their
/// order; docs/boxes.md explains them.
nlohmann::ordered_json box_json(const Scene& scene, const ObjectBox& box,
                                const Pose& cloud_from_sensor);

}  // namespace glidar
