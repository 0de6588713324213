// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/recording_outputs.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// A bag with the topics of docs/bags.md: the clouds and images of every sensor, the samples of
/// every IMU, the transforms of the rig and its ground truth. Throws Error.
std::unique_ptr<RecordingOutput> make_bag_output(const std::string& path, const RenderFlags& flags,
                                                 const PreparedScene& prepared);

}  // namespace glidar::app
