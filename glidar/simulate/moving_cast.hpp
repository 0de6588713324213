// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/motion/motion.hpp>
#include <glidar/render/renderer.hpp>

namespace glidar {

/// A world that is measured, and when a frame of it starts.
struct TimedScene {
  Renderer& renderer;
  const Scene& scene;
  const Motion& motion;
  std::int64_t stamp_ns = 0;
};

/// True when the beams leave at different times while something moves.
bool moves_during_frame(const Motion& motion, const Beams& beams);

/// Casts beams each of which sees the world at its own firing time, exactly, not by steps. When
/// nothing moves while they leave, this is one cast. Otherwise what stands still is one body, every
/// moving instance another. For each body the beams are expressed in the frame in which the body
/// rests, cast as usual, and a beam keeps the nearest of its hits.
///
/// `request` is that of a frame at rest: beams in the sensor's frame, poses at stamp_ns. Hits come
/// out as if each beam had been cast alone at stamp_ns + times_ns: normals in the sensor's frame of
/// that time, depth along its boresight.
void cast_moving(const TimedScene& world, const CastRequest& request, Workspace& memory,
                 Hits& hits);

/// The `nominal` beams, and the `aimed` ones where these differ, as seen from the sensor's pose at
/// stamp_ns; nothing when the sensor stands still while they leave.
void deskew(const TimedScene& world, const Beams& nominal, const Beams& aimed,
            Frame::Deskewed& deskewed);

}  // namespace glidar
