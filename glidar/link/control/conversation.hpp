// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link/control.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace glidar::control {

/// What received bytes lead to.
struct Step {
  std::size_t consumed = 0;  ///< bytes that are not needed any more
  std::string answer = {};   ///< to send; empty: none yet
  bool ends = false;         ///< the connection ends after the answer
  std::string error = {};    ///< what is malformed; empty: nothing
};

/// The protocol of one TCP connection.
class Conversation {
 public:
  Conversation() = default;
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;
  virtual ~Conversation() = default;

  /// Takes bytes that were received and not consumed before. Without an answer and an end, it waits
  /// for more.
  virtual Step receive(std::string_view bytes) = 0;
};

/// A conversation with the client at this IPv4 address.
using ConversationFactory = std::function<std::unique_ptr<Conversation>(const std::string& client)>;

}  // namespace glidar::control
