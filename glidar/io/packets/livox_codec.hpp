// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/livox_packet.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/sensor/sensor.hpp>

#include <memory>

namespace glidar {

/// True for sensors with rotating prisms whose name begins with "Livox".
bool is_livox(const Sensor& sensor);

/// The packets of Livox SDK 2, of Mid-360 and HAP. Points are in the order of firing, with zeros
/// for beams without a return and for points beyond the numbers of the type. Throws Error, naming
/// the sensor, when it reports several returns or its beams do not divide a packet, and for imu.
std::unique_ptr<PacketEncoder> make_livox_encoder(const Sensor& sensor,
                                                  LivoxDataType type = LivoxDataType::cartesian_mm);

/// Decodes all types. A frame has the points of 1 / Sensor::rate_hz; beams without a return have no
/// direction. Throws Error like make_livox_encoder.
std::unique_ptr<PacketDecoder> make_livox_decoder(const Sensor& sensor);

}  // namespace glidar
