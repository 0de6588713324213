// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/tcp_service.hpp>

#include <glidar/link/control/conversation.hpp>
#include <glidar/link/http_parser.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/status.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace glidar::control {
namespace {

namespace http = boost::beast::http;

std::string http_text(const ApiReply& reply, bool has_body) {
  const std::string reason(link::text_view(
      http::obsolete_reason(http::int_to_status(static_cast<unsigned>(reply.status)))));
  return "HTTP/1.1 " + std::to_string(reply.status) + " " + reason +
         "\r\nContent-Type: application/json\r\nCache-Control: no-store\r\n"
         "X-Content-Type-Options: nosniff\r\nConnection: close\r\nContent-Length: " +
         std::to_string(reply.body.size()) + "\r\n\r\n" + (has_body ? reply.body : "");
}

Step final_step(std::size_t consumed, const ApiReply& reply, bool has_body) {
  return {.consumed = consumed, .answer = http_text(reply, has_body), .ends = true};
}

Step malformed_step(std::size_t consumed, int status, const std::string& what) {
  Step step = final_step(consumed, {status, "{\"error\":{\"detail\":\"" + what + "\"}}"}, true);
  step.error = what;
  return step;
}

class HttpConversation final : public Conversation {
 public:
  HttpConversation(OusterApi& api, link::HttpGuard& guard, std::string client)
      : api_(api), guard_(guard), client_(std::move(client)) {
    link::apply_limits(guard.limits(), parser_);
    parser_.eager(true);
  }

  Step receive(std::string_view bytes) override {
    boost::beast::error_code failure;
    const std::size_t consumed =
        parser_.put(boost::asio::buffer(bytes.data(), bytes.size()), failure);
    if (failure == http::error::need_more) return {.consumed = consumed};
    if (failure == http::error::header_limit || failure == http::error::body_limit)
      return malformed_step(consumed, 413, "the request is too large");
    if (failure) return malformed_step(consumed, 400, "the request is no HTTP");
    if (!parser_.is_done()) return {.consumed = consumed};
    return answer(consumed);
  }

 private:
  Step answer(std::size_t consumed) {
    const auto& request = parser_.get();
    const bool has_body = request.method() != http::verb::head;
    const link::HttpHead head = link::head_of(request);
    if (const auto refusal = guard_.refuse(head)) {
      Step step = final_step(consumed, refusal_reply(*refusal), has_body);
      step.error = "refused a request: " + std::string(refusal->text);
      return step;
    }
    return final_step(consumed,
                      api_.answer({.method = head.method,
                                   .target = link::text_view(request.target()),
                                   .body = request.body(),
                                   .client = client_,
                                   .no_change = guard_.refuse_change(head)}),
                      has_body);
  }

  OusterApi& api_;
  link::HttpGuard& guard_;
  std::string client_;
  link::HttpParser parser_;
};

}  // namespace

std::unique_ptr<Conversation> make_http_conversation(OusterApi& api, link::HttpGuard& guard,
                                                     const std::string& client) {
  return std::make_unique<HttpConversation>(api, guard, client);
}

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Failure = boost::system::error_code;

/// One connection. Keeps itself alive while an operation is in progress.
class TcpSession : public std::enable_shared_from_this<TcpSession> {
 public:
  using Clock = std::chrono::steady_clock;

  TcpSession(tcp::socket&& socket, std::unique_ptr<Conversation> conversation,
             const TcpServiceOptions& options, link::ErrorLog& errors);
  void start();
  void close();
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  /// When it began or sent its last complete request.
  [[nodiscard]] Clock::time_point last_request() const { return last_request_; }

 private:
  void read();
  void on_read(Failure failure, std::size_t size);
  void converse();
  void send(Step step);
  void on_sent(Failure failure);
  void drain();
  void expire_after(std::chrono::milliseconds wait);

  tcp::socket socket_;
  asio::steady_timer timer_;
  std::unique_ptr<Conversation> conversation_;
  const TcpServiceOptions& options_;
  link::ErrorLog& errors_;
  std::array<char, 4096> chunk_{};
  std::string pending_;  ///< received, not consumed
  std::string answer_;
  bool is_in_request_ = false;
  bool ends_ = false;
  Clock::time_point last_request_ = Clock::now();
};

constexpr std::size_t kMaxPending = std::size_t{64} << 10U;
constexpr std::chrono::milliseconds kMaxDrain{2'000};

TcpSession::TcpSession(tcp::socket&& socket, std::unique_ptr<Conversation> conversation,
                       const TcpServiceOptions& options, link::ErrorLog& errors)
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
  socket_.async_read_some(asio::buffer(chunk_),
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
  asio::async_write(
      socket_, asio::buffer(answer_),
      [self = shared_from_this()](Failure failure, std::size_t) { self->on_sent(failure); });
}

void TcpSession::on_sent(Failure failure) {
  if (failure) return close();
  is_in_request_ = false;
  if (ends_) {
    Failure ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
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

tcp::acceptor listen_at(asio::io_context& io, const link::Endpoint& at) {
  Failure failure;
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
  acceptor.async_accept([this](Failure failure, tcp::socket socket) {
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
  Failure failure;
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
  timer.async_wait([this](Failure failure) {
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
