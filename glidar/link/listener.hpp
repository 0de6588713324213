// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/unique_fd.hpp>

#include <cstdint>

namespace glidar::link {

/// Blocks and drains a listening socket of ZeroMQ, which itself accepts every connection. Used by
/// one thread.
class Listener {
 public:
  /// For this descriptor, which ZeroMQ owns.
  explicit Listener(int descriptor);

  /// Makes the kernel discard attempts to connect, which clients repeat for a minute or more;
  /// existing connections are not affected. TCP only.
  void pause();
  void resume();
  [[nodiscard]] bool is_paused() const { return is_paused_; }
  /// Closes the connections that wait to be accepted; returns true if none is left. Works without a
  /// free descriptor.
  bool discard_waiting();

 private:
  UniqueFd descriptor_;
  UniqueFd spare_;  ///< closed temporarily if there is no free descriptor
  bool is_paused_ = false;
};

/// Raises the process's limit of open files for these connections, as far as the system allows.
void raise_descriptor_limit(std::int64_t connections);

/// Throws Error unless the process can open this many more descriptors.
void require_descriptors(int count);

/// The maximum number of descriptors of this process.
int descriptor_limit();

}  // namespace glidar::link
