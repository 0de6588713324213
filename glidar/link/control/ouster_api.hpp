// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/http_guard.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace glidar::control {

struct OusterApiOptions {
  std::string metadata;  ///< JSON, see ouster_metadata()
  std::uint16_t lidar_packet_port = 7502;
  std::uint16_t imu_packet_port = 7503;
  DestinationRule destinations = {};
  DestinationCallback on_destination = {};
};

struct ApiRequest {
  std::string_view method;
  std::string_view target;  ///< path and query
  std::string_view body = {};
  std::string client = {};                          ///< IPv4 address
  std::optional<link::HttpRefusal> no_change = {};  ///< it may only read, for this reason
};

struct ApiReply {
  int status = 200;
  std::string body;  ///< JSON
};

/// The reply of a request that a guard refuses.
ApiReply refusal_reply(const link::HttpRefusal& refused);

/// The HTTP API of Ouster sensors (firmware manual, "HTTP API Reference Guide"): metadata and its
/// sections, configuration, user data and firmware; with the commands of firmware before 2.4. Of
/// the configuration, only the destination of packets can be changed; other values must be those
/// that are simulated. Not thread-safe.
class OusterApi {
 public:
  /// Throws Error unless the metadata are a JSON object with the section config_params.
  explicit OusterApi(const OusterApiOptions& options);
  ~OusterApi();
  OusterApi(const OusterApi&) = delete;
  OusterApi& operator=(const OusterApi&) = delete;

  /// Never throws Error: malformed requests get a reply of status 4xx.
  ApiReply answer(const ApiRequest& request);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glidar::control
