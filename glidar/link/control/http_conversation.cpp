// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/http_conversation.hpp>

#include <glidar/link/http_parser.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/status.hpp>

#include <utility>

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

}  // namespace glidar::control
