// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/motion: keys that several kinds of motion have.

#include <Eigen/Core>

namespace glidar {

class FieldVisitor;

/// `rate_rad_s` or `rate_deg_s`.
void visit_rate(FieldVisitor& visitor, bool is_required, Eigen::Vector3d& rate_rad_s);

/// `velocity_m_s`; `text` documents it.
void visit_velocity(FieldVisitor& visitor, const char* text, Eigen::Vector3d& velocity_m_s);

}  // namespace glidar
