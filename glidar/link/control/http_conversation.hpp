// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/control/ouster_api.hpp>
#include <glidar/link/http_guard.hpp>

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

}  // namespace glidar::control
