// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/io/config/scene_plan.hpp>

namespace glidar {

/// The IMUs of a scene file and the gravity that they measure: `imus` and `gravity_m_s2`. The
/// sensors of the plan are known.
void visit_imus(FieldVisitor& visitor, ScenePlan& plan);

}  // namespace glidar
