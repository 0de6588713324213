// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/sensor/beam_cache.hpp>

#include <utility>

namespace glidar {

BeamCache::BeamCache(Sensor sensor)
    : sensor_(std::move(sensor)), first_(std::make_shared<const Beams>(make_beams(sensor_))) {}

BeamCache::BeamCache(Sensor sensor, Beams first)
    : sensor_(std::move(sensor)), first_(std::make_shared<const Beams>(std::move(first))) {}

std::shared_ptr<const Beams> BeamCache::beams(std::uint32_t frame) const {
  if (frame == 0 || std::holds_alternative<Pinhole>(sensor_.optics)) return first_;
  const std::lock_guard lock(mutex_);
  if (const auto found = in_use_.find(frame); found != in_use_.end()) {
    if (std::shared_ptr<const Beams> beams = found->second.lock()) return beams;
  }
  latest_ = std::make_shared<const Beams>(make_beams(sensor_, frame_interval(sensor_, frame)));
  std::erase_if(in_use_, [](const auto& entry) { return entry.second.expired(); });
  in_use_[frame] = latest_;
  return latest_;
}

}  // namespace glidar
