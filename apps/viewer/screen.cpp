// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/screen.hpp>

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace glidar::app {
namespace {

constexpr ImU32 kMarkColour = IM_COL32(255, 60, 200, 255);

constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings;

struct Area {
  float x;
  float y;
  float width;
  float height;
};

/// RAII: a panel at a fixed position.
class Panel {
 public:
  Panel(const char* title, const Area& area, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(ImVec2(area.x, area.y));
    ImGui::SetNextWindowSize(ImVec2(area.width, area.height));
    ImGui::Begin(title, nullptr, kFixed | more);
  }
  ~Panel() { ImGui::End(); }
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
};

/// Whether the last item was clicked with the left button, without a drag.
bool is_clicked() {
  constexpr float kStill = 4.0F;  // pixels of motion within a click
  const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0.0F);
  return ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
         std::abs(moved.x) <= kStill && std::abs(moved.y) <= kStill;
}

/// The motion of the mouse since the last frame in heights of the last item, while this button
/// drags it.
Eigen::Vector2d dragged(ImGuiMouseButton button) {
  if (!ImGui::IsItemActive() || !ImGui::IsMouseDragging(button)) return Eigen::Vector2d::Zero();
  const ImVec2 by = ImGui::GetIO().MouseDelta;
  const double height = std::max(1.0F, ImGui::GetItemRectSize().y);
  return {by.x / height, by.y / height};
}

/// The area of the sensor's image, as large as fits. Pixels are square, except that the rows of
/// wide scanner images are stretched.
Area fit_picture(const BeamPicture& layout, const ImVec2& corner, const ImVec2& room) {
  const float cols = std::max<float>(1.0F, static_cast<float>(layout.cols));
  const float rows = std::max<float>(1.0F, static_cast<float>(layout.rows));
  constexpr float kWidest = 2.5F;  // width / height
  const bool is_grid = layout.kind == BeamPicture::Kind::grid;
  const float shape = is_grid ? std::clamp(cols / rows, 0.5F, kWidest) : cols / rows;
  const float width = std::max(1.0F, std::min(room.x, room.y * shape));
  const float height = width / shape;
  return {corner.x + 0.5F * (room.x - width), corner.y + 0.5F * (room.y - height), width, height};
}

/// A pixel that shows the beam; empty: none.
std::optional<std::size_t> pixel_of(const BeamPicture& layout, std::size_t beam) {
  if (layout.beams.empty()) return beam - layout.first;
  const auto found = std::find(layout.beams.begin(), layout.beams.end(), beam);
  if (found == layout.beams.end()) return std::nullopt;
  return static_cast<std::size_t>(found - layout.beams.begin());
}

ImTextureID texture_id(GLuint name) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui takes a number of OpenGL as a pointer
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(name));
}

}  // namespace

void Screen::upload(const Viewer& viewer) {
  if (uploaded_ == viewer.version() || viewer.snapshot() == nullptr) return;
  uploaded_ = viewer.version();
  upload_picture(viewer.picture());
  upload_points(viewer);
  cloud_.set_lines(viewer.guides());
}

void Screen::upload_picture(const SensorPicture& picture) {
  constexpr std::size_t kMax = 4096;  // pixels; every device supports such textures
  const BeamPicture& layout = picture.layout;
  const std::size_t step_x = std::max<std::size_t>(1, (layout.cols + kMax - 1) / kMax);
  const std::size_t step_y = std::max<std::size_t>(1, (layout.rows + kMax - 1) / kMax);
  std::vector<Colour> thinned;
  for (std::size_t row = 0; row < layout.rows; row += step_y) {
    for (std::size_t col = 0; col < layout.cols; col += step_x) {
      const std::uint32_t beam = layout.beam_at(row * layout.cols + col);
      thinned.push_back(beam == BeamPicture::kNoBeam ? kPlotGround : picture.colours[beam]);
    }
  }
  const auto width = static_cast<GLsizei>((layout.cols + step_x - 1) / step_x);
  const auto height = static_cast<GLsizei>((layout.rows + step_y - 1) / step_y);
  glBindTexture(GL_TEXTURE_2D, sensor_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE,
               thinned.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void Screen::upload_points(const Viewer& viewer) {
  constexpr std::size_t kMax = 2'000'000;  // software rendering stays interactive
  const std::vector<Eigen::Vector3f>& all = viewer.points();
  shown_one_of_ = std::max<std::size_t>(1, (viewer.summary().hits + kMax - 1) / kMax);
  std::vector<ColouredVertex> points;
  points.reserve(viewer.summary().hits / shown_one_of_ + 1);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::isnan(all[i].x()) || hits++ % shown_one_of_ != 0) continue;
    points.push_back({.position_m = all[i], .colour = viewer.picture().colours[i]});
  }
  cloud_.set_points(points);
}

