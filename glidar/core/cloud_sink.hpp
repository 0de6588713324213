// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>

namespace glidar {

/// A destination of point clouds: a file or a socket.
class CloudSink {
 public:
  CloudSink() = default;
  CloudSink(const CloudSink&) = delete;
  CloudSink& operator=(const CloudSink&) = delete;
  virtual ~CloudSink() = default;

  /// Writes an organised cloud, made from `frame`. Throws Error when it cannot be delivered; then
  /// no part of it remains.
  virtual void write(const PointCloud& cloud, const Frame& frame) = 0;
};

}  // namespace glidar
