// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace glidar::link {

/// A place in the network: an IPv4 address, a name, or "*" for all of this machine. Or, within this
/// machine, a file that sockets of its file system meet at.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;  ///< 0: any that is free
  std::string path = {};   ///< of the file; empty: host and port
};
std::string text_of(const Endpoint& endpoint);
/// Throws the Error of a socket that cannot be used there; `error`: errno, or one of ZeroMQ.
[[noreturn]] void fail_at(const Endpoint& endpoint, int error, const char* doing);
/// Of "tcp://HOST:PORT" or "ipc://PATH"; throws Error on anything else.
Endpoint parse_endpoint(const std::string& text);

}  // namespace glidar::link
