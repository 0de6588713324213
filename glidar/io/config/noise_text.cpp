// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/noise_text.hpp>

#include <glidar/io/config/field_json.hpp>

namespace glidar {

std::string noise_text(const NoiseStep& step) {
  const nlohmann::ordered_json json = write_struct(FieldVisitor::Mode::report, step);
  std::string text;
  for (const auto& [key, value] : json.items()) {
    if (key == "type") {
      text = value.get<std::string>();
      continue;
    }
    text += (text.find(' ') == std::string::npos ? " " : ", ") + key + " ";
    text += value.is_string() ? value.get<std::string>() : value.dump();
  }
  return text;
}

}  // namespace glidar
