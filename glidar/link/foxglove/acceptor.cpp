// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/acceptor.hpp>

#include <glidar/link/foxglove/http_session.hpp>

#include <boost/asio/socket_base.hpp>

#include <cerrno>
#include <chrono>
#include <utility>

namespace glidar::foxglove {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

tcp::endpoint resolve(asio::io_context& io, const link::Endpoint& at) {
  if (at.host == "*") return {tcp::v4(), at.port};
  ErrorCode failure;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(at.host, std::to_string(at.port), failure);
  if (failure || found.empty()) link::fail_at(at, EINVAL, "find the address");
  return found.begin()->endpoint();
}

tcp::acceptor listen(asio::io_context& io, const link::Endpoint& at) {
  const tcp::endpoint endpoint = resolve(io, at);
  tcp::acceptor acceptor(io);
  ErrorCode failure;
  acceptor.open(endpoint.protocol(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(endpoint, failure);
  if (!failure) acceptor.listen(asio::socket_base::max_listen_connections, failure);
  if (failure) link::fail_at(at, failure.value(), "listen");
  return acceptor;
}

}  // namespace

Acceptor::Acceptor(Hub& hub, std::shared_ptr<ReplyGate> gate)
    : hub_(hub),
      gate_(std::move(gate)),
      acceptor_(listen(hub.io(), hub.options().at)),
      timer_(hub.io()),
      port_(acceptor_.local_endpoint().port()) {}

void Acceptor::accept() {
  acceptor_.async_accept([this](ErrorCode failure, tcp::socket socket) {
    if (failure == asio::error::operation_aborted) return;
    if (failure) {
      hub_.errors().report("accepting Foxglove clients", failure.message());
      return pause();
    }
    begin(std::move(socket));
    accept();
  });
}

void Acceptor::begin(tcp::socket&& socket) {
  hub_.count_connection();
  ErrorCode ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  make_room();
  const auto session = std::make_shared<HttpSession>(std::move(socket), hub_, gate_);
  waiting_.push_back(session);
  session->start();
}

/// Without file descriptors, accepting fails at once, again and again.
void Acceptor::pause() {
  constexpr std::chrono::milliseconds kPause{100};
  timer_.expires_after(kPause);
  timer_.async_wait([this](ErrorCode failure) {
    if (!failure) accept();
  });
}

void Acceptor::make_room() {
  std::erase_if(waiting_, [](const std::weak_ptr<HttpSession>& one) {
    const auto session = one.lock();
    return session == nullptr || !session->is_waiting();
  });
  while (waiting_.size() >= std::max<std::size_t>(hub_.options().limits.http.connections, 1)) {
    if (const auto oldest = waiting_.front().lock()) oldest->close();
    waiting_.pop_front();
    hub_.errors().report("Foxglove connection", "closed the oldest one without a request");
  }
}

}  // namespace glidar::foxglove
