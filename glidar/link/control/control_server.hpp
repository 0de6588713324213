// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/control/livox_commands.hpp>
#include <glidar/link/control/ouster_api.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glidar::control {

/// What a Hesai sensor states of itself by PTC.
struct PtcSensor {
  std::string calibration;  ///< CSV: Channel,Elevation,Azimuth
  std::uint8_t model = 0;   ///< 2: Pandar64, 15: PandarQT, 25: PandarXT-32
  std::uint8_t channels = 0;
  std::uint8_t return_mode = 1;  ///< 0: last, 1: strongest, 2: both
  std::uint16_t spin_rate_rpm = 600;
  std::uint16_t packet_port = 2368;       ///< of data, as their encoder states it
  std::string address = "127.0.0.1";      ///< IPv4, of the sensor
  std::string destination = "127.0.0.1";  ///< IPv4, of the receiver at the start
  std::uint16_t destination_port = 2368;  ///< of the receiver at the start
  DestinationRule destinations = {};
  DestinationCallback on_destination = {};
};

/// Codes of answers (Hesai, "TCP API Reference Manual").
enum class PtcResult : std::uint8_t {
  success = 0,
  invalid_parameter = 1,
  invalid_data = 3,
  unsupported = 5,
};

struct PtcReply {
  PtcResult result = PtcResult::success;
  std::vector<std::byte> payload;
};

/// The commands of Hesai's protocol PTC that drivers send at their start. Of the configuration,
/// only the destination of packets can be changed; other values must be those that are simulated.
/// Not thread-safe.
class PtcCommands {
 public:
  explicit PtcCommands(const PtcSensor& sensor);

  PtcReply answer(std::uint8_t command, std::span<const std::byte> payload,
                  const std::string& client);

 private:
  [[nodiscard]] std::vector<std::byte> inventory() const;
  [[nodiscard]] std::vector<std::byte> config() const;
  [[nodiscard]] std::vector<std::byte> status() const;
  PtcReply set_destination(std::span<const std::byte> payload, const std::string& client);

  PtcSensor sensor_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Answers requests one after the other: 47 74, command, 0, length of the payload as uint32 with
/// the highest byte first, payload. `commands` must outlive it.
std::unique_ptr<Conversation> make_ptc_conversation(PtcCommands& commands,
                                                    const std::string& client);

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
