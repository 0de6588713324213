// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/server.hpp>

#include <glidar/core/text.hpp>
#include <glidar/link/foxglove/hub.hpp>
#include <glidar/link/foxglove/protocol.hpp>
#include <glidar/link/http_parser.hpp>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>

namespace glidar::foxglove {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Failure = boost::system::error_code;

/// Passes answers from any thread to the server's thread, until the server ends.
class ReplyGate {
 public:
  explicit ReplyGate(asio::io_context& io) : io_(&io) {}
  /// Runs the work in the server's thread, unless the server has ended.
  void post(std::function<void()> work);
  /// From now on, post() does nothing.
  void close();

 private:
  std::mutex mutex_;
  asio::io_context* io_;
};

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

void ReplyGate::post(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  if (io_ != nullptr) asio::post(*io_, std::move(work));
}

void ReplyGate::close() {
  const std::lock_guard lock(mutex_);
  io_ = nullptr;
}

/// What the caller receives to answer a pick. `answer` runs once in the server's thread, without a
/// text if the reply was destroyed without a call.
PickReply make_pick_reply(const std::shared_ptr<ReplyGate>& gate, Answer answer) {
  const auto pending = std::make_shared<PendingReply>(gate, std::move(answer));
  return [pending](const std::string& text) { pending->reply(text); };
}

/// A new connection: answers one HTTP request, or becomes a ClientSession. Keeps itself alive while
/// an operation is in progress.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket&& socket, Hub& hub, std::shared_ptr<ReplyGate> gate);
  void start();
  /// Makes room for others.
  void close();
  /// Whether its request is not complete yet.
  [[nodiscard]] bool is_waiting() const { return is_waiting_; }

 private:
  using Request = link::HttpParser::value_type;

  void on_read(Failure failure);
  void upgrade(const Request& request);
  void answer(const Request& request);
  void explain(const Pick& pick);
  void finish(const std::optional<std::string>& text);
  void respond(const HttpReply& reply);
  void on_written();

  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer received_;
  link::HttpParser parser_;
  http::response<http::string_body> response_;
  Hub& hub_;
  std::shared_ptr<ReplyGate> gate_;
  bool is_waiting_ = true;
  bool is_head_ = false;
};

template <class Message>
std::string_view header(const Message& message, http::field name) {
  return link::text_view(message[name]);
}

HttpReply plain_reply(int status, const std::string& text) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = text + "\n"};
}

HttpReply json_reply(int status, const char* member, const std::string& text) {
  return {.status = status, .content_type = "application/json", .body = answer_text(member, text)};
}

HttpSession::HttpSession(tcp::socket&& socket, Hub& hub, std::shared_ptr<ReplyGate> gate)
    : stream_(std::move(socket)), hub_(hub), gate_(std::move(gate)) {
  link::apply_limits(hub_.guard().limits(), parser_);
}

void HttpSession::start() {
  stream_.expires_after(hub_.options().limits.http.request);
  http::async_read(
      stream_, received_, parser_,
      [self = shared_from_this()](Failure failure, std::size_t) { self->on_read(failure); });
}

void HttpSession::close() {
  is_waiting_ = false;
  stream_.close();
}

void HttpSession::on_read(Failure failure) {
  is_waiting_ = false;
  if (failure == http::error::body_limit || failure == http::error::header_limit) {
    return respond(plain_reply(413, "the request is too large"));
  }
  if (failure) {
    const bool is_http =
        failure.category() == http::make_error_code(http::error::bad_method).category();
    if (is_http && failure != http::error::end_of_stream) {
      hub_.errors().report("HTTP request", failure.message());
    }
    return;
  }
  if (boost::beast::websocket::is_upgrade(parser_.get())) {
    upgrade(parser_.get());
  } else {
    answer(parser_.get());
  }
}

