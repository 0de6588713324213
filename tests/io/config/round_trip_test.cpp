// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/optics_keys.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace glidar {
namespace {

using Mode = FieldVisitor::Mode;
using Json = nlohmann::ordered_json;

/// Acts as a file that has every key, with values that differ from the defaults and rise from key
/// to key. Of keys that exclude each other it has the last.
class Filler final : public FieldVisitor {
 public:
  explicit Filler(std::size_t alternative) : alternative_(alternative) {}

  [[nodiscard]] Mode mode() const override { return Mode::read; }
  [[nodiscard]] const char* type() const { return type_; }
  /// Optics whose numbers are those of another file.
  [[nodiscard]] bool is_from_file() const {
    return type_ == std::string("table") || type_ == std::string("ouster");
  }

  void number(const FieldInfo& field, const NumberRule& rule, double& value) override {
    if (has(field.key)) value = next(rule) * field.unit.size;
  }
  void whole_number(const FieldInfo& field, const WholeRule& rule, std::uint32_t& value) override {
    if (!has(field.key)) return;
    const std::uint32_t old = value;
    value = std::min(rule.max, rule.min + 2);
    if (value == old) value -= 2;
  }
  void boolean(const FieldInfo& /*field*/, bool& value) override { value = !value; }
  void word(const FieldInfo& /*field*/, std::span<const char* const> words,
            std::size_t& value) override {
    value = (value + 1) % words.size();
  }
  void numbers(const FieldInfo& field, const NumberListRule& rule,
               std::vector<double>& values) override {
    if (!has(field.key)) return;
    values.resize(rule.max_size > 2 ? std::max<std::size_t>(rule.min_size, 2) : rule.max_size);
    for (double& value : values) value = next(rule.number) * field.unit.size;
  }
  void table(const FieldInfo& field, const NumberRule& position, const NumberRule& value,
             LookupTable& pairs) override {
    pairs.clear();
    for (int i = 0; i < 2; ++i) {
      const double at = next(position) * field.unit.size;
      pairs.push_back({at, next(value)});
    }
  }
  bool object(const FieldInfo& /*field*/, bool /*is_present*/, Describe describe) override {
    describe(*this);
    return true;
  }
  void list(const FieldInfo& /*field*/, const ListAccess& access, DescribeAt describe) override {
    access.resize(2);
    describe(0, *this);
    describe(1, *this);
  }
  void variant(const FieldInfo& /*field*/, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    const bool is_outer = type_ == nullptr;
    const std::size_t i = is_outer ? alternative_ : (chosen + 1) % types.size();
    if (is_outer) type_ = types[i].name;
    if (!is_from_file()) describe(i, *this);
  }
  void at_most_one(const KeyChoice& choice) override {
    const char* kept = choice.keys.front();
    for (const char* key : choice.keys) kept = is_other_form(key) ? kept : key;
    for (const char* key : choice.keys) {
      if (key != kept) excluded_.insert(key);
    }
  }
  [[nodiscard]] bool has(const char* key) const override {
    return !excluded_.contains(key) && !is_other_form(key);
  }

 private:
  /// Keys that only documents of some numbers have.
  static bool is_other_form(std::string_view key) {
    return key == "from_rad" || key == "width_rad" || key == "range90_m";
  }

  /// A number with digits that do not end in binary.
  double next(const NumberRule& rule) {
    constexpr double kStep = 0.013;
    const double share = kStep * ++count_;
    const double low = std::max(rule.min, -100.0);
    const double high = std::min(rule.max, std::max(100.0, rule.min * 2.0));
    return low + share * (high - low);
  }

  std::size_t alternative_;
  const char* type_ = nullptr;
  int count_ = 0;
  std::set<std::string, std::less<>> excluded_;
};

/// The keys of a document that have the value of a default struct.
std::string unchanged_keys(const Json& document, const Json& defaults) {
  std::string keys;
  for (const auto& [key, value] : document.items()) {
    const auto same = defaults.find(key);
    const bool is_chosen = key == "type" || key == "width_definition";  // by the writer
    if (!is_chosen && same != defaults.end() && *same == value) keys += key + " ";
  }
  return keys;
}

/// Every alternative of a variant: the document has the same bits after a reader read it.
template <class... Types>
std::set<std::string> expect_round_trips(const std::variant<Types...>& /*any*/) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < sizeof...(Types); ++i) {
    std::variant<Types...> value;
    Filler filler(i);
    describe(value, filler);
    SCOPED_TRACE(filler.type());
    names.insert(filler.type());
    if (filler.is_from_file()) continue;
    const Json document = write_struct(Mode::document, value);
    EXPECT_EQ(document.at("type"), filler.type());
    std::variant<Types...> same;
    read_struct(read_yaml_text("text", document.dump()), same);
    EXPECT_EQ(write_struct(Mode::document, same).dump(), document.dump());
    EXPECT_EQ(write_struct(Mode::report, same).dump(), write_struct(Mode::report, value).dump());
    std::variant<Types...> plain = value;
    std::visit([](auto& alternative) { alternative = {}; }, plain);
    if (filler.type() == std::string("spinning")) continue;  // a default has no channels to write
    EXPECT_EQ(unchanged_keys(document, write_struct(Mode::document, plain)), "");
  }
  return names;
}

TEST(RoundTrip, EveryNoiseStepWithAllKeysReadsBackTheSameBits) {
  const std::set<std::string> names = expect_round_trips(NoiseStep{});
  EXPECT_EQ(names.size(), std::variant_size_v<NoiseStep>);
}

TEST(RoundTrip, EveryKindOfOpticsWithAllKeysReadsBackTheSameBits) {
  EXPECT_EQ(expect_round_trips(OpticsKeys{}).size(), std::variant_size_v<OpticsKeys>);
}

TEST(RoundTrip, EveryBackscatterWithAllKeysReadsBackTheSameBits) {
  EXPECT_EQ(expect_round_trips(Brdf{}).size(), std::variant_size_v<Brdf>);
}

template <class Struct>
void expect_round_trip() {
  Struct value;
  Filler filler(0);
  describe(value, filler);
  const Json document = write_struct(Mode::document, value);
  Struct same;
  read_struct(read_yaml_text("text", document.dump()), same);
  EXPECT_EQ(write_struct(Mode::document, same).dump(), document.dump());
  EXPECT_EQ(unchanged_keys(document, write_struct(Mode::document, Struct{})), "");
}

TEST(RoundTrip, LidarPartsWithAllKeysReadBackTheSameBits) {
  expect_round_trip<LidarEquation>();
  expect_round_trip<Footprint>();
  expect_round_trip<Weather>();
  expect_round_trip<PhongHeadlight>();
  expect_round_trip<Limits>();
}

}  // namespace
}  // namespace glidar
