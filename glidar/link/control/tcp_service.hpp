// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/control/ouster_api.hpp>
#include <glidar/link/endpoint.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/http_guard.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace glidar::control {

/// Limits of a sensor's HTTP server: its configuration is short.
inline link::HttpLimits sensor_http_limits() {
  return {.body_bytes = 16'384};
}

/// Answers one HTTP request (RFC 9112) that the guard lets pass, and ends. `api` and `guard` must
/// outlive it.
std::unique_ptr<Conversation> make_http_conversation(OusterApi& api, link::HttpGuard& guard,
                                                     const std::string& client);

/// Whether this build answers drivers over TCP: HTTP of Ouster, PTC of Hesai. That needs Boost.
bool has_tcp_services();

struct TcpServiceOptions {
  link::Endpoint at;
  std::string what;               ///< for errors
  std::size_t connections = 128;  ///< beyond, the one that was silent for longest makes room
  std::chrono::milliseconds request{10'000};  ///< from its first byte until its answer is read
  std::chrono::milliseconds idle{0};          ///< without a request; 0: no limit
};

/// Accepts TCP connections and answers what they send, in a thread of its own.
class TcpService {
 public:
  /// The log and what the factory refers to must outlive it. Throws Error if the endpoint cannot be
  /// used, and in builds without Boost.
  TcpService(const TcpServiceOptions& options, ConversationFactory make, link::ErrorLog& errors);
  ~TcpService();
  TcpService(const TcpService&) = delete;
  TcpService& operator=(const TcpService&) = delete;

  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glidar::control
