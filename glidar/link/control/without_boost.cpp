// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Instead of tcp_service.cpp in builds without Boost.
#include <glidar/core/error.hpp>
#include <glidar/link/control/tcp_service.hpp>

namespace glidar::control {

bool has_tcp_services() {
  return false;
}

struct TcpService::Impl {};

TcpService::TcpService(const TcpServiceOptions& options, ConversationFactory /*make*/,
                       link::ErrorLog& /*errors*/) {
  throw Error({.where = options.what,
               .found = "this build does not contain it",
               .remedy = "install Boost (Debian: libboost-dev) and build again"});
}

TcpService::~TcpService() = default;

std::uint16_t TcpService::port() const {
  return 0;
}

std::unique_ptr<Conversation> make_http_conversation(OusterApi& /*api*/, link::HttpGuard& /*guard*/,
                                                     const std::string& /*client*/) {
  return nullptr;
}

}  // namespace glidar::control
