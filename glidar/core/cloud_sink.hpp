// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/frame.hpp>
#include <glidar/core/point_cloud.hpp>

#include <string>

namespace glidar {

/// Where clouds go: a file, a socket.
class CloudSink {
 public:
  CloudSink() = default;
  CloudSink(const CloudSink&) = delete;
  CloudSink& operator=(const CloudSink&) = delete;
  virtual ~CloudSink() = default;

  /// Takes one organised cloud and the frame it was made of. Throws Error when it cannot be
  /// delivered; then nothing of it is left behind.
  virtual void write(const PointCloud& cloud, const Frame& frame) = 0;
};

}  // namespace glidar
