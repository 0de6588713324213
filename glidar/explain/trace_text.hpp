// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/explain.hpp>

#include <string>

namespace glidar {

/// The story of an entry in words and numbers, for people. `frame` is the one that was explained.
std::string format_trace(const PointTrace& story, const Setup& setup, const Frame& frame);

}  // namespace glidar
