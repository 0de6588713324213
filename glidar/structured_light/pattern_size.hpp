// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field_visitor.hpp>

namespace glidar {

/// Allowed widths and heights of FringePatterns, pixels.
inline constexpr WholeRule kPatternSideRule = {1, 16384};

}  // namespace glidar
