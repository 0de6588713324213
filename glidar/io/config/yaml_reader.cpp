// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/yaml_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/files/input_file.hpp>

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kMaxValues = 1'000'000;
constexpr std::size_t kMaxDocuments = 100;  // yaml-cpp reads endless ones after some invalid bytes

/// Counts values as the parser meets them, without keeping any.
class Counter : public YAML::EventHandler {
 public:
  Counter(const std::string& file, std::size_t bytes) : file_(file), budget_(bytes) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > kMaxDocuments) fail(mark, "more than 100 YAML documents", "one", "");
    sizes_.clear();
    open_.clear();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_plain(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    add_plain(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const std::size_t size = anchor < sizes_.size() ? sizes_[anchor] : 0;
    if (size == 0) fail(mark, "an alias of the value that it is in", "aliases of other values", "");
    add(mark, size);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  void add(const YAML::Mark& mark, std::size_t count) {
    if (!budget_.try_take(Budget::values, count)) {
      fail(mark,
           "more than " + std::to_string(budget_.limit(Budget::values)) +
               " values with aliases written out",
           "1000000 values and 2 more for each byte of the file",
           "use fewer aliases, or smaller ones");
    }
    written_out_ += count;
  }
  void build(const YAML::Mark& mark) {
    if (++built_ > kMaxValues) fail(mark, "more than 1000000 values", "fewer", "use aliases");
    add(mark, 1);
  }
  void add_plain(const YAML::Mark& mark, YAML::anchor_t anchor) {
    build(mark);
    keep(anchor, 1);
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.emplace_back(anchor, written_out_);
    build(mark);
    keep(anchor, 0);
  }
  void end() {
    const auto [anchor, before] = open_.back();
    open_.pop_back();
    keep(anchor, written_out_ - before);
  }
  /// The size of what has this anchor; 0: it is not at its end yet.
  void keep(YAML::anchor_t anchor, std::size_t size) {
    if (anchor == 0) return;
    if (sizes_.size() <= anchor) sizes_.resize(anchor + 1);
    sizes_[anchor] = size;
  }
  [[noreturn]] void fail(const YAML::Mark& mark, std::string found, std::string allowed,
                         std::string remedy) const {
    const std::string where =
        file_ + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
    throw Error({where, std::move(found), std::move(allowed), std::move(remedy)});
  }

  const std::string& file_;
  InputBudget budget_;
  std::size_t documents_ = 0;
  std::size_t built_ = 0;
  std::size_t written_out_ = 0;
  std::vector<std::size_t> sizes_;                            ///< by anchor
  std::vector<std::pair<YAML::anchor_t, std::size_t>> open_;  ///< anchor, values before it
};

}  // namespace

void check_yaml_budget(const std::string& file, const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Counter counter(file, text.size());
  while (parser.HandleNextDocument(counter)) {
  }
}

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxYamlFile_mib =
    8;  // a list of a million aliases; see check_yaml_budget

std::string position(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return file;
  return file + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
}

std::string line_at(const std::string& content, int line) {
  std::istringstream lines(content);
  std::string text;
  for (int i = 0; i <= line; ++i) std::getline(lines, text);
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;  // columns do not count it
}

/// The advice for a syntax error: a tab in the indentation is the one most people cannot see.
std::string advice(const std::string& content, int line) {
  const std::string text = line_at(content, line);
  const std::string indentation = text.substr(0, text.find_first_not_of(" \t"));
  return indentation.find('\t') != std::string::npos ? "indent with spaces, not with tabs" : "";
}

/// The name of the alias at this place.
std::string alias_at(const std::string& content, const YAML::Mark& mark) {
  const std::string line = line_at(content, mark.line);
  const std::size_t star = line.find('*', static_cast<std::size_t>(mark.column));
  if (star == std::string::npos) return "";
  const std::size_t end = std::min(line.find_first_of(" \t\r,[]{}", star), line.size());
  return excerpt(line.substr(star + 1, end - star - 1));
}

/// yaml-cpp's own text for this error depends on its version.
[[noreturn]] void reject_alias(const std::string& where, const std::string& name) {
  throw Error({where, "the alias '*" + name + "' has no anchor", "",
               "write '&" + name + "' before the value that it repeats"});
}

