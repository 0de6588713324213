// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/pose.hpp>
#include <glidar/sensor/optics/pinhole.hpp>
#include <glidar/structured_light/fringe_patterns.hpp>

#include <string>

namespace glidar {

class FieldVisitor;

/// The keys projector and projector_from_camera. A reader sets the size of the patterns, which are
/// read afterwards. `text` documents the projector.
void visit_projector(FieldVisitor& visitor, const char* text, Pinhole& projector,
                     Pose& projector_from_camera, FringePatterns& patterns);

/// Throws Error when the projector is at the position of the camera, so that there are no depths.
/// `where` is the owner of the pose.
void validate_baseline(const std::string& where, const Pose& projector_from_camera);

}  // namespace glidar
