// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/connection_guard.hpp>

#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace glidar::link {

/// Receives what ZeroMQ reports of a socket's connections. With a guard it does so in a thread of
/// its own, so that limits hold whatever the socket's thread does.
class SocketMonitor {
 public:
  /// Of ZeroMQ's context and socket, which must outlive it; `name` is unique in the context.
  SocketMonitor(void* context, void* socket, const std::string& name,
                std::unique_ptr<ConnectionGuard> guard);
  ~SocketMonitor();
  SocketMonitor(const SocketMonitor&) = delete;
  SocketMonitor& operator=(const SocketMonitor&) = delete;

  /// What happened since the last call. By the socket's thread.
  std::vector<PeerEvent> events();
  /// nullptr: there is none.
  [[nodiscard]] ConnectionGuard* guard() { return guard_.get(); }

 private:
  void run();

  void* socket_;
  void* reports_;  ///< ZeroMQ's, of the thread if there is one
  std::unique_ptr<ConnectionGuard> guard_;
  int ending_ = -1;  ///< can be read once the thread has to end
  std::thread thread_;
};

}  // namespace glidar::link
