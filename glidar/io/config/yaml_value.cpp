// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/yaml_value.hpp>

#include <glidar/io/config/yaml_reader.hpp>

#include <algorithm>
#include <string_view>

namespace glidar {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // positions do not count it

/// The end of a text on one line that begins at `begin`; npos: it is none.
std::size_t end_of_text(std::string_view content, std::size_t begin, const std::string& text) {
  const std::string_view rest = content.substr(std::min(begin, content.size()));
  const char quote = rest.empty() ? '\0' : rest[0];
  if (quote != '\'' && quote != '"') {
    return !text.empty() && rest.starts_with(text) ? begin + text.size() : std::string_view::npos;
  }
  for (std::size_t i = 1; i < rest.size() && rest[i] != '\n'; ++i) {
    const bool is_escape = quote == '"' ? rest[i] == '\\' : rest.substr(i).starts_with("''");
    if (is_escape) {
      ++i;
    } else if (rest[i] == quote) {
      return begin + i + 1;
    }
  }
  return std::string_view::npos;
}

}  // namespace

YamlValue::YamlValue(const std::string& file, const std::string& content)
    : field_(std::make_shared<YamlField>(read_yaml_content(file, content))),
      content_(std::make_shared<std::string>(content)) {}

YamlValue::YamlValue(YamlField field, std::shared_ptr<const std::string> content)
    : field_(std::make_shared<YamlField>(std::move(field))), content_(std::move(content)) {}

YamlValue::Kind YamlValue::kind() const {
  if (field_->node.IsMap()) return Kind::map;
  if (field_->node.IsSequence()) return Kind::list;
  return field_->node.IsScalar() ? Kind::text : Kind::none;
}

const std::string& YamlValue::file() const {
  return field_->file;
}

const std::string& YamlValue::path() const {
  return field_->path;
}

std::string YamlValue::where() const {
  return glidar::where(*field_);
}

std::string YamlValue::description() const {
  return content_text(*field_);
}

std::string YamlValue::scalar() const {
  return field_->node.IsScalar() ? field_->node.Scalar() : "";
}

bool YamlValue::is_number() const {
  return glidar::is_number(*field_);
}

std::size_t YamlValue::position() const {
  const std::size_t mark = content_->starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  return mark + static_cast<std::size_t>(std::max(field_->mark.pos, 0));
}

bool YamlValue::has_anchor_alias_or_tag() const {
  const std::string_view rest =
      std::string_view(*content_).substr(std::min(position(), content_->size()));
  return rest.starts_with('&') || rest.starts_with('*') || rest.starts_with('!');
}

void YamlValue::reject(const std::string& found, const std::string& allowed,
                       const std::string& remedy) const {
  glidar::reject(*field_, found, allowed, remedy);
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::entries() const {
  std::vector<std::pair<std::string, YamlValue>> all;
  for (auto& [key, value] : glidar::entries(*field_)) {
    all.emplace_back(std::move(key), YamlValue(std::move(value), content_));
  }
  return all;
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::entries(
    const std::vector<std::string>& known) const {
  require_map(*field_, known);
  return entries();
}

std::vector<YamlValue> YamlValue::items() const {
  std::vector<YamlValue> all;
  for (YamlField& item : glidar::items(*field_))
    all.push_back(YamlValue(std::move(item), content_));
  return all;
}

double YamlValue::number(const NumberRule& rule) const {
  return glidar::number(*field_, rule);
}

bool YamlValue::boolean() const {
  return glidar::boolean(*field_);
}

std::string YamlValue::text() const {
  std::string found = glidar::text(*field_);
  if (found.find('\0') != std::string::npos) {
    reject("a text with a zero byte", "a text without", "");
  }
  return found;
}

std::size_t YamlValue::one_of(const std::vector<std::string>& words) const {
  return glidar::one_of(*field_, words);
}

std::string with_values(const std::string& content,
                        std::vector<std::pair<YamlValue, std::string>> replaced) {
  std::sort(replaced.begin(), replaced.end(),
            [](const auto& a, const auto& b) { return a.first.position() > b.first.position(); });
  std::string changed = content;
  for (const auto& [value, text] : replaced) {
    if (value.has_anchor_alias_or_tag()) {
      value.reject("an anchor, an alias or a tag", "a plain value", "write it out");
    }
    const std::size_t begin = value.position();
    const std::size_t end = value.kind() == YamlValue::Kind::text
                                ? end_of_text(content, begin, value.scalar())
                                : std::string::npos;
    if (end == std::string::npos) {
      value.reject(value.description(), "a number or a text on one line, which can be replaced",
                   "write it in one line");
    }
    changed.replace(begin, end - begin, text);
  }
  return changed;
}

}  // namespace glidar
