// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/livox_commands.hpp>
#include <glidar/link/control/ouster_api.hpp>
#include <glidar/link/control/ptc_commands.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>

#include <cstdint>
#include <memory>

namespace glidar::control {

inline constexpr std::uint16_t kHttpPort = 80;
inline constexpr std::uint16_t kPtcPort = 9347;
inline constexpr std::uint16_t kLivoxCommandPort = 56100;
inline constexpr std::uint16_t kLivoxSearchPort = 56000;

/// Answers clients in a thread of its own until it is destroyed. Nothing that they send ends it.
class ControlServer {
 public:
  ControlServer() = default;
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;
  virtual ~ControlServer() = default;

  /// The port at which it listens.
  [[nodiscard]] virtual std::uint16_t port() const = 0;
};

// Each listens at an endpoint and reports malformed requests to the log, which must outlive it.
// Destinations are reported in the server's thread. Throws Error if the endpoint cannot be used.

/// HTTP. Throws Error in builds without Boost.
std::unique_ptr<ControlServer> serve_ouster(const OusterApiOptions& sensor,
                                            const link::Endpoint& at, link::ErrorLog& errors);
/// PTC over TCP. Throws Error in builds without Boost.
std::unique_ptr<ControlServer> serve_hesai(const PtcSensor& sensor, const link::Endpoint& at,
                                           link::ErrorLog& errors);
/// UDP: commands at this endpoint, which becomes the sensor's address, and searches at
/// `search_port`, also those that are broadcast. At a loopback address, it answers this machine
/// only.
std::unique_ptr<ControlServer> serve_livox(LivoxSensor sensor, const link::Endpoint& at,
                                           link::ErrorLog& errors,
                                           std::uint16_t search_port = kLivoxSearchPort);

}  // namespace glidar::control
