// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/yaml_field_reader.hpp>

#include <glidar/core/text.hpp>
#include <glidar/io/config/provenance.hpp>
#include <glidar/io/model/builtin_models.hpp>

#include <algorithm>
#include <cmath>

namespace glidar {
namespace {

std::vector<std::string> words_of(std::span<const char* const> words) {
  return {words.begin(), words.end()};
}

/// A number in metres, seconds or radians. Rejects one that becomes zero or infinite in them.
double scaled(const YamlField& field, const NumberRule& rule, const FieldUnit& unit) {
  const double given = number(field, rule);
  const double value = given * unit.size;
  if ((value == 0.0) != (given == 0.0) || std::isfinite(value) != std::isfinite(given))
    reject(field, content_text(field), rule.allowed);
  return value;
}

/// The alternative that a map selects.
std::size_t read_type(const YamlField& map, const FieldInfo& field, std::span<const TypeInfo> types,
                      std::size_t chosen) {
  const std::string key = field.key;
  if (!map.node.IsMap()) reject(map, content_text(map), "a map with the key '" + key + "'");
  const auto type = field.is_required ? need(map, key) : find(map, key);
  if (!type) return chosen;
  std::vector<std::string> names;
  for (const TypeInfo& info : types) names.emplace_back(info.name);
  return one_of(*type, names);
}

/// Collects the keys of one map, so that a misspelt one is reported before a missing one.
class KeyCollector final : public FieldVisitor {
 public:
  explicit KeyCollector(const YamlField& map) : map_(map) {}

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] Mode mode() const override { return Mode::keys; }

  void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    keys_.emplace_back(field.key);
    describe(read_type(map_, field, types, chosen), *this);
  }
  [[nodiscard]] bool has(const char* key) const override { return find(map_, key).has_value(); }

 protected:
  void key(const FieldInfo& field) override { keys_.emplace_back(field.key); }

 private:
  const YamlField& map_;
  std::vector<std::string> keys_;
};

class FieldReader final : public FieldVisitor {
 public:
  explicit FieldReader(const YamlField& map) : map_(map) {}

  [[nodiscard]] Mode mode() const override { return Mode::read; }

