// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/json_numbers.hpp>

namespace glidar {

void remove_negative_zeros(nlohmann::ordered_json& json) {
  if (json.is_number_float() && json.get<double>() == 0.0) json = 0.0;
  if (!json.is_structured()) return;
  for (nlohmann::ordered_json& part : json) remove_negative_zeros(part);
}

}  // namespace glidar
