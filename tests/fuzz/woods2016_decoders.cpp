// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include "woods2016_decoders.hpp"

#include "demand.hpp"

#include <glidar/core/error.hpp>
#include <glidar/woods2016/protocol.hpp>

#include <cmath>
#include <cstring>

namespace glidar::testing {
namespace {

bool try_placement(std::span<const std::byte> bytes) {
  try {
    const woods2016::Placement placement = woods2016::decode_placement(bytes);
    demand(std::abs(placement.object.norm() - 1.0) < 1e-12, "object's attitude is a rotation");
    demand(std::abs(placement.sensor.norm() - 1.0) < 1e-12, "sensor's attitude is a rotation");
    demand(placement.translation_m.allFinite(), "positions are finite");
    const auto again = woods2016::encode_placement(placement);
    demand(std::memcmp(again.data(), bytes.data(), 9) == 0, "type and timestamp come back");
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool try_cloud(std::span<const std::byte> bytes) {
  try {
    const woods2016::Cloud cloud = woods2016::decode_cloud(bytes);
    demand(woods2016::cloud_bytes(cloud.points.size()) == bytes.size(), "every byte is of a point");
    for (const woods2016::CloudPoint& point : cloud.points) {
      demand(std::isfinite(point.x_m + 0.0F) && std::isfinite(point.intensity),
             "points are finite");
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool try_woods2016_decoders(std::span<const std::byte> bytes) {
  const bool is_placement = try_placement(bytes);
  const bool is_cloud = try_cloud(bytes);
  const bool is_shutdown = woods2016::is_shutdown(bytes);
  demand(int{is_placement} + int{is_cloud} + int{is_shutdown} <= 1, "a message has one meaning");
  return is_placement || is_cloud || is_shutdown;
}

}  // namespace glidar::testing
