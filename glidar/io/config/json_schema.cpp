// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/json_schema.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/core/text.hpp>
#include <glidar/core/unit_conversion.hpp>
#include <glidar/io/config/material_keys.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/scene_plan.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/surface_presets.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace glidar {
namespace {

using Schema = nlohmann::ordered_json;

Schema number_schema(const NumberRule& rule) {
  Schema schema = {{"type", "number"}};
  const NumberRule all;
  if (rule.min > all.min) schema[rule.is_open ? "exclusiveMinimum" : "minimum"] = rule.min;
  if (rule.max < all.max) schema[rule.is_open ? "exclusiveMaximum" : "maximum"] = rule.max;
  schema["x-allowed"] = rule.allowed;
  return schema;
}

Schema word_schema(std::span<const char* const> words) {
  return {{"type", "string"}, {"enum", std::vector<std::string>(words.begin(), words.end())}};
}

Schema list_schema(const Schema& item, std::size_t min_size, std::size_t max_size) {
  return {{"type", "array"}, {"items", item}, {"minItems", min_size}, {"maxItems", max_size}};
}

Schema path_schema() {
  return {{"type", "string"}, {"minLength", 1}, {"x-allowed", "a path"}};
}

/// {from: , to: , count: }
Schema range_schema(const NumberListRule& rule) {
  const Schema number = number_schema(rule.number);
  return {{"type", "object"},
          {"properties",
           {{"from", number},
            {"to", number},
            {"count", {{"type", "integer"}, {"minimum", 2}, {"maximum", rule.max_size}}}}},
          {"required", {"from", "to", "count"}},
          {"additionalProperties", false}};
}

/// One schema for each key: a map that has it.
Schema requirements(const std::vector<const char*>& keys) {
  Schema all = Schema::array();
  for (const char* key : keys) all.push_back({{"required", Schema::array({key})}});
  return all;
}

/// A map that has the case.
Schema case_schema(const KeyCase& one) {
  const Schema inner = {{"type", "object"},
                        {"properties", {{one.inner, {{"const", one.word}}}}},
                        {"required", Schema::array({one.inner})}};
  return {{"properties", {{one.key, inner}}}, {"required", Schema::array({one.key})}};
}

class SchemaBuilder final : public FieldVisitor {
 public:
  [[nodiscard]] Mode mode() const override { return Mode::schema; }

  [[nodiscard]] Schema result() const {
    if (!alternatives_.empty()) return {{"type", "object"}, {"oneOf", alternatives_}};
    Schema schema = {{"type", "object"}, {"properties", properties_}};
    if (!required_.empty()) schema["required"] = required_;
    schema["additionalProperties"] = false;
    if (!needs_.empty()) schema["dependencies"] = needs_;
    if (!conditions_.empty()) schema["allOf"] = conditions_;
    return schema;
  }

  /// The key that selects this alternative, and its word.
  void add_type(const FieldInfo& field, const TypeInfo& type) {
    properties_[field.key] = {{"const", type.name}, {"description", type.text}};
    if (*type.source != '\0') properties_[field.key]["x-source"] = type.source;
  }
  void require_key(const char* key) { required_.emplace_back(key); }

