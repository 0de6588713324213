// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <cstdint>
#include <memory>
#include <string>

namespace glidar {

/// True for sensors named after Pandar64, PandarQT or XT32.
bool is_hesai(const Sensor& sensor);

/// What a sensor states of itself to drivers.
struct HesaiIdentity {
  std::string angle_correction;  ///< CSV: Channel,Elevation,Azimuth in degrees, clockwise
  std::uint8_t model_number = 0;
  std::uint8_t channels = 0;
  std::uint8_t return_mode = 0;  ///< 0: last, 1: strongest, 2: both
  std::uint16_t spin_rate_rpm = 0;
};

/// Throws Error like make_hesai_encoder.
HesaiIdentity hesai_identity(const Sensor& sensor);

/// Throws Error, naming the sensor, when its channels or columns are not those of its model, or its
/// returns are not the strongest, the last, or both.
std::unique_ptr<PacketEncoder> make_hesai_encoder(const Sensor& sensor);

/// `follow_rotation`: the head turns on between a block's azimuth and a channel's firing. Hesai's
/// drivers do so only with a file of firing times. Throws Error like make_hesai_encoder.
std::unique_ptr<PacketDecoder> make_hesai_decoder(const Sensor& sensor,
                                                  bool follow_rotation = true);

}  // namespace glidar
