// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/depth_camera/depth_filters.hpp>
#include <glidar/depth_camera/structured_light.hpp>
#include <glidar/sensor/depth_alignment.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace glidar {

/// The two cameras of a YAML file (docs/depth-filters.md). Throws Error with the place in the
/// file.
DepthAlignment load_depth_alignment(const std::filesystem::path& path);

/// The same of a text in YAML or JSON.
DepthAlignment parse_depth_alignment(const std::string& text);

/// The filters of a map with the key `depth_filters` in YAML or JSON, in which a filter is a map
/// with its keys. Throws Error that names the key, what is allowed and the nearest known word.
std::vector<DepthFilter> parse_depth_filters(const std::string& text);

/// A filter as options spell it: "spatial,alpha=0.6,delta=8". Throws Error as
/// parse_depth_filters() does.
DepthFilter parse_depth_filter(const std::string& text);

/// Filters as parse_depth_filters() reads them, in JSON.
std::string depth_filters_document(const std::vector<DepthFilter>& filters);

/// The camera, projector and patterns of a YAML file (docs/structured-light.md): a setup, or a
/// sensor with a depth_camera of type structured_light. Throws Error with the place in the file.
StructuredLight load_structured_light(const std::filesystem::path& path);

/// The same of a text in YAML or JSON.
StructuredLight parse_structured_light(const std::string& text);

}  // namespace glidar