void HttpSession::upgrade(const Request& request) {
  const link::HttpHead head = link::head_of(request);
  if (const auto refusal = hub_.guard().refuse(head)) {
    const std::string text(refusal->text);
    hub_.errors().report("Foxglove client", "refused with status " +
                                                std::to_string(refusal->status) + ", " + text +
                                                "; origin '" + excerpt(head.origin) + "', host '" +
                                                excerpt(head.host) + "'");
    return respond(plain_reply(refusal->status, text));
  }
  const std::string_view protocol =
      choose_subprotocol(header(request, http::field::sec_websocket_protocol));
  if (protocol.empty()) return respond(plain_reply(400, "the subprotocol is foxglove.sdk.v1"));
  const auto client = std::make_shared<ClientSession>(std::move(stream_), hub_);
  if (hub_.join(client)) return client->start(request, protocol);
  hub_.errors().report("Foxglove client", "refused; there are too many");
}

void HttpSession::answer(const Request& request) {
  const ServerOptions& options = hub_.options();
  is_head_ = request.method() == http::verb::head;
  const HttpAction action =
      route({.head = link::head_of(request),
             .target = link::text_view(request.target()),
             .content_type = header(request, http::field::content_type),
             .body = request.body()},
            hub_.guard(),
            {.has_playback = bool(options.on_playback), .has_picks = bool(options.on_pick)});
  if (const auto* reply = std::get_if<HttpReply>(&action)) {
    respond(*reply);
  } else if (const auto* command = std::get_if<PlaybackCommand>(&action)) {
    options.on_playback(*command);
    respond(json_reply(200, "text", "done"));
  } else {
    explain(std::get<Pick>(action));
  }
}

void HttpSession::explain(const Pick& pick) {
  if (hub_.picking.size() >= hub_.options().limits.picks) {
    return respond(json_reply(503, "error", "other points are being explained"));
  }
  stream_.expires_never();
  const auto self = shared_from_this();
  hub_.picking.insert(self);  // the reply may outlive the server, and holds no session
  hub_.options().on_pick(
      pick,
      make_pick_reply(gate_, [waiting = weak_from_this()](const std::optional<std::string>& text) {
        if (const auto session = waiting.lock()) session->finish(text);
      }));
}

void HttpSession::finish(const std::optional<std::string>& text) {
  hub_.picking.erase(shared_from_this());
  respond(text ? json_reply(200, "text", *text)
               : json_reply(404, "error", "there is no explanation of this point"));
}

void HttpSession::respond(const HttpReply& reply) {
  response_.version(11);
  response_.result(static_cast<unsigned>(reply.status));
  response_.keep_alive(false);
  response_.set(http::field::content_type, reply.content_type);
  response_.set(http::field::cache_control, "no-store");
  response_.set(
      "Content-Security-Policy",
      boost::beast::string_view(kContentSecurityPolicy.data(), kContentSecurityPolicy.size()));
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("Referrer-Policy", "no-referrer");
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.content_length(reply.body.size());
  if (!is_head_) response_.body() = reply.body;
  stream_.expires_after(hub_.options().limits.http.request);
  http::async_write(stream_, response_,
                    [self = shared_from_this()](Failure, std::size_t) { self->on_written(); });
}

