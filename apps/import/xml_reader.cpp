// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/xml_reader.hpp>

#include <algorithm>

namespace glidar::import {
namespace {

constexpr std::size_t kKept = 65536;  ///< consumed bytes to keep before they are dropped
constexpr std::string_view kSpace = " \t\r\n";

std::string without_prefix(std::string_view name) {
  const std::size_t colon = name.find(':');
  return std::string(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

/// Removes white space in front.
void skip_space(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

/// Removes and returns the text before any of the characters.
std::string_view take_until(std::string_view& text, std::string_view characters) {
  const std::string_view taken = text.substr(0, text.find_first_of(characters));
  text.remove_prefix(taken.size());
  return taken;
}

/// name = "value", with either quote.
bool take_attribute(std::string_view& text, XmlEvent& event) {
  skip_space(text);
  const std::string_view name = take_until(text, " \t\r\n=");
  skip_space(text);
  if (name.empty() || !text.starts_with('=')) return false;
  text.remove_prefix(1);
  skip_space(text);
  if (!text.starts_with('"') && !text.starts_with('\'')) return false;
  const std::string_view quote = text.substr(0, 1);
  text.remove_prefix(1);
  const std::string_view value = take_until(text, quote);
  if (text.empty()) return false;
  text.remove_prefix(1);
  event.attributes.emplace(name, value);
  return true;
}

}  // namespace

/// Loads more; false at the end of the text.
bool XmlReader::load() {
  const std::string piece = source_();
  text_ += piece;
  return !piece.empty();
}

bool XmlReader::starts_with(std::string_view prefix) {
  while (text_.size() - at_ < prefix.size()) {
    if (!load()) return false;
  }
  return std::string_view(text_).substr(at_).starts_with(prefix);
}

/// The next position of the text from a position on; the end if there is none.
std::size_t XmlReader::find(std::string_view text, std::size_t from) {
  for (;;) {
    const std::size_t found = text_.find(text, from);
    if (found != std::string::npos) return found;
    if (text_.size() >= text.size()) from = std::max(from, text_.size() - text.size() + 1);
    if (!load()) return text_.size();
  }
}

/// The '>' of this tag; one between quotes belongs to a value.
std::size_t XmlReader::find_tag_end() {
  char quote = '\0';
  for (std::size_t i = at_;; ++i) {
    if (i == text_.size() && !load()) return i;
    const char c = text_[i];
    if (quote == '\0' && c == '>') return i;
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
  }
}

std::string XmlReader::take(std::size_t end) {
  std::string taken = text_.substr(at_, end - at_);
  at_ = end;
  return taken;
}

void XmlReader::skip_past(std::string_view text) {
  at_ = std::min(find(text, at_) + text.size(), text_.size());
}

/// <!DOCTYPE name [ declarations and comments ]>
void XmlReader::skip_doctype() {
  int open_brackets = 0;
  for (; at_ < text_.size() || load(); ++at_) {
    const char c = text_[at_];
    if (c == '>' && open_brackets == 0) break;
    if (c == '[') ++open_brackets;
    if (c == ']') --open_brackets;
    if (c == '<' && starts_with("<!--")) {
      skip_past("-->");
      --at_;
    } else if (c == '"' || c == '\'') {
      at_ = find(std::string_view(&c, 1), at_ + 1);
    }
  }
  at_ = std::min(at_ + 1, text_.size());
}

/// Skips markup other than tags and text.
bool XmlReader::skip_markup() {
  if (starts_with("<!--")) {
    at_ += 4;
    skip_past("-->");
  } else if (starts_with("<?")) {
    skip_past("?>");
  } else if (starts_with("<!") && !starts_with("<![CDATA[")) {
    skip_doctype();
  } else {
    return false;
  }
  return true;
}

XmlEvent XmlReader::text_event() {
  XmlEvent event{XmlEvent::Kind::text, "", {}, ""};
  if (starts_with("<![CDATA[")) {
    at_ += 9;
    event.text = take(find("]]>", at_));
    skip_past("]]>");
  } else {
    event.text = take(find("<", at_));
  }
  return event;
}

XmlEvent XmlReader::tag_event() {
  ++at_;
  const std::string tag = take(find_tag_end());
  at_ = std::min(at_ + 1, text_.size());
  std::string_view rest = tag;
  if (rest.starts_with('/')) {
    rest.remove_prefix(1);
    return {XmlEvent::Kind::end, without_prefix(take_until(rest, kSpace)), {}, ""};
  }
  const bool is_empty = rest.ends_with('/');
  if (is_empty) rest.remove_suffix(1);
  XmlEvent event{XmlEvent::Kind::start, without_prefix(take_until(rest, kSpace)), {}, ""};
  while (take_attribute(rest, event)) {
  }
  if (is_empty) empty_element_ = event.name;
  return event;
}

XmlEvent XmlReader::next() {
  if (!empty_element_.empty())
    return {XmlEvent::Kind::end, std::exchange(empty_element_, ""), {}, ""};
  for (;;) {
    if (at_ > kKept) {
      text_.erase(0, at_);
      at_ = 0;
    }
    if (at_ == text_.size() && !load()) return {};
    if (skip_markup()) continue;
    return text_[at_] == '<' && !starts_with("<![CDATA[") ? tag_event() : text_event();
  }
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

}  // namespace glidar::import