std::vector<YAML::Node> parse_documents(const std::string& file, const std::string& content) {
  try {
    check_yaml_budget(file, content);
    return YAML::LoadAll(content);
  } catch (const YAML::DeepRecursion& error) {
    throw Error({position(file, error.mark), "nested too deeply", "a sensor or scene file"});
  } catch (const YAML::Exception& error) {
    if (error.msg.starts_with(YAML::ErrorMsg::UNKNOWN_ANCHOR)) {
      reject_alias(position(file, error.mark), alias_at(content, error.mark));
    }
    throw Error({position(file, error.mark), "not YAML: " + excerpt(error.msg), "",
                 advice(content, error.mark.line)});
  }
}

YamlField child(const YamlField& parent, std::string path, const YAML::Mark& before,
                const YAML::Node& node) {
  if (parent.mark.is_null()) return {parent.file, std::move(path), parent.mark, node};
  // yaml-cpp marks an absent value at the next token, which may be far below its key. Merged maps
  // have no place of their own.
  const bool has_place = !node.IsNull() && !node.Mark().is_null();
  return {parent.file, std::move(path), has_place ? node.Mark() : before, node};
}

std::string child_path(const YamlField& parent, const std::string& key) {
  return parent.path.empty() ? shown(key) : parent.path + "." + shown(key);
}

struct Entry {
  std::string key;
  YAML::Mark key_mark;
  YamlField value;
};

[[noreturn]] void reject_second(const YamlField& key) {
  reject(key, "the key is given twice", "each key once", "remove one of them");
}

std::vector<Entry> checked_entries(const YamlField& field) {
  if (!field.node.IsMap()) reject(field, content_text(field), "a map (key: value)");
  std::vector<Entry> result;
  std::set<std::string> seen;
  for (const auto& pair : field.node) {
    const YamlField key_field = child(field, field.path, field.mark, pair.first);
    if (!pair.first.IsScalar()) reject(key_field, "a key that is no word", "words as keys");
    const std::string& key = pair.first.Scalar();
    Entry entry{key, key_field.mark,
                child(field, child_path(field, key), pair.first.Mark(), pair.second)};
    if (!seen.insert(key).second) {
      entry.value.mark = entry.key_mark;
      reject_second(entry.value);
    }
    result.push_back(std::move(entry));
  }
  return result;
}

/// The number a plain scalar spells, if it does. Quoted scalars are texts.
std::optional<double> spelled_number(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;
  static const std::set<std::string> kInfinite = {".inf", ".Inf", ".INF", "+.inf", "-.inf"};
  static const std::set<std::string> kNaN = {".nan", ".NaN", ".NAN"};
  std::string_view word = node.Scalar();
  if (kInfinite.contains(node.Scalar())) return std::numeric_limits<double>::infinity();
  if (kNaN.contains(node.Scalar())) return std::numeric_limits<double>::quiet_NaN();
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (problem == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  return problem == std::errc{} ? std::optional(value) : std::nullopt;
}

/// The key in British English, as all keys are.
std::string british(std::string key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kSpellings = {
      {{"color", "colour"}, {"center", "centre"}, {"gray", "grey"}}};
  for (const auto& [american, spelled] : kSpellings) {
    const std::size_t at = key.find(american);
    if (at != std::string::npos) key.replace(at, american.size(), spelled);
  }
  return key;
}

/// The one map of a file; `name` is the file's.
YamlField root_of(const std::string& name, const std::vector<YAML::Node>& documents) {
  if (documents.empty() || documents[0].IsNull()) {
    throw Error({name, "the file is empty", "a YAML map (key: value)", "see docs/files.md"});
  }
  const YamlField root{name, "", documents[0].Mark(), documents[0]};
  if (documents.size() > 1) {
    const YAML::Mark& second = documents[1].Mark();
    throw Error({position(name, second), "a second document", "one document in a file",
                 "remove the line '---' before it"});
  }
  if (!root.node.IsMap())
    reject(root, content_text(root), "a map (key: value)", "see docs/files.md");
  return root;
}

}  // namespace

