// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/fisher_information.hpp>

#include <string>

namespace glidar {

/// A displacement in words, in its own coordinate frame: a translation, or a rotation about an axis
/// through a point, with a pitch if it is a screw motion. Lengths much smaller than `length_m` are
/// omitted.
std::string describe_displacement(const Vector6& displacement, double length_m);

}  // namespace glidar
