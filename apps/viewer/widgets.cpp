// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/viewer/widgets.hpp>

#include <glidar/math/constants.hpp>

#include <apps/viewer/shown_numbers.hpp>
#include <glidar/core/axis_angle.hpp>
#include <glidar/math/portable.hpp>

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace glidar::app {
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

}  // namespace

void text(const std::string& line) {
  std::string shown = without_negative_zeros(line);
  replace_all("\u2265", ">=", shown);
  replace_all("\u2264", "<=", shown);
  ImGui::TextUnformatted(shown.c_str(), shown.c_str() + shown.size());
}

void wrapped(const std::string& line) {
  ImGui::PushTextWrapPos(0.0F);
  text(line);
  ImGui::PopTextWrapPos();
}

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

}  // namespace glidar::app