  void number(const FieldInfo& field, const NumberRule& rule, double& value) override {
    if (const auto given = value_of(field)) value = scaled(*given, rule, field.unit);
  }
  void whole_number(const FieldInfo& field, const WholeRule& rule, std::uint32_t& value) override {
    if (const auto given = value_of(field))
      value = glidar::whole_number(*given, rule.min, rule.max);
  }
  void boolean(const FieldInfo& field, bool& value) override {
    if (const auto given = value_of(field)) value = glidar::boolean(*given);
  }
  void text(const FieldInfo& field, std::string& value) override {
    if (const auto given = value_of(field)) value = glidar::text(*given);
  }
  void texts(const FieldInfo& field, std::vector<std::string>& values) override {
    const auto given = value_of(field);
    if (!given) return;
    for (const YamlField& item : items(*given)) values.push_back(glidar::text(item));
  }
  void path(const FieldInfo& field, std::string& value) override {
    const auto given = value_of(field);
    if (!given) return;
    const bool is_builtin = glidar::text(*given).starts_with(kBuiltinPrefix);
    value = is_builtin ? given->node.Scalar() : path_beside(*given);
  }
  void paths(const FieldInfo& field, std::vector<std::string>& values) override {
    const auto given = value_of(field);
    if (!given) return;
    values.clear();
    if (!given->node.IsSequence()) return values.push_back(path_beside(*given));
    for (const YamlField& item : items(*given)) values.push_back(path_beside(item));
  }
  void word(const FieldInfo& field, std::span<const char* const> words,
            std::size_t& value) override {
    if (const auto given = value_of(field)) value = one_of(*given, words_of(words));
  }
  void words_or_count(const FieldInfo& field, std::span<const char* const> words,
                      std::uint32_t max_size, std::vector<std::string>& chosen,
                      std::uint32_t& count) override;
  void numbers(const FieldInfo& field, const NumberListRule& rule,
               std::vector<double>& values) override;
  void table(const FieldInfo& field, const NumberRule& position, const NumberRule& value,
             LookupTable& pairs) override {
    if (const auto given = value_of(field)) {
      pairs = glidar::table(*given, position, value, field.unit.size);
    }
  }
  bool vector(const FieldInfo& field, const NumberRule& rule, bool is_present,
              Eigen::Vector3d& value) override {
    const auto given = value_of(field);
    if (given) value = triple(*given, rule) * field.unit.size;
    return given.has_value() || is_present;
  }
  bool object(const FieldInfo& field, bool is_present, Describe describe) override {
    const auto given = value_of(field);
    if (given) read_fields(*given, describe);
    return given.has_value() || is_present;
  }
  void text_or_object(const FieldInfo& field, const char* allowed, std::string& value,
                      Describe describe) override;
  void list(const FieldInfo& field, const ListAccess& access, DescribeAt describe) override;
  void by_name(const FieldInfo& field, const NamesAccess& access, DescribeAt describe) override;
  void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    describe(read_type(map_, field, types, chosen), *this);
  }
  void provenance(const FieldInfo& field, bool is_map) override {
    if (has(field.key)) (is_map ? check_sources : check_unverified)(map_);
  }
  void at_most_one(const KeyChoice& choice) override;
  void excludes(const KeyExclusion& exclusion) override {
    if (!is_case(exclusion.when)) return;
    for (const char* key : exclusion.keys)
      if (has(key)) reject(key, exclusion.found, exclusion.allowed, exclusion.remedy);
  }
  void needs(const KeyNeed& need) override {
    if (!has(need.key) || has(need.needed)) return;
    reject(need.key, "given without '" + std::string(need.needed) + "'", need.allowed, need.remedy);
  }
  [[nodiscard]] bool has(const char* key) const override { return find(map_, key).has_value(); }
  [[nodiscard]] bool is_list(const char* key) const override {
    return place_of(key).node.IsSequence();
  }
  [[nodiscard]] std::string file() const override { return map_.file; }
  [[nodiscard]] std::string where(const char* key) const override {
    return glidar::where(place_of(key));
  }

 protected:
  [[nodiscard]] Error error_at(const ErrorParts& parts) const override;

 private:
  [[nodiscard]] std::optional<YamlField> value_of(const FieldInfo& field) const {
    return field.is_required ? need(map_, field.key) : find(map_, field.key);
  }
  [[nodiscard]] bool is_case(const KeyCase& one) const {
    const auto outer = one.key == nullptr ? std::nullopt : find(map_, one.key);
    const auto inner = outer && outer->node.IsMap() ? find(*outer, one.inner) : std::nullopt;
    return inner && inner->node.IsScalar() && inner->node.Scalar() == one.word;
  }
  [[nodiscard]] YamlField place_of(const std::string& key) const {
    return find(map_, key).value_or(map_);
  }

  const YamlField& map_;
};

void FieldReader::words_or_count(const FieldInfo& field, std::span<const char* const> words,
                                 std::uint32_t max_size, std::vector<std::string>& chosen,
                                 std::uint32_t& count) {
  const auto given = value_of(field);
  if (!given) return;
  chosen.clear();
  if (!given->node.IsSequence()) {
    const std::string word = given->node.IsScalar() ? given->node.Scalar() : "";
    if (word.empty() || word.find_first_not_of("+-.0123456789") != std::string::npos) {
      glidar::reject(*given, content_text(*given),
                     "a list of " + comma_separated(words_of(words)) +
                         "; or a whole number from 1 to " + std::to_string(max_size));
    }
    count = glidar::whole_number(*given, 1, max_size);
    return;
  }
  for (const YamlField& item : items(*given)) {
    chosen.emplace_back(words[one_of(item, words_of(words))]);
  }
  if (!chosen.empty() && chosen.size() <= max_size) return;
  glidar::reject(*given, std::to_string(chosen.size()) + " entries",
                 "1 to " + std::to_string(max_size) + " " + field.key);
}

