// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/reply_gate.hpp>

#include <boost/asio/post.hpp>

#include <utility>

namespace glidar::foxglove {
namespace {

using Answer = std::function<void(std::optional<std::string>)>;

/// Answers once: when called, or when destroyed.
class PendingReply {
 public:
  PendingReply(std::shared_ptr<ReplyGate> gate, Answer answer)
      : gate_(std::move(gate)), answer_(std::move(answer)) {}
  PendingReply(const PendingReply&) = delete;
  PendingReply& operator=(const PendingReply&) = delete;
  ~PendingReply() { reply(std::nullopt); }

  void reply(std::optional<std::string> text) {
    Answer answer;
    {
      const std::lock_guard lock(mutex_);
      answer = std::exchange(answer_, {});
    }
    if (!answer) return;
    gate_->post([answer = std::move(answer), text = std::move(text)] { answer(text); });
  }

 private:
  std::shared_ptr<ReplyGate> gate_;
  std::mutex mutex_;
  Answer answer_;
};

}  // namespace

void ReplyGate::post(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  if (io_ != nullptr) boost::asio::post(*io_, std::move(work));
}

void ReplyGate::close() {
  const std::lock_guard lock(mutex_);
  io_ = nullptr;
}

PickReply make_pick_reply(const std::shared_ptr<ReplyGate>& gate, Answer answer) {
  const auto pending = std::make_shared<PendingReply>(gate, std::move(answer));
  return [pending](const std::string& text) { pending->reply(text); };
}

}  // namespace glidar::foxglove
