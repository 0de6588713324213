// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/beams.hpp>
#include <glidar/core/frame.hpp>
#include <glidar/math/thread_pool.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <functional>
#include <span>

namespace glidar {

/// What a frame was cast with.
struct CastContext {
  const Sensor& sensor;
  const Beams& beams;  ///< as the sensor reports them
  const Beams& fired;  ///< with their pointing errors; `beams` itself without any
  std::span<const std::uint8_t> instance_enabled;  ///< as in CastRequest
  ThreadPool& thread_pool;
};

/// Called after the cast: replaces range, intensity and status of every beam, as
/// woods2016_measurement() does. The ground truth remains the renderer's. Empty: range and
/// intensity come from the renderer's hits.
using ReturnReplacement = std::function<void(const CastContext& context, Frame& frame)>;

}  // namespace glidar
