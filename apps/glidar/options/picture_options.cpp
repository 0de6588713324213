// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/options/picture_options.hpp>

#include <apps/glidar/options/numbers.hpp>
#include <apps/glidar/options/option_kinds.hpp>
#include <apps/glidar/options/pose_options.hpp>
#include <glidar/core/error.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>

namespace glidar::app {
namespace {

/// "WxH" in pixels.
std::array<std::uint32_t, 2> parse_size(std::string_view option, const std::string& text) {
  std::array<std::uint32_t, 2> size = {};
  const char* const end = text.data() + text.size();
  const auto [cross, width_error] = std::from_chars(text.data(), end, size[0]);
  const bool has_cross = width_error == std::errc() && cross != end && *cross == 'x';
  const auto [last, height_error] = std::from_chars(has_cross ? cross + 1 : end, end, size[1]);
  const bool is_allowed = has_cross && height_error == std::errc() && last == end &&
                          std::min(size[0], size[1]) >= kMinPictureSide &&
                          std::max(size[0], size[1]) <= kMaxPictureSide;
  if (is_allowed) return size;
  throw Error({.where = std::string(option),
               .found = "'" + text + "'",
               .allowed = fmt::format("WIDTHxHEIGHT in pixels, each from {} to {}", kMinPictureSide,
                                      kMaxPictureSide),
               .remedy = "for example 1400x1000"});
}

}  // namespace

CloudPictureOptions picture_options(const OutputFlags& flags) {
  CloudPictureOptions options;
  const auto names = colour_by_names();
  options.colour_by = static_cast<ColourBy>(
      std::distance(names.begin(), std::find(names.begin(), names.end(), flags.colour_by)));
  if (!flags.picture_size.empty()) {
    const auto [width, height] = parse_size("--picture-size", flags.picture_size);
    options.width = width;
    options.height = height;
  }
  if (!flags.view_eye.empty()) options.eye_m = parse_position("--view-eye", flags.view_eye);
  if (!flags.view_target.empty())
    options.target_m = parse_position("--view-target", flags.view_target);
  if (options.eye_m && options.target_m && *options.eye_m == *options.target_m) {
    throw Error({.where = "--view-eye",
                 .found = "it is where the view looks at",
                 .allowed = "a place apart from --view-target",
                 .remedy = ""});
  }
  return options;
}

void add_picture_flags(CLI::App& command, OutputFlags& flags, const std::string& group) {
  const auto is_vector = [](std::string_view option, const std::string& text) {
    parse_position(option, text);
  };
  add_choice(
      command,
      {"--colour-by", "NAME", "Colour: height range intensity ring class instance [height]", group},
      {colour_by_names().begin(), colour_by_names().end()}, flags.colour_by);
  add_text(command,
           {"--picture-size", "WxH", "Size of .bev.png and .view.png in pixels [1400x1000]", group},
           flags.picture_size,
           [](std::string_view option, const std::string& text) { parse_size(option, text); });
  add_text(command,
           {"--view-eye", "X,Y,Z", "Camera of .view.png, m, axes of the cloud [all seen]", group},
           flags.view_eye, is_vector);
  add_text(command,
           {"--view-target", "X,Y,Z", "Point that this camera looks at, m [all seen]", group},
           flags.view_target, is_vector);
}

}  // namespace glidar::app