void HttpSession::on_written() {
  Failure ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

tcp::endpoint resolve(asio::io_context& io, const link::Endpoint& at) {
  if (at.host == "*") return {tcp::v4(), at.port};
  Failure failure;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(at.host, std::to_string(at.port), failure);
  if (failure || found.empty()) link::fail_at(at, EINVAL, "find the address");
  return found.begin()->endpoint();
}

tcp::acceptor listen(asio::io_context& io, const link::Endpoint& at) {
  const tcp::endpoint endpoint = resolve(io, at);
  tcp::acceptor acceptor(io);
  Failure failure;
  acceptor.open(endpoint.protocol(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(endpoint, failure);
  if (!failure) acceptor.listen(asio::socket_base::max_listen_connections, failure);
  if (failure) link::fail_at(at, failure.value(), "listen");
  return acceptor;
}

/// Accepts connections. When too many have not sent a request, the oldest one is closed.
class Acceptor {
 public:
  /// Throws Error if it cannot listen at the endpoint.
  Acceptor(Hub& hub, std::shared_ptr<ReplyGate> gate);
  void start() { accept(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void accept();
  void begin(tcp::socket&& socket);
  void pause();
  void make_room();

  Hub& hub_;
  std::shared_ptr<ReplyGate> gate_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  std::uint16_t port_ = 0;
  std::deque<std::weak_ptr<HttpSession>> waiting_;  ///< oldest first
};

Acceptor::Acceptor(Hub& hub, std::shared_ptr<ReplyGate> gate)
    : hub_(hub),
      gate_(std::move(gate)),
      acceptor_(listen(hub.io(), hub.options().at)),
      timer_(hub.io()),
      port_(acceptor_.local_endpoint().port()) {}

void Acceptor::accept() {
  acceptor_.async_accept([this](Failure failure, tcp::socket socket) {
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
  Failure ignored;
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
  timer_.async_wait([this](Failure failure) {
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

link::Payload payload_of(const std::string& text) {
  link::Payload payload{.memory = std::make_shared<std::byte[]>(text.size()),  // NOLINT
                        .size = text.size()};
  std::memcpy(payload.memory.get(), text.data(), text.size());
  return payload;
}

}  // namespace

struct FoxgloveServer::Impl {
  Impl(const ServerOptions& server_options, link::ErrorLog& log)
      : options(server_options),
        hub(io, options, log),
        gate(std::make_shared<ReplyGate>(io)),
        acceptor(hub, gate) {}

  /// An exception of a session ends that session; the others continue.
  void run() {
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::exception& error) {
        hub.errors().report("Foxglove server", error.what());
      }
    }
  }

  ServerOptions options;
  asio::io_context io{1};
  Hub hub;
  std::shared_ptr<ReplyGate> gate;
  Acceptor acceptor;
  ChannelId playback = 0;
  std::thread thread;
};

FoxgloveServer::FoxgloveServer(const ServerOptions& options, link::ErrorLog& errors)
    : impl_(std::make_unique<Impl>(options, errors)) {
  if (options.on_playback) {
    impl_->playback = add_channel({.topic = std::string(kPlaybackTopic),
                                   .schema_name = "glidar.Playback",
                                   .schema = std::string(playback_schema()),
                                   .encoding = "json",
                                   .schema_encoding = "jsonschema"});
    set_playback({});
  }
  impl_->acceptor.start();
  impl_->thread = std::thread([this] { impl_->run(); });
}

FoxgloveServer::~FoxgloveServer() {
  impl_->gate->close();
  impl_->io.stop();
  impl_->thread.join();
}

ChannelId FoxgloveServer::add_channel(const ChannelOptions& options) {
  return impl_->hub.add_channel(options);
}

void FoxgloveServer::publish(ChannelId channel, std::uint64_t time_ns, link::Payload message) {
  if (channel == Hub::kTime) return;
  impl_->hub.publish({.channel = channel, .time_ns = time_ns, .payload = std::move(message)});
}

void FoxgloveServer::publish_time(std::uint64_t time_ns) {
  impl_->hub.publish({.channel = Hub::kTime, .time_ns = time_ns});
}

void FoxgloveServer::set_playback(const PlaybackState& state) {
  if (impl_->playback == 0) return;
  publish(impl_->playback, state.time_ns, payload_of(playback_state_text(state)));
}

bool FoxgloveServer::is_subscribed(ChannelId channel) const {
  return impl_->hub.is_subscribed(channel);
}

std::uint16_t FoxgloveServer::port() const {
  return impl_->acceptor.port();
}

ServerCounts FoxgloveServer::counts() const {
  return impl_->hub.counts();
}

bool has_foxglove_server() {
  return true;
}

}  // namespace glidar::foxglove
