// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// A bag with the topics of docs/bags.md: the clouds and images of every sensor, the samples of
/// every IMU, the transforms of the rig and its ground truth. Flags and scene must outlive it.
/// Throws Error.
std::unique_ptr<FrameSink> make_bag_sink(const std::string& path, const RenderFlags& flags,
                                         const PreparedScene& prepared, PoseOrigin origin);

}  // namespace glidar::app
