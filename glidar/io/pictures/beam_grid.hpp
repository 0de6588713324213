// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the project.

#include <glidar/core/beams.hpp>
#include <glidar/io/pictures/beam_picture.hpp>

#include <optional>

namespace glidar {

/// A grid of rows with one elevation each and even steps of azimuth, shifted so that all rows have
/// the same azimuth in a column, highest row on top; empty for other beams. A full rotation begins
/// behind the sensor; for a sector the picture covers all rows.
std::optional<BeamPicture> make_grid_picture(const Beams& beams, std::uint32_t first_beam);

}  // namespace glidar
