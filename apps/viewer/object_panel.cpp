// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/object_panel.hpp>

#include <apps/viewer/widgets.hpp>

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

namespace glidar::app {
namespace {

/// A row of the list; empty: all objects. `scrolled_to`: the last row that was scrolled to.
void show_row(Viewer& viewer, const std::string& name, std::optional<std::size_t> object,
              int& scrolled_to) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool is_selected = viewer.selection().object() == object;
  if (ImGui::Selectable(name.c_str(), is_selected, ImGuiSelectableFlags_SpanAllColumns)) {
    viewer.select(object);
  }
  // a click on a point may have selected a row outside the visible part
  const int row = object ? static_cast<int>(*object) : -1;
  if (!is_selected || scrolled_to == row) return;
  scrolled_to = row;
  if (!ImGui::IsItemVisible()) ImGui::SetScrollHereY();
}

void show_rows(Viewer& viewer) {
  const Scene& scene = viewer.snapshot()->prepared->scene;
  int& scrolled_to = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("scrolled to"), 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    ImGui::PushID(static_cast<int>(i));
    show_row(viewer, instance.name, i, scrolled_to);
    ImGui::TableNextColumn();
    text(std::to_string(instance.id));
    ImGui::TableNextColumn();
    text(scene.class_names.at(instance.class_id));
    ImGui::PopID();
  }
  if (scene.instances.size() > 1) show_row(viewer, "(all objects)", std::nullopt, scrolled_to);
}

void show_list(Viewer& viewer) {
  constexpr std::size_t kMaxRows = 7;  // more rows scroll
  const std::size_t count = viewer.snapshot()->prepared->scene.instances.size();
  const std::size_t rows = std::min(kMaxRows, count > 1 ? count + 2 : count + 1);
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                     ImGuiTableFlags_BordersOuter | ImGuiTableFlags_Resizable;
  const float height = (static_cast<float>(rows) + 0.5F) * ImGui::GetTextLineHeightWithSpacing();
  if (!ImGui::BeginTable("objects", 3, kFlags, ImVec2(0.0F, height))) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("object", ImGuiTableColumnFlags_WidthStretch, 3.0F);
  ImGui::TableSetupColumn("id", ImGuiTableColumnFlags_WidthStretch, 1.0F);
  ImGui::TableSetupColumn("class", ImGuiTableColumnFlags_WidthStretch, 2.5F);
  ImGui::TableHeadersRow();
  show_rows(viewer);
  ImGui::EndTable();
}

}  // namespace

void show_objects(Viewer& viewer) {
  const Snapshot* snapshot = viewer.snapshot();
  if (snapshot == nullptr) return;
  show_list(viewer);
  if (ImGui::Button("Frame object (f)")) viewer.frame_selected();
  ImGui::SameLine();
  bool keeps_in_view = viewer.keeps_in_view();
  if (ImGui::Checkbox("keep in view", &keeps_in_view)) viewer.set_keeps_in_view(keeps_in_view);
  const std::optional<std::size_t> object = viewer.selection().object();
  if (!object) return;
  const Instance& instance = snapshot->prepared->scene.instances[*object];
  Pose pose = snapshot->frame.world_from_instance[*object];
  const std::string name = instance.name + " in the world";
  ImGui::PushID(static_cast<int>(*object));
  if (edit_pose(name.c_str(), pose)) viewer.set_object_pose(*object, pose);
  ImGui::PopID();
  text(fmt::format("scale {:g}", instance.scale));
}

}  // namespace glidar::app
