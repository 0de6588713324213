// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/screen.hpp>

#include <glidar/core/pose.hpp>
#include <glidar/io/config/sensor_options.hpp>
#include <glidar/io/config/sensor_presets.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>
#include <imgui.h>
#include <apps/viewer/viewer.hpp>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <string_view>

namespace glidar::app {

double rounded(double value, int decimals) {
  const double unit = power_of_ten(decimals);
  const double scaled = value * unit;
  constexpr double kAllWhole = 9007199254740992.0;  // 2^53: larger numbers have no fraction
  if (!(std::abs(scaled) < kAllWhole)) return value;
  return std::round(scaled) / unit + 0.0;  // -0 + 0 is +0
}

std::string without_negative_zeros(const std::string& text) {
  // a minus that is not within a word, before zeros that are not part of a longer number or word
  static const std::regex kSign(R"((^|\W)-(?=0[0.]*(?![\w.])))");
  return std::regex_replace(text, kSign, "$1");
}

namespace {

/// Replaces characters that the window's font lacks.
void replace_all(const std::string& what, const std::string& with, std::string& line) {
  for (std::size_t at = line.find(what); at != std::string::npos; at = line.find(what, at)) {
    line.replace(at, what.size(), with);
  }
}

struct NumberFormat {
  int decimals;
  const char* printf_format;
};

/// Three numbers in a row; true if one was edited.
bool edit_numbers(const char* label, const NumberFormat& format, Eigen::Vector3d& numbers) {
  const Eigen::Vector3d shown =
      numbers.unaryExpr([&](double value) { return rounded(value, format.decimals); });
  Eigen::Vector3d typed = shown;
  ImGui::InputScalarN(label, ImGuiDataType_Double, typed.data(), 3, nullptr, nullptr,
                      format.printf_format);
  for (int i = 0; i < 3; ++i) {
    if (typed[i] != shown[i]) numbers[i] = typed[i];
  }
  return ImGui::IsItemDeactivatedAfterEdit();
}

/// A line of text; zero numbers have no minus sign.
void text(const std::string& line) {
  std::string shown = without_negative_zeros(line);
  replace_all("\u2265", ">=", shown);
  replace_all("\u2264", "<=", shown);
  ImGui::TextUnformatted(shown.c_str(), shown.c_str() + shown.size());
}

/// The same, wrapped at the panel's width.
void wrapped(const std::string& line) {
  ImGui::PushTextWrapPos(0.0F);
  text(line);
  ImGui::PopTextWrapPos();
}

/// Editable position (m) and roll, pitch, yaw (degrees, about the fixed axes x, y, z in this
/// order); true if edited. Values that are not edited keep all digits.
bool edit_pose(const char* name, Pose& pose) {
  ImGui::PushID(name);
  text(name);
  Eigen::Vector3d position_m = pose.translation();
  const Eigen::Matrix3d r = pose.linear();
  Eigen::Vector3d rpy_deg =
      kDegreesPerRadian * Eigen::Vector3d(portable_atan2(r(2, 1), r(2, 2)),
                                          portable_asin(std::clamp(-r(2, 0), -1.0, 1.0)),
                                          portable_atan2(r(1, 0), r(0, 0)));
  ImGui::PushItemWidth(ImGui::GetFontSize() * 15.5F);
  bool is_changed = edit_numbers("m", {6, "%.6g"}, position_m);
  is_changed = edit_numbers("rpy deg", {2, "%.2f"}, rpy_deg) || is_changed;
  ImGui::PopItemWidth();
  ImGui::PopID();
  if (!is_changed || !position_m.allFinite() || !rpy_deg.allFinite()) return false;
  pose = make_pose(position_m, roll_pitch_yaw(rpy_deg / kDegreesPerRadian));
  return true;
}

/// A row of the list; empty: all objects. `scrolled_to`: the last row that was scrolled to.
void show_object_row(Viewer& viewer, const std::string& name, std::optional<std::size_t> object,
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

void show_object_rows(Viewer& viewer) {
  const Scene& scene = viewer.snapshot()->prepared->scene;
  int& scrolled_to = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("scrolled to"), 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    ImGui::PushID(static_cast<int>(i));
    show_object_row(viewer, instance.name, i, scrolled_to);
    ImGui::TableNextColumn();
    text(std::to_string(instance.id));
    ImGui::TableNextColumn();
    text(scene.class_names.at(instance.class_id));
    ImGui::PopID();
  }
  if (scene.instances.size() > 1)
    show_object_row(viewer, "(all objects)", std::nullopt, scrolled_to);
}

void show_object_list(Viewer& viewer) {
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
  show_object_rows(viewer);
  ImGui::EndTable();
}

/// A list of the scene's objects for selection, and the pose of the selected one.
void show_objects(Viewer& viewer) {
  const Snapshot* snapshot = viewer.snapshot();
  if (snapshot == nullptr) return;
  show_object_list(viewer);
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

ImU32 packed(Colour colour) {
  return IM_COL32(colour.r, colour.g, colour.b, 255);
}

/// A list; true if another item was selected, whose index is then `chosen`.
template <class Names>
bool choose(const char* label, const std::string& shown, const Names& names, std::size_t& chosen) {
  bool is_changed = false;
  if (!ImGui::BeginCombo(label, shown.c_str())) return false;
  std::size_t index = 0;
  for (const auto& name : names) {
    const std::string_view item = name;
    if (ImGui::Selectable(std::string(item).c_str(), item == shown)) {
      is_changed = item != shown;
      chosen = index;
    }
    ++index;
  }
  ImGui::EndCombo();
  return is_changed;
}

/// The names of the sensor presets, read once.
const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const SensorPreset& preset : sensor_presets()) names.push_back(preset.name);
    return names;
  }();
  return kNames;
}

