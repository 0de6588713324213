// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/config/depth_filter_text.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/core/field_visitor.hpp>
#include <glidar/io/config/field_json.hpp>
#include <glidar/io/config/yaml_field_reader.hpp>

#include <sstream>

namespace glidar {
namespace {

struct DepthFilterList {
  std::vector<DepthFilter> filters;
};

void describe(DepthFilterList& list, FieldVisitor& visitor) {
  visit_list(visitor, {"depth_filters", "in their order"}, {0, kMaxDepthFilters},
             "at most 64 filters", list.filters);
}

}  // namespace

std::vector<DepthFilter> parse_depth_filters(const std::string& text) {
  DepthFilterList list;
  read_struct(read_yaml_text("depth filters", text), list);
  return list.filters;
}

DepthFilter parse_depth_filter(const std::string& text) {
  std::istringstream words(text);
  std::string word;
  std::getline(words, word, ',');
  std::string map = "type: " + word + "\n";
  while (std::getline(words, word, ',')) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw Error({"", "'" + excerpt(word) + "' is no setting of a filter", "KEY=VALUE",
                   "write, for example, spatial,alpha=0.6,delta=8"});
    }
    map += word.substr(0, equals) + ": " + word.substr(equals + 1) + "\n";
  }
  DepthFilter filter;
  read_struct(read_yaml_text("depth filter '" + excerpt(text) + "'", map), filter);
  return filter;
}

std::string depth_filters_document(const std::vector<DepthFilter>& filters) {
  return write_struct(FieldVisitor::Mode::document, DepthFilterList{filters}).dump();
}

}  // namespace glidar
