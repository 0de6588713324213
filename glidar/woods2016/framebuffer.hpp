// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/render/woods2016_camera.hpp>
#include <glidar/simulate/return_replacement.hpp>

#include <optional>
#include <vector>

namespace glidar {

/// Decodes the beams `range` of a pinhole camera: range in metres along the beam, NaN where no
/// surface is visible, and intensity in [0, 1]. Both columns have one entry per beam.
void decode_framebuffer(const Woods2016Framebuffer& framebuffer, const Beams& beams,
                        BeamRange range, std::vector<double>& range_m,
                        std::vector<float>& intensity);

/// For Simulator::set_return_replacement(): the method of the 2016 paper. The camera, over the same
/// scene, draws the framebuffer Frame::framebuffer; range, intensity and status of every beam are
/// decoded from it. `planes` are those of equation (8); empty: as tight as possible around the
/// surfaces in view. The camera must outlive the result. A call throws Error for a pulsed sensor,
/// beams with firing times and pointing noise.
ReturnReplacement woods2016_measurement(Woods2016Camera& camera,
                                        std::optional<Woods2016DepthPlanes> planes = {});

}  // namespace glidar
