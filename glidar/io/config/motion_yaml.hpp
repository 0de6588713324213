// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/motion/motion.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// {spin: ...}, {twist: ...}, {tumbling: ...} from the pose at time 0, or {trajectory: ...}, which
/// gives the poses itself and throws Error when `start` is given too. Adds files read to `files`.
Trajectory read_motion(const YamlField& field, const std::optional<Pose>& start,
                       std::vector<std::string>& files);

}  // namespace glidar
