// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "frame.hpp"

namespace glidar::python {

/// Throws Error when the frame's hits are not hits on this scene: an object or a triangle that it
/// does not have, or another number of objects.
void require_hits_of(const Scene& scene, const Measured& measured);

}  // namespace glidar::python
