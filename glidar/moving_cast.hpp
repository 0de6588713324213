// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/render/renderer.hpp>

namespace glidar {

/// True when the beams of a frame leave at different times while something moves.
bool moves_during_frame(const Motion& motion, const Beams& beams);

/// Casts beams each of which sees the world at its own firing time, exactly, not by steps: what
/// stands still is one body, every moving instance another. For each body the beams are expressed
/// in the frame in which the body rests, cast as usual, and a beam keeps the nearest of its hits.
///
/// `request` is that of a frame at rest: beams in the sensor's frame, poses at frame.stamp_ns. Hits
/// come out as if each beam had been cast alone at stamp_ns + times_ns: normals in the sensor's
/// frame of that time, depth along its boresight. When the sensor moves, frame.deskewed holds the
/// `nominal` beams (those of the request, but for errors of pointing) as seen from the sensor's
/// pose at stamp_ns. request.then is not called.
void cast_moving(Renderer& renderer, const CastRequest& request, const Beams& nominal,
                 const Scene& scene, const Motion& motion, Frame& frame);

}  // namespace glidar
