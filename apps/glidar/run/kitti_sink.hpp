// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/prepared_scene.hpp>

#include <memory>
#include <string>
#include <vector>

namespace glidar::app {

/// A KITTI folder with the scans and images of all frames, see docs/files/kitti.md. `read`: files
/// that it must not replace. Flags and scene must outlive it. Throws Error.
std::unique_ptr<FrameSink> make_kitti_sink(const std::string& path, const RenderFlags& flags,
                                           const PreparedScene& prepared,
                                           const std::vector<std::string>& read);

}  // namespace glidar::app