YamlField read_yaml(const fs::path& file) {
  const std::string content =
      read_text_file(file, {"a YAML file", kMaxYamlFile_mib,
                            "name models by their path, do not put them into the file"});
  return read_yaml_content(file, content);
}

YamlField read_yaml_content(const fs::path& file, const std::string& content) {
  require_utf8(file, content);
  return root_of(file.string(), parse_documents(file.string(), content));
}

YamlField read_yaml_text(const std::string& name, const std::string& text) {
  const YamlField root = root_of(name, parse_documents(name, text));
  return {name, "", YAML::Mark::null_mark(), root.node};
}

std::string where(const YamlField& field) {
  const std::string place = position(field.file, field.mark);
  return field.path.empty() ? place : place + ": " + field.path;
}

void reject(const YamlField& field, std::string found, std::string allowed, std::string remedy) {
  throw Error({where(field), std::move(found), std::move(allowed), std::move(remedy)});
}

void reject_at(const std::string& where, const Error& error) {
  const ErrorParts& parts = error.parts();
  const std::string place = parts.where.empty() ? "" : parts.where + ": ";
  throw Error({where, place + parts.found, parts.allowed, parts.remedy});
}

std::string content_text(const YamlField& field) {
  switch (field.node.Type()) {
    case YAML::NodeType::Null:
      return "no value";
    case YAML::NodeType::Map:
      return "a map";
    case YAML::NodeType::Sequence:
      return field.node.size() == 0 ? "an empty list"
                                    : "a list of " + std::to_string(field.node.size());
    default:
      break;
  }
  const std::string word = shown(field.node.Scalar());
  if (field.node.Tag() == "!") return "the text \"" + word + "\"";
  return spelled_number(field.node) ? word : "'" + word + "'";
}

bool is_number(const YamlField& field) {
  return spelled_number(field.node).has_value();
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  const std::string nearest = closest_match(word, known);
  return nearest.empty() ? "" : "did you mean '" + nearest + "'?";
}

void require_map(const YamlField& field, const std::vector<std::string>& known) {
  std::set<std::string> seen;
  for (const Entry& entry : checked_entries(field)) {
    YamlField at_key = entry.value;
    at_key.mark = entry.key_mark;
    const auto is_known = [&](const std::string& key) {
      return std::find(known.begin(), known.end(), key) != known.end();
    };
    const std::string key = is_known(entry.key) ? entry.key : british(entry.key);
    if (is_known(key)) {
      if (!seen.insert(key).second) reject_second(at_key);
      continue;
    }
    reject(at_key, "unknown key '" + shown(entry.key) + "'", comma_separated(known),
           suggestion(entry.key, known));
  }
}

std::vector<std::pair<std::string, YamlField>> entries(const YamlField& field) {
  std::vector<std::pair<std::string, YamlField>> result;
  for (Entry& entry : checked_entries(field)) {
    result.emplace_back(std::move(entry.key), std::move(entry.value));
  }
  return result;
}

/// The remedy for a text such as "1, 2, 3" instead of a list.
std::string as_list(const YamlField& field) {
  const bool is_text = field.node.IsScalar() && field.node.Scalar().find(',') != std::string::npos;
  return is_text ? "write [" + shown(field.node.Scalar()) + "]" : "";
}

std::vector<YamlField> items(const YamlField& field) {
  if (!field.node.IsSequence()) reject(field, content_text(field), "a list", as_list(field));
  std::vector<YamlField> result;
  for (const YAML::Node& item : field.node) {
    const std::string path = field.path + "[" + std::to_string(result.size()) + "]";
    result.push_back(child(field, path, field.mark, item));
  }
  return result;
}

std::optional<YamlField> find(const YamlField& map, std::string_view key) {
  if (!map.node.IsMap()) return std::nullopt;  // elements of a list have no keys
  for (const auto& pair : map.node) {
    if (!pair.first.IsScalar()) continue;
    if (pair.first.Scalar() != key && british(pair.first.Scalar()) != key) continue;
    return child(map, child_path(map, pair.first.Scalar()), pair.first.Mark(), pair.second);
  }
  return std::nullopt;
}