std::string limit_text(const Limits& limits) {
  const std::string along = limits.along == Limits::Along::depth ? "depth" : "range";
  if (std::isinf(limits.far_m)) {
    return limits.near_m > 0.0 ? fmt::format("{} from {:g} m", along, limits.near_m) : "no limits";
  }
  return fmt::format("{} {:g} to {:g} m", along, limits.near_m, limits.far_m);
}

void show_sensor_numbers(const Snapshot& snapshot) {
  const Sensor& sensor = *snapshot.sensor;
  const Beams& beams = *snapshot.beams;
  text(fmt::format("{} x {} beams{}, {:g} Hz", beams.rows / beams.returns, beams.cols,
                   beams.returns > 1 ? fmt::format(", {} returns", beams.returns) : "",
                   sensor.rate_hz));
  if (beams.pinhole) {
    const PinholeIntrinsics& k = *beams.pinhole;
    text(fmt::format("fx {:.1f} fy {:.1f}, {:.1f} x {:.1f} deg", k.fx, k.fy,
                     2.0 * kDegreesPerRadian * portable_atan(0.5 * k.width / k.fx),
                     2.0 * kDegreesPerRadian * portable_atan(0.5 * k.height / k.fy)));
  }
  text(limit_text(sensor.limits));
  text(sensor.lidar_equation ? "pulsed light" : "light at the sensor (paper)");
  if (sensor.footprint) text("beams with a footprint");
  if (sensor.weather) text("weather");
  if (sensor.noise.empty()) return;
  if (!ImGui::TreeNode(
          "steps", "%s",
          fmt::format("noise: {} step{}", sensor.noise.size(), sensor.noise.size() == 1 ? "" : "s")
              .c_str()))
    return;
  for (const NoiseStep& step : sensor.noise) wrapped(noise_text(step));
  ImGui::TreePop();
}

/// The sensors of the scene; a click selects one.
void show_rig_sensors(Viewer& viewer) {
  const std::vector<ActiveSensor>& sensors = viewer.snapshot()->prepared->sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const ActiveSensor& active = sensors[i];
    const std::string line = active.name.empty()
                                 ? active.sensor.name
                                 : fmt::format("{}: {}", active.name, active.sensor.name);
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(line.c_str(), i == viewer.request().sensor_index))
      viewer.select_sensor(i);
    ImGui::PopID();
  }
}

void show_sensor(Viewer& viewer) {
  const SensorFlags& flags = viewer.request().flags->sensor;
  std::size_t chosen = 0;
  const std::string shown = flags.file.empty() ? "as given" : flags.file;
  if (viewer.snapshot() != nullptr) show_rig_sensors(viewer);
  const bool has_rig =
      viewer.snapshot() != nullptr && viewer.snapshot()->prepared->sensors.size() > 1;
  if (!has_rig && choose("preset", shown, preset_names(), chosen)) {
    viewer.use_sensor(preset_names()[chosen]);
  }
  if (viewer.snapshot() != nullptr) show_sensor_numbers(*viewer.snapshot());
  bool has_noise = viewer.request().has_noise;
  if (ImGui::Checkbox("noise", &has_noise)) viewer.set_noise(has_noise);
  ImGui::SameLine();
  std::uint64_t seed = viewer.request().seed;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 7.0F);
  constexpr std::uint64_t kStep = 1;
  if (ImGui::InputScalar("seed", ImGuiDataType_U64, &seed, &kStep)) viewer.set_seed(seed);
  if (choose("renderer", renderer_kind(viewer.request().flags->renderer.kind), renderer_kinds(),
             chosen)) {
    viewer.use_renderer(renderer_kinds()[chosen]);
  }
  if (viewer.snapshot() == nullptr) return;
  Pose pose = viewer.snapshot()->frame.world_from_sensor;
  if (edit_pose("sensor in the world", pose)) viewer.set_sensor_pose(pose);
}

void show_view_style(Viewer& viewer) {
  std::size_t chosen = 0;
  ViewStyle& style = viewer.style;
  const auto quantity = static_cast<std::size_t>(style.quantity);
  if (choose("show", std::string(kQuantities.at(quantity)), kQuantities, chosen)) {
    style.quantity = static_cast<Quantity>(chosen);
    viewer.update_view();
  }
  const auto map = static_cast<std::size_t>(style.map);
  if (has_scale(style.quantity) &&
      choose("colours", std::string(kColourMaps.at(map)), kColourMaps, chosen)) {
    style.map = static_cast<ColourMap>(chosen);
    viewer.update_view();
  }
  constexpr float kMax = 8.0F;
  if (ImGui::SliderFloat("points", &style.point_size, 1.0F, kMax, "%.0f px")) {
    viewer.update_view();
  }
}

