// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/part_keys.hpp>

#include <glidar/core/hits.hpp>
#include <glidar/core/pose_keys.hpp>

#include <array>

namespace glidar {
namespace {

void visit_names(FieldVisitor& visitor, const FieldInfo& field, SensorNames& sensors) {
  if (visitor.is_writing() && sensors.names.empty()) return;
  visitor.texts(field, sensors.names);
  if (!visitor.is_reading() || !visitor.has(field.key)) return;
  sensors.where = visitor.where(field.key);
  if (sensors.names.empty()) {
    visitor.reject(field.key, "an empty list", "names of sensors of the rig",
                   "leave the key out: all sensors see the object");
  }
}

void visit_id(FieldVisitor& visitor, std::optional<std::uint32_t>& id) {
  if (visitor.is_writing() && !id) return;
  std::uint32_t value = id.value_or(0);
  visitor.whole_number(
      {"id", "unique; clouds contain it", kNoUnit, false, "the next one above all ids"},
      {0, kInvalidId - 1}, value);
  if (visitor.is_reading() && visitor.has("id")) id = value;
}

}  // namespace

void visit_visibility(FieldVisitor& visitor, Visibility& visibility) {
  visit_names(visitor,
              {"visible_to", "only these sensors of the rig see it: a list of names", kNoUnit,
               false, "all"},
              visibility.visible_to);
  visit_names(visitor,
              {"hidden_from", "these sensors of the rig do not see it: a list of names", kNoUnit,
               false, "none"},
              visibility.hidden_from);
}

void visit_materials(FieldVisitor& visitor, std::vector<MaterialOverride>& changes) {
  const auto name = [&](std::size_t i) -> const std::string& { return changes[i].material; };
  const auto add = [&](const std::string& material) { changes.emplace_back().material = material; };
  const auto body = [&](std::size_t i, FieldVisitor& nested) { describe(changes[i], nested); };
  visitor.by_name(
      {"materials", "[changes](materials.md) by the name of a material; `\"*\"`: of all", kNoUnit,
       false, "none"},
      {changes.size(), FunctionRef<const std::string&(std::size_t)>(name),
       FunctionRef<void(const std::string&)>(add)},
      FieldVisitor::DescribeAt(body));
  if (visitor.is_reading()) sort_overrides(changes);
}

void describe(PartOverride& part, FieldVisitor& visitor) {
  if (visitor.is_reading()) part.where = visitor.where("");
  visitor.text({"class", "semantic class", kNoUnit, false, "that of the model"}, part.class_name);
  visit_id(visitor, part.id);
  Pose pose = part.parent_from_part.value_or(Pose::Identity());
  const FieldInfo field = {"pose",
                           "parent_from_part, a [pose](motion.md#poses) that replaces the one in "
                           "the model file; parts below it move with it",
                           kNoUnit, false, "that of the model file"};
  const bool has_pose = visit_pose(visitor, field, part.parent_from_part.has_value(), pose);
  if (visitor.is_reading() && has_pose) part.parent_from_part = pose;
  visit_visibility(visitor, part.visibility);
  visit_materials(visitor, part.materials);
}

void visit_parts(FieldVisitor& visitor, std::vector<PartOverride>& parts) {
  if (visitor.is_writing() && parts.empty()) return;
  const auto name = [&](std::size_t i) -> const std::string& { return parts[i].selector; };
  const auto add = [&](const std::string& selector) { parts.emplace_back().selector = selector; };
  const auto body = [&](std::size_t i, FieldVisitor& nested) { describe(parts[i], nested); };
  visitor.by_name({"parts",
                   "[changes of parts](parts.md) by a name, a pattern such as `arm/*`, "
                   "or `material:NAME`; later ones override earlier ones",
                   kNoUnit, false, "none"},
                  {parts.size(), FunctionRef<const std::string&(std::size_t)>(name),
                   FunctionRef<void(const std::string&)>(add)},
                  FieldVisitor::DescribeAt(body));
}

void visit_split(FieldVisitor& visitor, Split& split) {
  constexpr std::array<Named<Split>, 3> kSplits = {
      {{"none", Split::none}, {"parts", Split::parts}, {"materials", Split::materials}}};
  visit_choice(visitor,
               {"split",
                "makes each part, or each material, an object of its own: consecutive ids, its "
                "name as class"},
               kSplits, split);
}

}  // namespace glidar
