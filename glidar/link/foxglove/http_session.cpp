// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/foxglove/http_session.hpp>

#include <glidar/core/excerpt.hpp>
#include <glidar/link/foxglove/client_session.hpp>

#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include <utility>
#include <variant>

namespace glidar::foxglove {
namespace {

namespace http = boost::beast::http;

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

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket&& socket, Hub& hub,
                         std::shared_ptr<ReplyGate> gate)
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
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace glidar::foxglove
