// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace glidar::link {

/// A listening socket of ZeroMQ's, which accepts whatever comes, held back from outside. Used by
/// one thread.
class Listener {
 public:
  /// Of this descriptor, which stays ZeroMQ's.
  explicit Listener(int descriptor);
  ~Listener();
  Listener(Listener&& other) noexcept;
  Listener& operator=(Listener&&) = delete;

  /// From now on the kernel discards attempts to connect, which clients repeat for a minute or
  /// more; connections that exist are not affected. Over TCP only: others are not held back.
  void pause();
  void resume();
  [[nodiscard]] bool is_paused() const { return is_paused_; }
  /// Closes the connections that wait to be accepted; true: none is left. Works without a free
  /// descriptor.
  bool discard_waiting();

 private:
  int descriptor_;
  int spare_;  ///< given up for a moment where there is no other
  bool is_paused_ = false;
};

/// Allows this process as many open files as it needs for these connections, if the system does.
void raise_descriptor_limit(std::int64_t connections);

/// The number of descriptors that this process may have.
int descriptor_limit();

}  // namespace glidar::link
