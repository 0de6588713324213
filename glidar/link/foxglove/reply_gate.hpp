// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/link/foxglove/server.hpp>

#include <boost/asio/io_context.hpp>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace glidar::foxglove {

/// Passes answers from any thread to the server's thread, until the server ends.
class ReplyGate {
 public:
  explicit ReplyGate(boost::asio::io_context& io) : io_(&io) {}
  /// Runs the work in the server's thread, unless the server has ended.
  void post(std::function<void()> work);
  /// From now on, post() does nothing.
  void close();

 private:
  std::mutex mutex_;
  boost::asio::io_context* io_;
};

/// What the caller receives to answer a pick. `answer` runs once in the server's thread, without a
/// text if the reply was destroyed without a call.
PickReply make_pick_reply(const std::shared_ptr<ReplyGate>& gate,
                          std::function<void(std::optional<std::string>)> answer);

}  // namespace glidar::foxglove
