// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/field_visitor.hpp>

#include <array>

namespace glidar {

/// The units that the numbers of a model file may have, in metres, as scene files and options name
/// them.
inline constexpr std::array<Named<double>, 5> kLengthUnits = {
    {{"mm", 0.001}, {"cm", 0.01}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}}};

}  // namespace glidar
