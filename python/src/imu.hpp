// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/sensor/imu/imu.hpp>

namespace glidar::python {

/// An IMU in Python; it does not change.
struct ImuHandle {
  Imu imu;
};

}  // namespace glidar::python
