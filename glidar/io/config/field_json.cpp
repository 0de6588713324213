// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/field_json.hpp>

#include <glidar/core/unit_conversion.hpp>

#include <cmath>

namespace glidar {
namespace {

class FieldWriter final : public FieldVisitor {
 public:
  explicit FieldWriter(Mode mode) : mode_(mode) {}

  [[nodiscard]] nlohmann::ordered_json result() && { return std::move(json_); }
  [[nodiscard]] Mode mode() const override { return mode_; }

  void number(const FieldInfo& field, const NumberRule& rule, double& value) override {
    const bool is_unset = !std::isfinite(value) || (value == 0.0 && !accepts(rule, 0.0));
    if (is_report() || !is_unset) json_[field.key] = in_file(value, field);
  }
  void whole_number(const FieldInfo& field, const WholeRule& rule, std::uint32_t& value) override {
    if (is_report() || value != 0 || rule.min == 0) json_[field.key] = value;
  }
  void boolean(const FieldInfo& field, bool& value) override { json_[field.key] = value; }
  void text(const FieldInfo& field, std::string& value) override {
    if (is_report() || !value.empty()) json_[field.key] = value;
  }
  void texts(const FieldInfo& field, std::vector<std::string>& values) override {
    if (is_report() || !values.empty()) json_[field.key] = values;
  }
  void path(const FieldInfo& field, std::string& value) override { text(field, value); }
  void paths(const FieldInfo& field, std::vector<std::string>& values) override {
    texts(field, values);
  }
  void word(const FieldInfo& field, std::span<const char* const> words,
            std::size_t& value) override {
    json_[field.key] = words[value];
  }
  void words_or_count(const FieldInfo& field, std::span<const char* const> /*words*/,
                      std::uint32_t /*max_size*/, std::vector<std::string>& chosen,
                      std::uint32_t& count) override {
    if (count > 0) {
      json_[field.key] = count;
    } else {
      json_[field.key] = chosen;
    }
  }
  void numbers(const FieldInfo& field, const NumberListRule& /*rule*/,
               std::vector<double>& values) override {
    if (values.empty() && !is_report()) return;
    auto list = nlohmann::ordered_json::array();
    for (const double value : values) list.push_back(in_file(value, field));
    json_[field.key] = std::move(list);
  }
  void whole_numbers(const FieldInfo& field, const std::vector<std::uint32_t>& values) override {
    json_[field.key] = values;
  }
  void table(const FieldInfo& field, const NumberRule& /*position*/, const NumberRule& /*value*/,
             LookupTable& pairs) override {
    if (pairs.empty() && !is_report()) return;
    auto list = nlohmann::ordered_json::array();
    for (const auto& [position, value] : pairs) {
      list.push_back(nlohmann::ordered_json::array({in_file(position, field), value}));
    }
    json_[field.key] = std::move(list);
  }
  bool vector(const FieldInfo& field, const NumberRule& /*rule*/, bool is_present,
              Eigen::Vector3d& value) override {
    if (is_present) {
      json_[field.key] = nlohmann::ordered_json::array(
          {in_file(value.x(), field), in_file(value.y(), field), in_file(value.z(), field)});
    } else if (is_report()) {
      json_[field.key] = nullptr;
    }
    return is_present;
  }
  bool object(const FieldInfo& field, bool is_present, Describe describe) override {
    if (is_present) {
      json_[field.key] = write_fields(mode(), describe);
    } else if (is_report()) {
      json_[field.key] = nullptr;
    }
    return is_present;
  }
  void text_or_object(const FieldInfo& field, const char* /*allowed*/, std::string& value,
                      Describe describe) override {
    json_[field.key] =
        value.empty() ? write_fields(mode_, describe) : nlohmann::ordered_json(value);
  }
  void list(const FieldInfo& field, const ListAccess& access, DescribeAt describe) override {
    auto list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < access.size; ++i) {
      const auto body = [&](FieldVisitor& visitor) { describe(i, visitor); };
      list.push_back(write_fields(mode_, Describe(body)));
    }
    json_[field.key] = std::move(list);
  }
  void by_name(const FieldInfo& field, const NamesAccess& access, DescribeAt describe) override {
    if (access.size == 0 && !is_report()) return;
    auto entries = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < access.size; ++i) {
      const auto body = [&](FieldVisitor& visitor) { describe(i, visitor); };
      entries[access.name(i)] = write_fields(mode_, Describe(body));
    }
    json_[field.key] = std::move(entries);
  }
  void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    json_[field.key] = types[chosen].name;
    describe(chosen, *this);
  }

 private:
  [[nodiscard]] double in_file(double value, const FieldInfo& field) const {
    return is_report() ? in_unit(value, field.unit.size) : exact_in(value, field.unit.size);
  }

  Mode mode_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

}  // namespace

nlohmann::ordered_json write_fields(FieldVisitor::Mode mode, FieldVisitor::Describe describe) {
  FieldWriter writer(mode);
  describe(writer);
  return std::move(writer).result();
}

}  // namespace glidar
