// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <memory>
#include <optional>

namespace glidar {

/// Position for position packets, degrees north and east. Without it they state no fix.
struct GeoPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// True if the sensor is named after a Velodyne model: VLP-16, Puck Hi-Res, VLP-32C, HDL-32E,
/// HDL-64E S3 or VLS-128.
bool is_velodyne(const Sensor& sensor);

/// Data packets (port 2368) and position packets (port 8308). Throws Error, naming the sensor, when
/// its lasers do not fire as those of its model do, or its returns are not the strongest, the last,
/// or both.
std::unique_ptr<PacketEncoder> make_velodyne_encoder(
    const Sensor& sensor, const std::optional<GeoPosition>& position = {});

/// Angles come from the sensor, the hour from the time of capture. The intensity is the packets'
/// byte. Throws Error like make_velodyne_encoder.
std::unique_ptr<PacketDecoder> make_velodyne_decoder(const Sensor& sensor);

}  // namespace glidar
