// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io: how numbers are written into JSON files.

#include <nlohmann/json.hpp>

namespace glidar {

/// The components of an Eigen vector.
template <class Vector>
nlohmann::ordered_json vector_json(const Vector& v) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (decltype(v.size()) i = 0; i < v.size(); ++i) list.push_back(v[i]);
  return list;
}

/// Writes 0.0 for every -0.0 in the document.
void remove_negative_zeros(nlohmann::ordered_json& json);

}  // namespace glidar
