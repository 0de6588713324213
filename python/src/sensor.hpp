// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.hpp"

#include <glidar/sensor/beam_cache.hpp>

namespace glidar::python {

/// A sensor as Python holds it.
using SensorHandle = BeamCache;

}  // namespace glidar::python