  void number(const FieldInfo& field, const NumberRule& rule, double& value) override {
    Schema schema = number_schema(rule);
    if (std::isfinite(value)) schema["default"] = in_unit(value, field.unit.size);
    add(field, std::move(schema));
  }
  void whole_number(const FieldInfo& field, const WholeRule& rule, std::uint32_t& value) override {
    add(field,
        {{"type", "integer"}, {"minimum", rule.min}, {"maximum", rule.max}, {"default", value}});
  }
  void boolean(const FieldInfo& field, bool& value) override {
    add(field, {{"type", "boolean"}, {"default", value}});
  }
  void text(const FieldInfo& field, std::string& /*value*/) override {
    add(field, {{"type", {"string", "number"}}});
  }
  void texts(const FieldInfo& field, std::vector<std::string>& /*values*/) override {
    add(field, {{"type", "array"}, {"items", {{"type", {"string", "number"}}}}});
  }
  void path(const FieldInfo& field, std::string& /*value*/) override { add(field, path_schema()); }
  void paths(const FieldInfo& field, std::vector<std::string>& /*values*/) override {
    add(field, {{"anyOf", {path_schema(), {{"type", "array"}, {"items", path_schema()}}}}});
  }
  void word(const FieldInfo& field, std::span<const char* const> words,
            std::size_t& value) override {
    Schema schema = word_schema(words);
    schema["default"] = words[value];
    add(field, std::move(schema));
  }
  void words_or_count(const FieldInfo& field, std::span<const char* const> words,
                      std::uint32_t max_size, std::vector<std::string>& chosen,
                      std::uint32_t& /*count*/) override {
    const Schema count = {{"type", "integer"}, {"minimum", 1}, {"maximum", max_size}};
    add(field,
        {{"anyOf", {list_schema(word_schema(words), 1, max_size), count}}, {"default", chosen}});
  }
  void numbers(const FieldInfo& field, const NumberListRule& rule,
               std::vector<double>& values) override {
    const Schema number = number_schema(rule.number);
    Schema forms = Schema::array({list_schema(number, rule.min_size, rule.max_size)});
    if (rule.takes_one) forms.push_back(number);
    if (rule.takes_range) forms.push_back(range_schema(rule));
    Schema schema = forms.size() == 1 ? forms[0] : Schema{{"anyOf", forms}};
    schema["x-allowed"] = rule.number.allowed;
    if (!values.empty()) {
      for (double& value : values) value = in_unit(value, field.unit.size);
      schema["default"] = values;
    }
    add(field, std::move(schema));
  }
  void table(const FieldInfo& field, const NumberRule& position, const NumberRule& value,
             LookupTable& /*pairs*/) override {
    constexpr std::size_t kMaxPairs = 4096;
    Schema pair = list_schema(Schema::array({number_schema(position), number_schema(value)}), 2, 2);
    pair["additionalItems"] = false;
    Schema schema = list_schema(pair, 1, kMaxPairs);
    schema["x-allowed"] = "pairs, positions rising";
    if (field.default_text == nullptr) schema["x-default"] = "none";
    add(field, std::move(schema));
  }
  bool vector(const FieldInfo& field, const NumberRule& rule, bool is_present,
              Eigen::Vector3d& /*value*/) override {
    Schema schema = list_schema(number_schema(rule), 3, 3);
    schema["x-allowed"] = rule.allowed;
    add(field, std::move(schema));
    return is_present;
  }
  bool object(const FieldInfo& field, bool is_present, Describe describe) override {
    SchemaBuilder nested;
    describe(nested);
    add(field, nested.result());
    return is_present;
  }
  void text_or_object(const FieldInfo& field, const char* /*allowed*/, std::string& /*value*/,
                      Describe describe) override {
    SchemaBuilder nested;
    describe(nested);
    add(field, {{"anyOf", {{{"type", "string"}, {"minLength", 1}}, nested.result()}}});
  }
  void list(const FieldInfo& field, const ListAccess& access, DescribeAt describe) override {
    access.resize(1);
    SchemaBuilder item;
    describe(0, item);
    add(field, list_schema(item.result(), access.min_size, access.max_size));
  }
  void by_name(const FieldInfo& field, const NamesAccess& access, DescribeAt describe) override {
    access.add("*");
    SchemaBuilder item;
    describe(0, item);
    add(field, {{"type", "object"}, {"additionalProperties", item.result()}});
  }
  void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    for (std::size_t i = 0; i < types.size(); ++i) {
      SchemaBuilder alternative;
      alternative.add_type(field, types[i]);
      if (field.is_required || i != chosen) alternative.require_key(field.key);
      describe(i, alternative);
      alternatives_.push_back(alternative.result());
    }
  }
  void provenance(const FieldInfo& field, bool is_map) override {
    add(field, {{"type", is_map ? "object" : "array"}, {"x-default", "none"}});
  }
  void family(const FieldInfo& field, FamilyKey key) override {
    Schema schema = {{"type", "object"}, {"additionalProperties", {{"type", "object"}}}};
    if (key == FamilyKey::name) schema = {{"type", "string"}};
    if (key == FamilyKey::names) schema = {{"type", "array"}, {"items", {{"type", "string"}}}};
    schema["x-default"] = "none";
    add(field, std::move(schema));
  }
  void at_most_one(const KeyChoice& choice) override {
    for (std::size_t i = 0; i < choice.keys.size(); ++i) {
      for (std::size_t k = i + 1; k < choice.keys.size(); ++k) {
        conditions_.push_back({{"not", {{"required", {choice.keys[i], choice.keys[k]}}}}});
      }
    }
    if (choice.missing == nullptr) return;
    std::vector<const char*> sources = choice.keys;
    if (choice.supplier != nullptr) sources.push_back(choice.supplier);
    const Schema one = {{"anyOf", requirements(sources)}};
    conditions_.push_back(choice.none_needed.key == nullptr
                              ? one
                              : Schema{{"if", case_schema(choice.none_needed)},
                                       {"then", Schema::object()},
                                       {"else", one}});
  }
  void excludes(const KeyExclusion& exclusion) override {
    conditions_.push_back({{"if", case_schema(exclusion.when)},
                           {"then", {{"not", {{"anyOf", requirements(exclusion.keys)}}}}}});
  }
  void needs(const KeyNeed& need) override { needs_[need.key] = Schema::array({need.needed}); }

