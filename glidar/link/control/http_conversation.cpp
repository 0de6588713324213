// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/http_conversation.hpp>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>

#include <cstdint>
#include <utility>

namespace glidar::control {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr std::uint64_t kMaxBodyBytes = 16'384;

std::string_view text_view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

std::string http_text(const ApiReply& reply, bool has_body) {
  const std::string reason(
      text_view(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(reply.status)))));
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
  HttpConversation(OusterApi& api, std::string client) : api_(api), client_(std::move(client)) {
    parser_.header_limit(kMaxHeaderBytes);
    parser_.body_limit(kMaxBodyBytes);
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
    const std::string_view site = text_view(request["Sec-Fetch-Site"]);
    const bool is_page =
        request.find(http::field::origin) != request.end() || (!site.empty() && site != "none");
    if (is_page)
      return final_step(consumed, {403, R"({"error":{"detail":"web pages have no access"}})"},
                        has_body);
    return final_step(consumed,
                      api_.answer({text_view(request.method_string()), text_view(request.target()),
                                   request.body(), client_}),
                      has_body);
  }

  OusterApi& api_;
  std::string client_;
  http::request_parser<http::string_body> parser_;
};

}  // namespace

std::unique_ptr<Conversation> make_http_conversation(OusterApi& api, const std::string& client) {
  return std::make_unique<HttpConversation>(api, client);
}

}  // namespace glidar::control
