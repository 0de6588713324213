// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/link/control/control_server.hpp>

#include "io/packets/packet_fixture.hpp"

#include <mutex>
#include <string>
#include <vector>

namespace glidar::testing {

/// Destinations that clients have chosen.
class Destinations {
 public:
  control::DestinationCallback callback() {
    return [this](const control::Destination& to) {
      const std::lock_guard lock(mutex_);
      all_.push_back(std::to_string(to.packet_port) + " to " + to.address + ":" +
                     std::to_string(to.port));
    };
  }
  std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return all_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> all_;
};

/// An OS1-32 whose packets are sent to 10.0.0.9.
inline control::OusterApiOptions ouster_options(Destinations& destinations) {
  OusterOptions options;
  options.identity.udp_destination = "10.0.0.9";
  return {.metadata = ouster_metadata(packet_sensor("OS1-32", false), options),
          .destinations = {"10.0.0.9"},
          .on_destination = destinations.callback()};
}

/// A Hesai sensor whose packets are sent to 10.0.0.9.
inline control::PtcSensor ptc_sensor(Destinations& destinations,
                                     const std::string& preset = "XT32") {
  const HesaiIdentity identity = hesai_identity(packet_sensor(preset, false));
  control::PtcSensor sensor;
  sensor.calibration = identity.angle_correction;
  sensor.model = identity.model_number;
  sensor.channels = identity.channels;
  sensor.return_mode = identity.return_mode;
  sensor.spin_rate_rpm = identity.spin_rate_rpm;
  sensor.destination = "10.0.0.9";
  sensor.destinations = {"10.0.0.9"};
  sensor.on_destination = destinations.callback();
  return sensor;
}

/// A Livox sensor whose packets are sent to 10.0.0.9.
inline control::LivoxSensor livox_sensor(Destinations& destinations) {
  control::LivoxSensor sensor;
  sensor.destination = "10.0.0.9";
  sensor.destinations = {"10.0.0.9"};
  sensor.on_destination = destinations.callback();
  return sensor;
}

/// A PTC request.
inline std::string ptc_request(int command, const std::string& payload = {}) {
  std::string text = "\x47\x74";
  text += static_cast<char>(command);
  text += std::string(3, '\0');
  text += static_cast<char>(payload.size() >> 8);
  text += static_cast<char>(payload.size() & 0xff);
  return text + payload;
}

}  // namespace glidar::testing
