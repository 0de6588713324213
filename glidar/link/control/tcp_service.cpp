// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/tcp_service.hpp>

#include <glidar/link/control/tcp_session.hpp>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/steady_timer.hpp>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace glidar::control {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ServiceFailure = boost::system::error_code;

tcp::acceptor listen_at(asio::io_context& io, const link::Endpoint& at) {
  ServiceFailure failure;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(tcp::v4(), at.host, std::to_string(at.port), failure);
  if (failure || found.empty()) link::fail_at(at, EINVAL, "find the address");
  tcp::acceptor acceptor(io);
  acceptor.open(tcp::v4(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(found.begin()->endpoint(), failure);
  if (!failure) acceptor.listen(asio::socket_base::max_listen_connections, failure);
  if (failure) link::fail_at(at, failure.value(), "listen");
  return acceptor;
}

}  // namespace

struct TcpService::Impl {
  Impl(const TcpServiceOptions& given, ConversationFactory factory, link::ErrorLog& log)
      : options(given),
        make(std::move(factory)),
        errors(log),
        acceptor(listen_at(io, options.at)),
        timer(io),
        port(acceptor.local_endpoint().port()) {}

  void accept();
  void begin(tcp::socket&& socket);
  void pause();
  void make_room();
  void run();

  TcpServiceOptions options;
  ConversationFactory make;
  link::ErrorLog& errors;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer timer;
  std::uint16_t port;
  std::vector<std::weak_ptr<TcpSession>> sessions;
  std::thread thread;
};

void TcpService::Impl::accept() {
  acceptor.async_accept([this](ServiceFailure failure, tcp::socket socket) {
    if (failure == asio::error::operation_aborted) return;
    if (failure) {
      errors.report(options.what, failure.message());
      return pause();
    }
    accept();
    begin(std::move(socket));
  });
}

void TcpService::Impl::begin(tcp::socket&& socket) {
  ServiceFailure failure;
  const tcp::endpoint client = socket.remote_endpoint(failure);
  if (failure) return;  // it has gone already
  socket.set_option(tcp::no_delay(true), failure);
  make_room();
  const auto session = std::make_shared<TcpSession>(
      std::move(socket), make(client.address().to_string()), options, errors);
  sessions.push_back(session);
  session->start();
}

/// Without file descriptors, accepting fails at once, again and again.
void TcpService::Impl::pause() {
  constexpr std::chrono::milliseconds kPause{100};
  timer.expires_after(kPause);
  timer.async_wait([this](ServiceFailure failure) {
    if (!failure) accept();
  });
}

void TcpService::Impl::make_room() {
  std::erase_if(sessions, [](const std::weak_ptr<TcpSession>& one) {
    const auto session = one.lock();
    return session == nullptr || !session->is_open();
  });
  if (sessions.size() < std::max<std::size_t>(options.connections, 1)) return;
  const auto oldest =
      std::min_element(sessions.begin(), sessions.end(), [](const auto& a, const auto& b) {
        const auto first = a.lock();
        const auto second = b.lock();
        return first && second && first->last_request() < second->last_request();
      });
  if (const auto session = oldest->lock()) session->close();
  sessions.erase(oldest);
  errors.report(options.what, "closed the connection that was silent for longest");
}

/// An exception of a session ends that session; the others continue.
void TcpService::Impl::run() {
  for (;;) {
    try {
      io.run();
      return;
    } catch (const std::exception& error) {
      errors.report(options.what, error.what());
    }
  }
}

TcpService::TcpService(const TcpServiceOptions& options, ConversationFactory make,
                       link::ErrorLog& errors)
    : impl_(std::make_unique<Impl>(options, std::move(make), errors)) {
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->run(); });
}

bool has_tcp_services() {
  return true;
}

TcpService::~TcpService() {
  impl_->io.stop();
  impl_->thread.join();
}

std::uint16_t TcpService::port() const {
  return impl_->port;
}

}  // namespace glidar::control
