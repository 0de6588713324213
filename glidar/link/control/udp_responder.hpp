// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link/control.

#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/control/control_server.hpp>
#include <glidar/link/control/livox_commands.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>

namespace glidar::control {

/// Answers the commands of Livox SDK 2, see serve_livox().
class UdpResponder final : public ControlServer {
 public:
  /// Throws Error if a port is in use.
  UdpResponder(const LivoxSensor& sensor, std::uint16_t command_port, std::uint16_t search_port,
               link::ErrorLog& errors);
  ~UdpResponder() override;
  UdpResponder(const UdpResponder&) = delete;
  UdpResponder& operator=(const UdpResponder&) = delete;

  [[nodiscard]] std::uint16_t port() const override { return port_; }

 private:
  void run();
  void receive(const UniqueFd& from);
  [[nodiscard]] bool may_answer();
  [[nodiscard]] bool is_heard(const std::string& client) const;

  link::ErrorLog& errors_;
  bool is_loopback_;
  UniqueFd commands_socket_;
  UniqueFd search_;     ///< answers to searches are sent from here
  UniqueFd broadcast_;  ///< searches that are broadcast
  UniqueFd stop_;
  std::uint16_t port_;
  LivoxCommands commands_;
  std::chrono::steady_clock::time_point second_;
  int answers_ = 0;  ///< in this second
  std::thread thread_;
};

}  // namespace glidar::control