void Screen::draw_cloud(const Viewer& viewer, int width, int height) {
  const CloudView style{
      .width = width,
      .height = height,
      .clip_from_anchor = clip_from_anchor(viewer.style.orbit, static_cast<double>(width) / height),
      .point_size = viewer.style.point_size};
  const bool is_same = drawn_version_ == viewer.version() && style.width == drawn_.width &&
                       style.height == drawn_.height && style.point_size == drawn_.point_size &&
                       style.clip_from_anchor == drawn_.clip_from_anchor;
  if (is_same) return;
  cloud_.draw(style);
  drawn_ = style;
  drawn_version_ = viewer.version();
}

void Screen::show_sensor_view(Viewer& viewer) {
  if (viewer.snapshot() == nullptr) return;
  const BeamPicture& layout = viewer.picture().layout;
  ImVec2 room = ImGui::GetContentRegionAvail();
  room.y = std::max(1.0F, room.y - 2.0F * ImGui::GetTextLineHeightWithSpacing());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const Area area = fit_picture(layout, corner, room);
  const ImVec2 first(area.x, area.y);
  const ImVec2 last(area.x + area.width, area.y + area.height);
  ImGui::SetCursorScreenPos(first);
  ImGui::InvisibleButton("sensor", ImVec2(area.width, area.height));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddImage(texture_id(sensor_.name()), first, last);
  use_mouse_on_sensor(viewer);
  if (const auto pixel = viewer.picked() ? pixel_of(layout, *viewer.picked()) : std::nullopt) {
    const auto col = static_cast<float>(*pixel % layout.cols);
    const std::size_t whole_row = *pixel / layout.cols;
    const auto row = static_cast<float>(whole_row);
    const float x = area.x + (col + 0.5F) * area.width / static_cast<float>(layout.cols);
    const float y = area.y + (row + 0.5F) * area.height / static_cast<float>(layout.rows);
    draw.AddCircle(ImVec2(x, y), 7.0F, kMarkColour, 0, 2.0F);
  }
  if (viewer.selection_visibility() == Visibility::outside) {
    const std::string hint = viewer.selected_name() + " is outside this image: press f to frame it";
    draw.AddText(ImVec2(area.x + 6.0F, area.y + 4.0F), kMarkColour, hint.c_str());
  }
  ImGui::SetCursorScreenPos(ImVec2(corner.x, corner.y + room.y));
  show_legend(viewer);
}

void Screen::use_mouse_on_sensor(Viewer& viewer) {
  const Eigen::Vector2d drag = dragged(ImGuiMouseButton_Left);
  if (drag != Eigen::Vector2d::Zero()) viewer.rotate_objects(drag);
  if (ImGui::IsItemHovered() && ImGui::GetIO().MouseWheel != 0.0F) {
    viewer.step_sensor(ImGui::GetIO().MouseWheel);
  }
  if (!is_clicked()) return;
  const BeamPicture& layout = viewer.picture().layout;
  const ImVec2 first = ImGui::GetItemRectMin();
  const ImVec2 size = ImGui::GetItemRectSize();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double col = std::floor((mouse.x - first.x) / size.x * static_cast<float>(layout.cols));
  const double row = std::floor((mouse.y - first.y) / size.y * static_cast<float>(layout.rows));
  if (col < 0.0 || row < 0.0 || col >= layout.cols || row >= layout.rows) return;
  const std::uint32_t beam =
      layout.beam_at(static_cast<std::size_t>(row) * layout.cols + static_cast<std::size_t>(col));
  if (beam != BeamPicture::kNoBeam) viewer.pick(beam);
}

