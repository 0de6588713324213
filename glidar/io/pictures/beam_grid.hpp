// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project.

#include <glidar/core/beams.hpp>
#include <glidar/io/pictures/beam_picture.hpp>

#include <optional>

namespace glidar {

/// Rows of one elevation with even steps of azimuth, shifted so that all rows have the same azimuth
/// in a column, highest row on top; empty when the beams are not like that.
/// A whole turn begins behind the sensor; of a part the picture is as wide as all rows together.
std::optional<BeamPicture> make_grid_picture(const Beams& beams, std::uint32_t first_beam);

}  // namespace glidar
