// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/link: requests as Boost.Beast parses them, for HttpGuard.

#include <glidar/link/http_guard.hpp>

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace glidar::link {

using HttpParser = boost::beast::http::request_parser<boost::beast::http::string_body>;

inline std::string_view text_view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

/// Before the first byte is parsed.
inline void apply_limits(const HttpLimits& limits, HttpParser& parser) {
  parser.header_limit(limits.header_bytes);
  parser.body_limit(limits.body_bytes);
}

/// Refers to the request.
inline HttpHead head_of(const HttpParser::value_type& request) {
  namespace http = boost::beast::http;
  constexpr std::array kOnce = {http::field::host, http::field::origin, http::field::referer,
                                http::field::content_length};
  const std::string_view site = text_view(request["Sec-Fetch-Site"]);
  return {.method = text_view(request.method_string()),
          .host = text_view(request[http::field::host]),
          .origin = text_view(request[http::field::origin]),
          .referer = text_view(request[http::field::referer]),
          .fetch_site = site,
          .is_ambiguous = std::any_of(kOnce.begin(), kOnce.end(),
                                      [&](http::field field) { return request.count(field) > 1; })};
}

}  // namespace glidar::link
