// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace glidar::python {

/// A pool of unused frames, whose memory is reused.
class FramePool {
 public:
  FramePool();
  Frame take();
  void release(Frame frame) noexcept;

 private:
  std::mutex mutex_;
  std::vector<Frame> spare_;
  std::size_t spare_beams_ = 0;
};

/// A Python frame with its scene, sensor and renderer.
struct Measured {
  Measured(std::shared_ptr<FramePool> from, Frame measured)
      : pool(std::move(from)), frame(std::move(measured)) {}
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;
  ~Measured() {
    if (pool) pool->release(std::move(frame));
  }
  /// The scene that it measured, possibly without a renderer. Throws Error when a restored
  /// frame has none yet.
  [[nodiscard]] const PreparedScene& scene() const;
  /// The same with its renderer.
  [[nodiscard]] PreparedScene& rendered() const;

  std::shared_ptr<FramePool> pool;  ///< that the frame's memory returns to; may be null
  Frame frame;
  // for a restored frame each is set once when needed, because other threads may use
  // it
  std::shared_ptr<PreparedScene> prepared;
  std::shared_ptr<const PreparedScene> unrendered;  ///< of restored frames only
  std::shared_ptr<SensorHandle> sensor;
  std::shared_ptr<const Beams> beams;
  std::shared_ptr<const Motion> motion;
  std::atomic<bool> has_boxes =
      false;  ///< frame.boxes are found; changed with the turn of `prepared`
};

/// Whether there are objects whose boxes are not found yet.
bool lacks_boxes(const Measured& measured);

/// Finds frame.boxes, unless that is done. Needs the renderer; without Python's lock.
void ensure_boxes(Measured& measured);

}  // namespace glidar::python
