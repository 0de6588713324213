// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/sensor/lidar/lidar_equation.hpp>

#include <array>
#include <vector>

namespace glidar {

/// `lidar_equation` of a sensor file.
LidarEquation read_lidar_equation(const YamlField& field);

/// `backscatter` of a material: `{type: lambert|phong|oren_nayar|retro|glossy, ...}`.
Brdf read_backscatter(const YamlField& field);

/// `spectrum` of a material: pairs of wavelength in nm and reflectance, the wavelengths rising.
LookupTable read_spectrum(const YamlField& field);

}  // namespace glidar
