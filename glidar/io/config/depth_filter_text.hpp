// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/depth_filters.hpp>

#include <string>
#include <vector>

namespace glidar {

/// The filters of a map with the key `depth_filters` in YAML or JSON, in which a filter is a map
/// with its keys. Throws Error that names the key, what is allowed and the nearest known word.
std::vector<DepthFilter> parse_depth_filters(const std::string& text);

/// A filter as options spell it: "spatial,alpha=0.6,delta=8". Throws Error as
/// parse_depth_filters() does.
DepthFilter parse_depth_filter(const std::string& text);

/// Filters as parse_depth_filters() reads them, in JSON.
std::string depth_filters_document(const std::vector<DepthFilter>& filters);

}  // namespace glidar
