// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/tcp_session.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/write.hpp>

#include <utility>

namespace glidar::control {
namespace {

constexpr std::size_t kMaxPending = std::size_t{64} << 10U;
constexpr std::chrono::milliseconds kMaxDrain{2'000};

}  // namespace

TcpSession::TcpSession(boost::asio::ip::tcp::socket&& socket,
                       std::unique_ptr<Conversation> conversation, const TcpServiceOptions& options,
                       link::ErrorLog& errors)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      conversation_(std::move(conversation)),
      options_(options),
      errors_(errors) {}

void TcpSession::start() {
  if (options_.idle.count() > 0) expire_after(options_.idle);
  read();
}

void TcpSession::close() {
  Failure ignored;
  timer_.cancel();
  socket_.close(ignored);
}

/// Replaces an earlier limit.
void TcpSession::expire_after(std::chrono::milliseconds wait) {
  timer_.expires_after(wait);
  timer_.async_wait([waiting = weak_from_this()](Failure failure) {
    const auto self = waiting.lock();
    if (failure || !self) return;
    if (self->is_in_request_)
      self->errors_.report(self->options_.what, "a request was not complete in time");
    self->close();
  });
}

void TcpSession::read() {
  socket_.async_read_some(boost::asio::buffer(chunk_),
                          [self = shared_from_this()](Failure failure, std::size_t size) {
                            self->on_read(failure, size);
                          });
}

void TcpSession::on_read(Failure failure, std::size_t size) {
  if (failure) return close();
  if (ends_) return drain();  // what follows the last request is not needed
  if (!is_in_request_) {
    is_in_request_ = true;
    expire_after(options_.request);
  }
  pending_.append(chunk_.data(), size);
  converse();
}

void TcpSession::converse() {
  Step step = conversation_->receive(pending_);
  pending_.erase(0, step.consumed);
  if (!step.error.empty()) errors_.report(options_.what, step.error);
  if (!step.answer.empty()) return send(std::move(step));
  if (step.ends) return close();
  if (pending_.size() > kMaxPending) {
    errors_.report(options_.what, "a request above 64 KiB");
    return close();
  }
  read();
}

void TcpSession::send(Step step) {
  answer_ = std::move(step.answer);
  ends_ = step.ends;
  last_request_ = Clock::now();
  boost::asio::async_write(
      socket_, boost::asio::buffer(answer_),
      [self = shared_from_this()](Failure failure, std::size_t) { self->on_sent(failure); });
}

void TcpSession::on_sent(Failure failure) {
  if (failure) return close();
  is_in_request_ = false;
  if (ends_) {
    Failure ignored;
    socket_.shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    expire_after(kMaxDrain);
    return drain();
  }
  timer_.cancel();
  if (options_.idle.count() > 0) expire_after(options_.idle);
  if (pending_.empty()) return read();
  is_in_request_ = true;
  expire_after(options_.request);
  converse();
}

/// Reads until the client closes, because the system discards an answer whose connection is closed
/// with unread bytes.
void TcpSession::drain() {
  read();
}

}  // namespace glidar::control
