// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/field_visitor.hpp>
#include <glidar/core/pose_keys.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/motion_keys.hpp>
#include <glidar/io/config/scene_plan.hpp>
#include <glidar/io/config/sensor_keys.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

using Mode = FieldVisitor::Mode;
using Json = nlohmann::ordered_json;

/// Acts as a file that has every key, with values that differ from the defaults and rise from key
/// to key. Of keys that exclude each other it has the last. `nested` selects the alternative of
/// variants inside, and the form of values that have several.
class Filler final : public FieldVisitor {
 public:
  explicit Filler(std::size_t alternative, std::size_t nested = 0)
      : alternative_(alternative), nested_(nested) {}

  [[nodiscard]] Mode mode() const override { return Mode::read; }
  [[nodiscard]] const char* type() const { return type_; }
  [[nodiscard]] const char* type_key() const { return type_key_; }
  /// How many values of `nested` give different files.
  [[nodiscard]] std::size_t nested_count() const { return nested_count_; }
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
  void text(const FieldInfo& field, std::string& value) override {
    if (has(field.key)) value = "a text";
  }
  void path(const FieldInfo& field, std::string& value) override {
    const std::string_view key = field.key;
    // documents have the numbers of these
    if (key != "calibration_file" && key != "fire_time_file") value = "/a/path";
  }
  void words_or_count(const FieldInfo& /*field*/, std::span<const char* const> words,
                      std::uint32_t max_size, std::vector<std::string>& chosen,
                      std::uint32_t& count) override {
    nested_count_ = 2;
    chosen = {words.back(), words.front()};
    count = nested_ == 0 ? 0 : max_size;
  }
  bool vector(const FieldInfo& field, const NumberRule& rule, bool is_present,
              Eigen::Vector3d& value) override {
    if (!has(field.key)) return is_present;
    for (double& part : value) part = next(rule) * field.unit.size;
    return true;
  }
  void numbers(const FieldInfo& field, const NumberListRule& rule,
               std::vector<double>& values) override {
    if (!has(field.key)) return;
    values.resize(rule.max_size > 2 ? std::max<std::size_t>(rule.min_size, 2) : rule.max_size);
    const bool is_whole = std::string_view(field.key) == "channels";
    for (double& value : values) {
      value = next(rule.number) * field.unit.size;
      if (is_whole) value = std::floor(value);
    }
  }
  void table(const FieldInfo& field, const NumberRule& position, const NumberRule& value,
             LookupTable& pairs) override {
    pairs.clear();
    for (int i = 0; i < 2; ++i) {
      const double at = next(position) * field.unit.size;
      pairs.push_back({at, next(value)});
    }
  }
  bool object(const FieldInfo& field, bool is_present, Describe describe) override {
    if (!has(field.key)) return is_present;
    const std::set<std::string, std::less<>> outer = std::exchange(excluded_, {});
    describe(*this);
    excluded_ = outer;
    return true;
  }
  void list(const FieldInfo& /*field*/, const ListAccess& access, DescribeAt describe) override {
    access.resize(2);
    describe(0, *this);
    describe(1, *this);
  }
  void variant(const FieldInfo& field, std::span<const TypeInfo> types, std::size_t chosen,
               DescribeAt describe) override {
    const bool is_outer = type_ == nullptr;
    if (!is_outer) nested_count_ = types.size() - 1;
    const std::size_t i = is_outer ? alternative_ : (chosen + 1 + nested_) % types.size();
    if (is_outer) type_ = types[i].name;
    if (is_outer) type_key_ = field.key;
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
    return key == "from_rad" || key == "width_rad" || key == "range90_m" || key == "matrix" ||
           key == "look_at" || key == "surface";
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
  std::size_t nested_;
  std::size_t nested_count_ = 1;
  const char* type_ = nullptr;
  const char* type_key_ = nullptr;
  int count_ = 0;
  std::set<std::string, std::less<>> excluded_;
};

/// The keys of a document that have the value of a default struct.
std::string unchanged_keys(const Json& document, const Json& defaults) {
  std::string keys;
  for (const auto& [key, value] : document.items()) {
    const auto same = defaults.find(key);
    const bool is_chosen = key == "type" || key == "model" || key == "width_definition";
    if (!is_chosen && same != defaults.end() && *same == value) keys += key + " ";
  }
  return keys;
}

/// The document has the same bits after a reader read it.
template <class... Types>
void expect_round_trip(const Filler& filler, const std::variant<Types...>& value) {
  SCOPED_TRACE(filler.type());
  const Json document = write_struct(Mode::document, value);
  EXPECT_EQ(document.at(filler.type_key()), filler.type());
  std::variant<Types...> same;
  read_struct(read_yaml_text("text", document.dump()), same);
  EXPECT_EQ(write_struct(Mode::document, same).dump(), document.dump());
  EXPECT_EQ(write_struct(Mode::report, same).dump(), write_struct(Mode::report, value).dump());
  std::variant<Types...> plain = value;
  std::visit([](auto& alternative) { alternative = {}; }, plain);
  if (filler.type() == std::string("spinning")) return;  // a default has no channels to write
  EXPECT_EQ(unchanged_keys(document, write_struct(Mode::document, plain)), "");
}

/// Every alternative of a variant: the document has the same bits after a reader read it.
template <class... Types>
std::set<std::string> expect_round_trips(const std::variant<Types...>& /*any*/) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < sizeof...(Types); ++i) {
    std::size_t forms = 1;
    for (std::size_t nested = 0; nested < forms; ++nested) {
      std::variant<Types...> value;
      Filler filler(i, nested);
      describe(value, filler);
      names.insert(filler.type());
      forms = filler.nested_count();
      if (!filler.is_from_file()) expect_round_trip(filler, value);
    }
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

TEST(RoundTrip, EveryDistortionWithAllKeysReadsBackTheSameBits) {
  EXPECT_EQ(expect_round_trips(Distortion{}),
            (std::set<std::string>{"none", "radial_tangential", "fisheye", "fov", "omni",
                                   "double_sphere", "eucm", "equirectangular"}));
}

/// Cameras with all keys contain every distortion.
TEST(RoundTrip, CamerasHaveEveryDistortionInTurn) {
  std::set<std::string> models;
  for (std::size_t nested = 0; nested + 1 < std::variant_size_v<Distortion>; ++nested) {
    OpticsKeys keys;
    Filler filler(OpticsKeys(PinholeKeys{}).index(), nested);
    describe(keys, filler);
    models.insert(write_struct(Mode::document, keys).at("distortion").at("model"));
  }
  EXPECT_EQ(models, (std::set<std::string>{"radial_tangential", "fisheye", "fov", "omni",
                                           "double_sphere", "eucm", "equirectangular"}));
}

template <class Struct>
void expect_round_trip(std::size_t nested = 0) {
  Struct value;
  Filler filler(0, nested);
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
  expect_round_trip<Doppler>();
  expect_round_trip<PhongHeadlight>();
  expect_round_trip<Limits>();
  expect_round_trip<Receiver>(0);  // returns by name
  expect_round_trip<Receiver>(1);  // the nearest returns
}

TEST(RoundTrip, PosesReadBackTheSameBits) {
  expect_round_trip<PoseKeys>();
}

TEST(RoundTrip, EveryMotionWithAllKeysReadsBackTheSameBits) {
  expect_round_trip<Spin>();
  expect_round_trip<ConstantTwist>();
  InitialRotation start;
  start.moments_kg_m2 = {1.1, 2.3, 2.7};
  start.rate_rad_s = {0.1, 0.7, 0.3};
  start.velocity_m_s = {0.3, -0.1, 0.9};
  start.body_from_principal = make_pose({0.1, 0.3, 0.7}, {0.1, 0.3, 0.7, 0.9});
  MotionKeys keys;
  keys.trajectory = TorqueFreeRotation(start);
  const std::string document = write_struct(Mode::document, keys).dump();
  MotionKeys same;
  read_struct(read_yaml_text("text", document), same);
  EXPECT_EQ(write_struct(Mode::document, same).dump(), document);
  EXPECT_EQ(std::get<TorqueFreeRotation>(*same.trajectory).start().body_from_principal.matrix(),
            start.body_from_principal.matrix());
}

TEST(RoundTrip, ChangesOfMaterialsWithAllKeysReadBackTheSameBits) {
  expect_round_trip<MaterialOverride>();
}

/// A scene with a single sensor and one with a rig, every kind of motion among them.
TEST(RoundTrip, ScenesReadBackTheSameBits) {
  const std::string models =
      "models: [{model: 'builtin:box', size: [1, 2, 0.3], name: b, unit: mm, up: y, centre: true, "
      "scale: [1, 2.1, 3], pose: {euler_deg: {yaw: 10.1}}, id: 7, class: c, "
      "materials: {A: {mirror: 0.1}, '*': {diffuse: [0.1, 0.3, 0.7], shininess: 3.3}}}, "
      "{model: 'builtin:box', motion: {tumbling: {moments_kg_m2: [1, 2, 2.5], "
      "rate_deg_s: [1, 20, 3], principal: {position: [0.1, 0, 0]}}}}]\n";
  const std::string camera = "{optics: {width: 7, height: 5, fov_deg: 33.3}}";
  for (const std::string& rest :
       {"sensor: " + camera + "\nsensor_pose: {look_at: {eye: [1, 2, 3], target: [0, 0, 0]}}\n" +
            "sensor_motion: {twist: {velocity_m_s: [0, 0.1, 0], rate_deg_s: [1, 0, 0]}}\n",
        "sensors: [{name: one, sensor: " + camera +
            "}, {name: two, sensor: VLP-16, pose: {position: " +
            "[0, 0, 0.1], rotation_vector: [0.1, 0.2, 0.3]}}]\nrig_pose: {position: [1, 0, 0]}\n" +
            "rig_motion: {spin: {rate_deg_s: [0, 0, 7.7]}}\n"}) {
    const ScenePlan plan = read_scene_plan(read_yaml_text("text", models + rest), {});
    const std::string document = write_struct(Mode::document, plan).dump();
    const ScenePlan same = read_scene_plan(read_yaml_text("text", document), {});
    EXPECT_EQ(write_struct(Mode::document, same).dump(), document);
    EXPECT_EQ(same.instances[0].source, "builtin:box:size=1,2,0.3");
    EXPECT_EQ(same.instances[0].overrides.size(), 2U);
    EXPECT_EQ(same.sensors.size(), plan.sensors.size());
    EXPECT_EQ(pose_at(*same.rig_motion, 123456789).matrix(),
              pose_at(*plan.rig_motion, 123456789).matrix());
    EXPECT_EQ(pose_at(*same.instances[1].motion, 123456789).matrix(),
              pose_at(*plan.instances[1].motion, 123456789).matrix());
  }
}

}  // namespace
}  // namespace glidar
