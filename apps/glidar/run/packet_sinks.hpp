// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <apps/glidar/options/render_options.hpp>
#include <apps/glidar/run/frame_sink.hpp>
#include <apps/glidar/run/rig_messages.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace glidar::app {

/// Index of the sensor of this name, or of the only one that has packets; `where` is for errors.
/// Throws Error when there is none, or several.
std::size_t packet_sensor(const PreparedScene& prepared, const std::string& name,
                          const std::string& where);

/// A capture of the packets of the only sensor that has packets. Throws Error when there is none,
/// or several.
std::unique_ptr<FrameSink> make_capture_sink(const std::string& path, const RenderFlags& flags,
                                             const PreparedScene& prepared, PoseOrigin origin);

}  // namespace glidar::app