/// Equal steps from a first to a last number.
std::vector<double> read_range(const YamlField& map, const NumberListRule& rule) {
  require_map(map, {"from", "to", "count"});
  const double from = number(need(map, "from"), rule.number);
  const double to = number(need(map, "to"), rule.number);
  const auto max_size = static_cast<std::uint32_t>(rule.max_size);
  const std::uint32_t count = whole_number(need(map, "count"), 2, max_size);
  std::vector<double> values;
  for (std::uint32_t i = 0; i < count; ++i) {
    values.push_back(from + (to - from) * i / (count - 1.0));
  }
  return values;
}

std::vector<double> read_list(const YamlField& field, const NumberListRule& rule) {
  const std::size_t size = field.node.IsSequence() ? field.node.size() : 0;
  if (size < rule.min_size || size > rule.max_size) {
    reject(field, content_text(field),
           rule.allowed.empty() ? "a list of " + std::to_string(rule.min_size) + " to " +
                                      std::to_string(rule.max_size) + " numbers"
                                : rule.allowed);
  }
  std::vector<double> values;
  for (const YamlField& item : items(field)) values.push_back(number(item, rule.number));
  return values;
}

void FieldReader::numbers(const FieldInfo& field, const NumberListRule& rule,
                          std::vector<double>& values) {
  const auto given = value_of(field);
  if (!given) return;
  if (rule.takes_one && given->node.IsScalar()) {
    values.assign(rule.min_size, glidar::number(*given, rule.number));
  } else if (rule.takes_range && given->node.IsMap()) {
    values = read_range(*given, rule);
  } else {
    values = read_list(*given, rule);
  }
  for (double& value : values) value *= field.unit.size;
}

void FieldReader::text_or_object(const FieldInfo& field, const char* allowed, std::string& value,
                                 Describe describe) {
  const auto given = value_of(field);
  if (!given) return;
  if (given->node.IsMap()) return read_fields(*given, describe);
  if (!given->node.IsScalar() || given->node.Scalar().empty()) {
    glidar::reject(*given, content_text(*given), allowed);
  }
  value = given->node.Scalar();
}

void FieldReader::list(const FieldInfo& field, const ListAccess& access, DescribeAt describe) {
  const auto given = value_of(field);
  if (!given) return;
  const std::vector<YamlField> all = items(*given);
  if (all.size() < access.min_size) {
    glidar::reject(*given, content_text(*given), access.allowed);
  }
  access.resize(std::min(all.size(), access.max_size));
  for (std::size_t i = 0; i < std::min(all.size(), access.max_size); ++i) {
    const auto body = [&](FieldVisitor& visitor) { describe(i, visitor); };
    read_fields(all[i], Describe(body));
  }
  if (all.size() > access.max_size) glidar::reject(*given, content_text(*given), access.allowed);
}

void FieldReader::by_name(const FieldInfo& field, const NamesAccess& access, DescribeAt describe) {
  const auto given = value_of(field);
  if (!given) return;
  std::size_t count = 0;
  for (const auto& [name, value] : entries(*given)) {
    access.add(name);
    const auto body = [&](FieldVisitor& visitor) { describe(count, visitor); };
    read_fields(value, Describe(body));
    ++count;
  }
}

void FieldReader::at_most_one(const KeyChoice& choice) {
  const char* chosen = nullptr;
  for (const char* key : choice.keys) {
    if (!has(key)) continue;
    if (chosen != nullptr) {
      reject(key, "given beside '" + std::string(chosen) + "'", choice.allowed,
             choice.conflict_remedy);
    }
    chosen = key;
  }
  if (chosen == nullptr && choice.missing != nullptr && !is_case(choice.none_needed)) {
    glidar::reject(map_, choice.missing, choice.allowed,
                   choice.remedy != nullptr ? choice.remedy : "");
  }
}

Error FieldReader::error_at(const ErrorParts& parts) const {
  const YamlField at = place_of(parts.where);
  std::string found = parts.found;
  if (const std::size_t place = found.find("{}"); place != std::string::npos) {
    found.replace(place, 2, content_text(at));
  }
  return Error({glidar::where(at), found, parts.allowed, parts.remedy});
}

}  // namespace

void read_fields(const YamlField& map, FieldVisitor::Describe describe) {
  KeyCollector collector(map);
  describe(collector);
  require_map(map, collector.keys());
  FieldReader reader(map);
  describe(reader);
}

}  // namespace glidar
