// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace glidar::link {

/// A network address: an IPv4 address, a host name, or "*" for all addresses of this machine, with
/// a port; or the path of a socket file on this machine.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;  ///< 0: any free port
  std::string path = {};   ///< of the socket file; empty: host and port
};
std::string text_of(const Endpoint& endpoint);
/// Throws Error for a socket that cannot be used at an endpoint; `error` is errno or an error of
/// ZeroMQ.
[[noreturn]] void fail_at(const Endpoint& endpoint, int error, const char* doing);
/// Parses "tcp://HOST:PORT" or "ipc://PATH"; throws Error for anything else.
Endpoint parse_endpoint(const std::string& text);

}  // namespace glidar::link
