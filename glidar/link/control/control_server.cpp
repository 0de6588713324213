// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/control_server.hpp>

#include <glidar/link/control/http_conversation.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/control/udp_responder.hpp>

#include <utility>

namespace glidar::control {
namespace {

class OusterServer final : public ControlServer {
 public:
  OusterServer(const OusterApiOptions& sensor, const link::Endpoint& at, link::ErrorLog& errors)
      : api_(sensor),
        guard_(access_rules(at), link::HttpClients::programs, sensor_http_limits()),
        service_(
            {.at = at,
             .what = "HTTP of the sensor",
             .connections = guard_.limits().connections,
             .request = guard_.limits().request,
             .idle = guard_.limits().request},
            [this](const std::string& client) {
              return make_http_conversation(api_, guard_, client);
            },
            errors) {}
  [[nodiscard]] std::uint16_t port() const override { return service_.port(); }

 private:
  /// Requests may address the server by the host name that --control specifies.
  static link::AccessRules access_rules(const link::Endpoint& at) {
    link::AccessRules rules{.origins = {}, .hosts = {}};
    if (at.host != "*") rules.hosts.push_back(at.host);
    return rules;
  }

  OusterApi api_;
  link::HttpGuard guard_;  // used in the service's thread
  TcpService service_;
};

class HesaiServer final : public ControlServer {
 public:
  HesaiServer(const PtcSensor& sensor, const link::Endpoint& at, link::ErrorLog& errors)
      : commands_(sensor),
        service_(
            {.at = at, .what = "PTC of the sensor"},
            [this](const std::string& client) { return make_ptc_conversation(commands_, client); },
            errors) {}
  [[nodiscard]] std::uint16_t port() const override { return service_.port(); }

 private:
  PtcCommands commands_;
  TcpService service_;
};

}  // namespace

std::unique_ptr<ControlServer> serve_ouster(const OusterApiOptions& sensor,
                                            const link::Endpoint& at, link::ErrorLog& errors) {
  return std::make_unique<OusterServer>(sensor, at, errors);
}

std::unique_ptr<ControlServer> serve_hesai(const PtcSensor& sensor, const link::Endpoint& at,
                                           link::ErrorLog& errors) {
  return std::make_unique<HesaiServer>(sensor, at, errors);
}

}  // namespace glidar::control
