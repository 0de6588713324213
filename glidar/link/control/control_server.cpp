// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/control_server.hpp>

#include <glidar/link/control/http_conversation.hpp>
#include <glidar/link/control/tcp_service.hpp>
#include <glidar/link/control/udp_responder.hpp>

#include <chrono>
#include <utility>

namespace glidar::control {
namespace {

class OusterServer final : public ControlServer {
 public:
  OusterServer(const OusterApiOptions& sensor, const link::Endpoint& at, link::ErrorLog& errors)
      : api_(sensor),
        service_(
            {.at = at, .what = "HTTP of the sensor", .idle = std::chrono::seconds(10)},
            [this](const std::string& client) { return make_http_conversation(api_, client); },
            errors) {}
  [[nodiscard]] std::uint16_t port() const override { return service_.port(); }

 private:
  OusterApi api_;
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
