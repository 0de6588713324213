// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Instead of server.cpp in builds without Boost.
#include <glidar/link/foxglove/server.hpp>

#include <glidar/core/error.hpp>

namespace glidar::foxglove {

struct FoxgloveServer::Impl {};

FoxgloveServer::FoxgloveServer(const ServerOptions& /*options*/, link::ErrorLog& /*errors*/) {
  throw Error({.where = "Foxglove server",
               .found = "this build does not contain it",
               .remedy = "install Boost (Debian: libboost-dev) and build again"});
}

FoxgloveServer::~FoxgloveServer() = default;

ChannelId FoxgloveServer::add_channel(const ChannelOptions& /*options*/) {
  return 0;
}

void FoxgloveServer::publish(ChannelId /*channel*/, std::uint64_t /*time_ns*/,
                             link::Payload /*message*/) {}

void FoxgloveServer::publish_time(std::uint64_t /*time_ns*/) {}

void FoxgloveServer::set_playback(const PlaybackState& /*state*/) {}

bool FoxgloveServer::is_subscribed(ChannelId /*channel*/) const {
  return false;
}

std::uint16_t FoxgloveServer::port() const {
  return 0;
}

ServerCounts FoxgloveServer::counts() const {
  return {};
}

bool has_foxglove_server() {
  return false;
}

}  // namespace glidar::foxglove