 private:
  void add(const FieldInfo& field, Schema schema) {
    schema["description"] = field.text;
    if (*field.unit.name != '\0') schema["x-unit"] = field.unit.name;
    if (field.is_required) required_.emplace_back(field.key);
    if (field.is_required || field.default_text != nullptr) schema.erase("default");
    if (field.default_text != nullptr) schema["x-default"] = field.default_text;
    properties_[field.key] = std::move(schema);
  }

  Schema properties_ = Schema::object();
  std::vector<std::string> required_;
  Schema needs_;
  Schema conditions_;
  Schema alternatives_;
};

template <class Struct>
Schema schema_of() {
  SchemaBuilder builder;
  Struct value;
  describe(value, builder);
  return builder.result();
}

/// A map of such structs by names of the user's own.
Schema by_name(const Schema& schema) {
  return {{"type", "object"}, {"additionalProperties", schema}};
}

/// The same without the keys that a map must have: the rest is in overrides.
Schema without_requirements(const Schema& schema) {
  if (schema.is_array()) {
    Schema list = Schema::array();
    for (const Schema& item : schema) list.push_back(without_requirements(item));
    return list;
  }
  if (!schema.is_object()) return schema;
  Schema map = Schema::object();
  for (const auto& [key, value] : schema.items()) {
    if (key == "required" || key == "dependencies" || key == "allOf") continue;
    map[key == "oneOf" ? "anyOf" : key] = without_requirements(value);
  }
  return map;
}

/// A sensor, or a family of sensors, whose variants complete the document.
Schema sensor_schema() {
  const Schema sensor = schema_of<SensorKeys>();
  return {{"if", {{"required", Schema::array({"variants"})}}},
          {"then", without_requirements(sensor)},
          {"else", sensor}};
}

Schema surfaces_schema() {
  return by_name(schema_of<SurfacePreset>());
}

Schema materials_schema() {
  return by_name(schema_of<MaterialOverride>());
}

/// Replaces copies of a schema by references to one copy.
void share(Schema& part, const Schema& copied, const Schema& reference) {
  if (part == copied) {
    part = reference;
  } else if (part.is_structured()) {
    for (Schema& inner : part) share(inner, copied, reference);
  }
}

/// A scene may contain sensors and changes of materials at several places.
Schema scene_schema() {
  const Schema sensor = schema_of<SensorKeys>();
  const Schema material = schema_of<MaterialOverride>();
  Schema scene = schema_of<ScenePlan>();
  share(scene, sensor, {{"$ref", "#/definitions/sensor"}});
  share(scene, material, {{"$ref", "#/definitions/material"}});
  scene["definitions"] = {{"sensor", sensor}, {"material", material}};
  return scene;
}

struct NamedSchema {
  const char* name;
  const char* title;
  Schema (*make)();
};

constexpr std::array<NamedSchema, 7> kSchemas = {
    {{"sensor", "GLIDAR sensor file", sensor_schema},
     {"imu", "GLIDAR IMU file", schema_of<Imu>},
     {"scene", "GLIDAR scene file", scene_schema},
     {"pose", "a pose in a GLIDAR scene file", schema_of<PoseKeys>},
     {"motion", "a motion in a GLIDAR scene file", schema_of<MotionKeys>},
     {"materials", "'materials' of a model in a GLIDAR scene file", materials_schema},
     {"surfaces", "GLIDAR surface presets", surfaces_schema}}};

}  // namespace

std::vector<std::string> schema_names() {
  std::vector<std::string> names;
  for (const NamedSchema& one : kSchemas) names.emplace_back(one.name);
  return names;
}

std::string json_schema(const std::string& name) {
  for (const NamedSchema& one : kSchemas) {
    if (name != one.name) continue;
    Schema schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", one.title}};
    schema.update(one.make());
    return schema.dump(1);
  }
  const std::string nearest = closest_match(name, schema_names());
  throw Error({.where = "schema",
               .found = "'" + excerpt(name) + "' has no schema",
               .allowed = fmt::format("{}", fmt::join(schema_names(), ", ")),
               .remedy = nearest.empty() ? "" : "did you mean '" + nearest + "'?"});
}

}  // namespace glidar