void show_time(Viewer& viewer) {
  if (viewer.snapshot() == nullptr) return;
  const Frame& frame = viewer.snapshot()->frame;
  text(fmt::format("frame {}, {:.3f} s", frame.number, static_cast<double>(frame.stamp_ns) / 1e9));
  if (viewer.is_moving()) {
    if (ImGui::Button(viewer.is_playing() ? "pause (space)" : "play (space)")) viewer.toggle_play();
    ImGui::SameLine();
  }
  if (ImGui::Button("reset (r)")) viewer.reset();
  ImGui::SameLine();
  if (ImGui::Button("save (s)")) viewer.save();
}

void show_help() {
  if (!ImGui::CollapsingHeader("Keys and mouse")) return;
  wrapped(
      "s save cloud and transform\n"
      "+ - move the sensor nearer, farther\n"
      "space pause, r reset, Esc quit\n"
      "f frame the selected object in both views\n"
      "left view: drag rotates the selected object, wheel moves the sensor, click traces a beam\n"
      "right view: drag orbits, right drag pans, wheel zooms, click traces a point\n"
      "a click on a point selects its object\n"
      "drop a model or scene file to open it");
}

/// A colour and its meaning; the next entry is in the same line if it fits.
void show_entry(const LegendEntry& entry, bool is_last) {
  const float height = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + height, at.y + height),
                                            packed(entry.colour));
  ImGui::Dummy(ImVec2(height, height));
  ImGui::SameLine();
  text(entry.text);
  const float full = ImGui::GetWindowPos().x + 0.6F * ImGui::GetWindowWidth();
  if (!is_last && ImGui::GetItemRectMax().x < full) ImGui::SameLine();
}

/// The colour map with the ends of the scale.
void show_scale(const ViewStyle& style, const SensorPicture& picture) {
  const auto [low, high] = scale_ends(picture.scale, unit_of(style.quantity));
  text(low);
  ImGui::SameLine();
  constexpr int kSteps = 64;
  const float height = ImGui::GetTextLineHeight();
  const float width = 0.5F * ImGui::GetWindowWidth() / kSteps;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    const double shade = style.quantity == Quantity::intensity ? t : 1.0 - t;
    const float left = at.x + width * static_cast<float>(i);
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(left, at.y),
                                              ImVec2(left + width, at.y + height),
                                              packed(colour_of(style.map, shade)));
  }
  ImGui::Dummy(ImVec2(width * kSteps, height));
  ImGui::SameLine();
  text(high);
}

}  // namespace

void show_controls(Viewer& viewer) {
  wrapped(viewer.request().flags->input);
  constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
  ImGui::PushItemWidth(ImGui::GetFontSize() * 12.0F);
  if (ImGui::CollapsingHeader("Sensor", kOpen)) show_sensor(viewer);
  if (ImGui::CollapsingHeader("Objects", kOpen)) show_objects(viewer);
  if (ImGui::CollapsingHeader("View", kOpen)) show_view_style(viewer);
  if (ImGui::CollapsingHeader("Time", kOpen)) show_time(viewer);
  show_help();
  ImGui::PopItemWidth();
}

void show_status(const Viewer& viewer, const FrameRate& rate) {
  std::string line = fmt::format("{:.0f} frames/s", rate.frames_per_s);
  if (viewer.snapshot() != nullptr) {
    const FrameSummary& s = viewer.summary();
    line +=
        fmt::format(" | measured in {:.1f} ms | {} hits", 1e3 * viewer.snapshot()->seconds, s.hits);
    if (s.hits > 0) line += fmt::format(", {:.6g} to {:.6g} m", s.nearest_m, s.farthest_m);
  }
  text(line);
  text(viewer.busy().empty() ? viewer.message : viewer.busy() + " ...");
}

void show_errors(Viewer& viewer) {
  for (const std::string& error : viewer.errors) wrapped(error);
  if (ImGui::Button("close")) viewer.errors.clear();
}

void show_trace(Viewer& viewer) {
  if (ImGui::SmallButton("copy")) ImGui::SetClipboardText(viewer.trace.c_str());
  ImGui::SameLine();
  if (ImGui::SmallButton("close")) {
    viewer.pick({});
    return;
  }
  ImGui::BeginChild("words", ImVec2(0.0F, 0.0F), false, ImGuiWindowFlags_HorizontalScrollbar);
  text(viewer.trace);
  ImGui::EndChild();
}

void show_legend(const Viewer& viewer) {
  const SensorPicture& picture = viewer.picture();
  if (!has_scale(viewer.style.quantity)) {
    for (const LegendEntry& entry : picture.legend)
      show_entry(entry, &entry == &picture.legend.back());
  } else if (!picture.scale.has_values) {
    text("no returns");
  } else {
    show_scale(viewer.style, picture);
  }
}

}  // namespace glidar::app
