// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/scene.hpp>

#include <string>

namespace glidar {

/// The classes of a scene as a configuration of the SemanticKITTI API: the text of a YAML file with
/// names and colours of labels, which are learned as they are, except 0 (unlabelled).
std::string kitti_classes(const Scene& scene);

}  // namespace glidar
