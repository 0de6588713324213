// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/control/ouster_api.hpp>

#include <memory>
#include <string>

namespace glidar::control {

/// Answers one HTTP request (RFC 9112) and ends. Requests of web pages, which browsers mark with
/// Origin or Sec-Fetch-Site, are refused. `api` must outlive it.
std::unique_ptr<Conversation> make_http_conversation(OusterApi& api, const std::string& client);

}  // namespace glidar::control