YamlField need(const YamlField& map, std::string_view key) {
  if (auto field = find(map, key)) return *std::move(field);
  const std::string word(key);
  reject(map, "the key '" + word + "' is missing", "", "add '" + word + ": ...'");
}

double number(const YamlField& field, const NumberRule& rule) {
  const std::optional<double> value = spelled_number(field.node);
  if (value && accepts(rule, *value)) return *value;
  const bool quoted = field.node.IsScalar() && field.node.Tag() == "!";
  reject(field, content_text(field), rule.allowed, quoted ? "remove the quotes" : "");
}

std::uint32_t whole_number(const YamlField& field, std::uint32_t min, std::uint32_t max) {
  const std::string allowed =
      "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  const double value = number(field, {min * 1.0, max * 1.0, false, allowed.c_str()});
  if (value != std::floor(value)) reject(field, content_text(field), allowed);
  return static_cast<std::uint32_t>(value);
}

bool boolean(const YamlField& field) {
  static const std::set<std::string> kYes = {"yes", "on"};
  static const std::set<std::string> kNo = {"no", "off"};
  const bool is_plain = field.node.IsScalar() && field.node.Tag() != "!";
  const std::string word = is_plain ? lower_case(field.node.Scalar()) : "";
  if (kYes.contains(word)) return true;
  return !kNo.contains(word) && one_of(field, {"false", "true"}) == 1;
}

std::string text(const YamlField& field) {
  if (!field.node.IsScalar() || field.node.Scalar().empty()) {
    reject(field, content_text(field), "a text that is not empty");
  }
  return field.node.Scalar();
}

std::string path_beside(const YamlField& field) {
  constexpr std::size_t kMaxPath_bytes = 4096;  // Linux' own limit
  const std::string named = text(field);
  if (named.size() > kMaxPath_bytes || named.find('\0') != std::string::npos)
    reject(field, content_text(field), "a path of at most 4096 bytes without zero bytes");
  fs::path path = fs::path(field.file).parent_path() / named;
  // Behind a link, "link/.." is the parent of what it points to: only the system knows.
  const bool goes_up = std::find(path.begin(), path.end(), "..") != path.end();
  return goes_up ? path.string() : path.lexically_normal().string();
}

std::size_t one_of(const YamlField& field, const std::vector<std::string>& words) {
  const std::string word = field.node.IsScalar() ? field.node.Scalar() : "";
  const auto at = std::find_if(words.begin(), words.end(), [&](const std::string& allowed) {
    return lower_case(allowed) == lower_case(word);
  });
  if (at == words.end()) {
    reject(field, content_text(field), comma_separated(words),
           word.empty() ? "" : suggestion(word, words));
  }
  return static_cast<std::size_t>(at - words.begin());
}

LookupTable table(const YamlField& field, const NumberRule& place, const NumberRule& value,
                  double unit) {
  constexpr std::size_t kMax = 4096;
  LookupTable pairs;
  for (const YamlField& entry : items(field)) {
    const std::vector<YamlField> pair = items(entry);
    if (pair.size() != 2) reject(entry, content_text(entry), "a pair of numbers");
    pairs.push_back({number(pair[0], place) * unit, number(pair[1], value)});
    if (pairs.size() > 1 && pairs.back()[0] <= pairs[pairs.size() - 2][0]) {
      reject(pair[0], content_text(pair[0]) + ", not above the one before", "numbers that rise");
    }
  }
  if (pairs.empty() || pairs.size() > kMax) {
    reject(field, std::to_string(pairs.size()) + " entries", "1 to 4096 pairs");
  }
  return pairs;
}

Eigen::Vector3d triple(const YamlField& field, const NumberRule& rule) {
  if (!field.node.IsSequence() || field.node.size() != 3) {
    reject(field, content_text(field), "a list of 3 numbers", as_list(field));
  }
  const std::vector<YamlField> parts = items(field);
  return {number(parts[0], rule), number(parts[1], rule), number(parts[2], rule)};
}

}  // namespace glidar
