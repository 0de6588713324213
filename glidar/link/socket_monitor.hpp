// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>
#include <glidar/link/connection_guard.hpp>

#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace glidar::link {

/// Receives ZeroMQ's events of a socket's connections. With a guard it uses its own thread, so that
/// limits apply even if the socket's thread is busy.
class SocketMonitor {
 public:
  /// `context` and `socket` are ZeroMQ's and must outlive it; `name` is unique in the context.
  SocketMonitor(void* context, void* socket, const std::string& name,
                std::unique_ptr<ConnectionGuard> guard);
  ~SocketMonitor();
  SocketMonitor(const SocketMonitor&) = delete;
  SocketMonitor& operator=(const SocketMonitor&) = delete;

  /// Events since the last call; to be called in the socket's thread.
  std::vector<PeerEvent> events();
  /// The guard, or nullptr.
  [[nodiscard]] ConnectionGuard* guard() { return guard_.get(); }

 private:
  void run();

  void* socket_;
  void* reports_;  ///< ZeroMQ's socket of events, used by the thread if there is one
  std::unique_ptr<ConnectionGuard> guard_;
  UniqueFd ending_;  ///< readable when the thread is to end
  std::thread thread_;
};

}  // namespace glidar::link
