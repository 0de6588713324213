// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: see ouster_codec.hpp for the metadata themselves.

#include <glidar/io/packets/ouster_codec.hpp>

namespace glidar {

/// The packets of a sensor. Throws Error, naming the sensor, unless its columns and rate are a mode
/// of Ouster sensors and its rows and returns fit the profile.
OusterFormat ouster_format(const Sensor& sensor, const OusterOptions& options);

}  // namespace glidar