void Screen::show_cloud_view(Viewer& viewer) {
  if (viewer.snapshot() == nullptr) return;
  ImVec2 room = ImGui::GetContentRegionAvail();
  room.x = std::max(1.0F, room.x);
  room.y = std::max(1.0F, room.y - 2.0F * ImGui::GetTextLineHeightWithSpacing());
  const ImVec2 first = ImGui::GetCursorScreenPos();
  const ImVec2 last(first.x + room.x, first.y + room.y);
  ImGui::InvisibleButton("cloud", room,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  viewer.style.aspect = static_cast<double>(room.x) / static_cast<double>(room.y);
  use_mouse_on_cloud(viewer);
  draw_cloud(viewer, static_cast<int>(room.x), static_cast<int>(room.y));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddImage(texture_id(cloud_.texture()), first, last, ImVec2(0.0F, 1.0F), ImVec2(1.0F, 0.0F));
  const bool is_marked = viewer.picked() && !std::isnan(viewer.points()[*viewer.picked()].x());
  if (is_marked) {
    const Eigen::Vector3f at = viewer.points()[*viewer.picked()];
    const Eigen::Vector4f clip =
        clip_from_anchor(viewer.style.orbit, static_cast<double>(room.x) / room.y) *
        at.homogeneous();
    const ImVec2 place(first.x + 0.5F * room.x * (1.0F + clip.x() / clip.w()),
                       first.y + 0.5F * room.y * (1.0F - clip.y() / clip.w()));
    if (clip.w() > 0.0F) draw.AddCircle(place, 7.0F, kMarkColour, 0, 2.0F);
  }
  ImGui::Text("grid %g m; axes x red, y green, z blue", viewer.style.grid_m);
  if (shown_one_of_ > 1) ImGui::Text("1 of %zu points is drawn", shown_one_of_);
}

void Screen::use_mouse_on_cloud(Viewer& viewer) {
  Orbit& orbit = viewer.style.orbit;
  const double distance_before_m = orbit.distance_m;
  turn(orbit, dragged(ImGuiMouseButton_Left));
  pan(orbit, dragged(ImGuiMouseButton_Right) + dragged(ImGuiMouseButton_Middle));
  if (ImGui::IsItemHovered()) zoom(orbit, static_cast<double>(ImGui::GetIO().MouseWheel));
  if (orbit.distance_m != distance_before_m) viewer.update_view();  // the grid changes
  if (!is_clicked()) return;
  constexpr double kReach = 0.01;  // heights
  const ImVec2 first = ImGui::GetItemRectMin();
  const ImVec2 size = ImGui::GetItemRectSize();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Eigen::Vector2d place((2.0 * (mouse.x - first.x) - size.x) / size.y,
                              (size.y - 2.0 * (mouse.y - first.y)) / size.y);
  const auto point = point_at(orbit, viewer.points(), place, kReach);
  if (point) viewer.pick(point);
}

void Screen::show(Viewer& viewer, const WindowSize& size, const FrameRate& rate) {
  upload(viewer);
  const auto width = static_cast<float>(size.width);
  const auto height = static_cast<float>(size.height);
  const float line = 2.0F * ImGui::GetFrameHeightWithSpacing();
  const float controls = std::min(23.0F * ImGui::GetFontSize(), 0.5F * width);
  const float errors = viewer.errors.empty() ? 0.0F : std::min(0.25F * height, 4.0F * line);
  const float trace = viewer.trace.empty() ? 0.0F : 0.4F * height;
  const float views = std::max(1.0F, height - line - errors - trace);
  const float half = std::max(1.0F, 0.5F * (width - controls));
  {
    const Panel panel("GLIDAR", {0.0F, 0.0F, controls, height - line});
    show_controls(viewer);
  }
  {
    const Panel panel("What the sensor sees", {controls, errors, half, views});
    show_sensor_view(viewer);
  }
  {
    const Panel panel("Point cloud", {controls + half, errors, half, views});
    show_cloud_view(viewer);
  }
  if (errors > 0.0F) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(110, 25, 25, 255));
    const Panel panel("Errors", {controls, 0.0F, width - controls, errors});
    ImGui::PopStyleColor();
    show_errors(viewer);
  }
  if (trace > 0.0F) {
    const Panel panel("Point trace", {controls, errors + views, width - controls, trace});
    show_trace(viewer);
  }
  const Panel panel("status", {0.0F, height - line, width, line},
                    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar);
  show_status(viewer, rate);
}

}  // namespace glidar::app
