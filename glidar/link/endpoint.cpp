// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/endpoint.hpp>

#include <glidar/core/error.hpp>

#include <zmq.h>

#include <cerrno>
#include <charconv>
#include <string_view>

namespace glidar::link {

std::string text_of(const Endpoint& endpoint) {
  if (!endpoint.path.empty()) return "ipc://" + endpoint.path;
  return "tcp://" + endpoint.host + ":" +
         (endpoint.port == 0 ? "*" : std::to_string(endpoint.port));
}

void fail_at(const Endpoint& endpoint, int error, const char* doing) {
  std::string remedy;
  if (error == EADDRINUSE) {
    remedy = "another program uses this port: end it, or choose another port";
  } else if (error == EADDRNOTAVAIL || error == ENODEV) {
    remedy = "give an address of this machine, such as 127.0.0.1, or * for all";
  } else if (error == EINVAL) {
    remedy = "give an IPv4 address or a host's name";
  } else if (error == EACCES) {
    remedy = "choose a port from 1024 on";
  }
  throw Error({.where = text_of(endpoint),
               .found = std::string("cannot ") + doing + ": " + zmq_strerror(error),
               .remedy = remedy});
}

Endpoint parse_endpoint(const std::string& text) {
  constexpr std::string_view kTcp = "tcp://";
  constexpr std::string_view kIpc = "ipc://";
  const auto refuse = [&](const char* remedy) {
    throw Error({.where = "endpoint",
                 .found = "'" + text + "'",
                 .allowed = "tcp://HOST:PORT with a port up to 65535, or ipc://PATH",
                 .remedy = remedy});
  };
  if (text.starts_with(kIpc)) {
    constexpr std::size_t kMaxPath_bytes = 107;  // sun_path of unix(7)
    const std::string path = text.substr(kIpc.size());
    if (path.empty() || path.size() > kMaxPath_bytes) refuse("give a path of 1 to 107 bytes");
    return {.host = {}, .port = 0, .path = path};
  }
  const std::size_t colon = text.rfind(':');
  if (!text.starts_with(kTcp) || colon <= kTcp.size()) refuse("for example tcp://127.0.0.1:5600");
  Endpoint endpoint{.host = text.substr(kTcp.size(), colon - kTcp.size())};
  const std::string_view port = std::string_view(text).substr(colon + 1);
  if (port == "*") return endpoint;
  const auto [stop, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc() || stop != port.data() + port.size() || endpoint.port == 0) {
    refuse("a port is a number from 1 to 65535, or * for any");
  }
  return endpoint;
}

}  // namespace glidar::link
