// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/material.hpp>
#include <glidar/io/yaml_reader.hpp>
#include <glidar/sensor/signal.hpp>

#include <array>
#include <vector>

namespace glidar {

/// `pulse_light` of a sensor file.
PulseLight read_pulse_light(const YamlField& field);

/// `backscatter` of a material: `{type: lambert|phong|oren_nayar|retro|glossy, ...}`.
Backscatter read_backscatter(const YamlField& field);

/// `spectrum` of a material: pairs of wavelength in nm and reflectance, the wavelengths rising.
Table read_spectrum(const YamlField& field);

}  // namespace glidar
