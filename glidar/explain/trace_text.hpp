// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/simulate/explain.hpp>

#include <string>

namespace glidar {

/// The trace of an entry as readable text, in lines "head      content". `frame` is the frame that
/// explain() filled.
std::string format_trace(const PointTrace& trace, const Simulator& simulator, const Frame& frame);

}  // namespace glidar
