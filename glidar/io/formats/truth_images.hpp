// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/formats/cloud_file.hpp>

namespace glidar {

// Images of the ground truth as 8-bit or 16-bit PNG, 0 where beams hit nothing. Errors state which
// number is out of range.

/// 8-bit RGB: the surface's colour times the cosine of incidence, as lit by a light at the sensor
/// without attenuation.
void write_rgb_png(const CloudFile& job, AtomicFile& file);

/// 16-bit RGB: the triangle's unit normal in the cloud's frame, n = 2 v / 65535 - 1.
void write_normal_png(const CloudFile& job, AtomicFile& file);

/// 16-bit grey: ids of instances.
void write_instance_png(const CloudFile& job, AtomicFile& file);

/// 8-bit grey, for scenes with more than 256 classes 16-bit grey: ids of classes.
void write_class_png(const CloudFile& job, AtomicFile& file);

}  // namespace glidar
