// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>

#include <memory>
#include <string>

namespace glidar::app {

/// An OSI trace with the detections of every sensor and the ground truth of all objects, see
/// docs/osi.md. The scene must outlive it. Throws Error.
std::unique_ptr<FrameSink> make_osi_sink(const std::string& path, const PreparedScene& prepared,
                                         PoseOrigin origin);

}  // namespace glidar::app
