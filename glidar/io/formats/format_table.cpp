// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace glidar {

const std::vector<Format>& formats() {
  // clang-format off
  static const std::vector<Format> kFormats = {
      pcd_format(),
      ply_format(),
      npz_format(),
      csv_format(),
      las_format(),
      kitti_format(),
      kitti_folder_format(),
      npy_format(),
      depth_npy_format(),
      range_npy_format(),
      depth_png_format(),
      range_png_format(),
      woods2016_png_format(),
      preview_format(),
      transform_format(),
      bird_eye_format(),
      perspective_format(),
      depth_tiff_format(),
      rgb_png_format(),
      normal_png_format(),
      instance_png_format(),
      class_png_format(),
      exr_format(),
      ir_left_png_format(),
      ir_right_png_format(),
      ir_reference_png_format(),
      ir_png_format(),
      tof_npy_format(),
      patterns_npy_format(),
  };
  // clang-format on
  return kFormats;
}

namespace {

const Format& entry_of(const FileFormat& format) {
  return find_format("name" + format.suffix);
}

std::filesystem::path without_separators(const std::filesystem::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

/// The format with the longest suffix that a name has; null: none.
const Format* matching_format(const std::filesystem::path& path) {
  const std::string name = lower_case(without_separators(path).filename().string());
  const Format* best = nullptr;
  for (const Format& format : formats()) {
    const std::string& suffix = format.info.suffix;
    if (name.size() <= suffix.size() || !name.ends_with(suffix)) continue;
    if (best == nullptr || suffix.size() > best->info.suffix.size()) best = &format;
  }
  return best;
}

/// Refuses names such as a.dept.png, which would be a picture although another image was meant. The
/// part before the suffix may be a number, a letter, or the suffix of a model.
void require_known_kind(const std::filesystem::path& path, const Format& format) {
  constexpr std::array<std::string_view, 10> kModels = {".obj", ".ply", ".stl", ".off",  ".gltf",
                                                        ".glb", ".dae", ".fbx", ".yaml", ".yml"};
  const std::string& suffix = format.info.suffix;
  std::string stem = without_separators(path).filename().string();
  stem.resize(stem.size() - suffix.size());
  const std::string kind = lower_case(std::filesystem::path(stem).extension().string());
  const bool is_word =
      kind.size() > 2 &&
      kind.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 1) == std::string::npos &&
      std::ranges::find(kModels, kind) == kModels.end();
  std::vector<std::string> known;
  for (const Format& other : formats()) {
    if (other.info.suffix.ends_with(suffix) && other.info.suffix != suffix)
      known.push_back(other.info.suffix);
  }
  if (!is_word || known.empty()) return;
  const std::string nearest = closest_match(kind + suffix, known);
  throw Error({path.string(), fmt::format("no format has the suffix {}", excerpt(kind + suffix)),
               fmt::format("{} {}", suffix, fmt::join(known, " ")),
               (nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest)) +
                   "use another character than the dot for a name"});
}

}  // namespace

CloudSize size_of_run(const RunTotals& totals, std::size_t times) {
  constexpr std::size_t kMaxDigits = 20;
  const std::size_t spaces = times * (kMaxDigits - std::to_string(totals.points).size());
  return {1, totals.points, std::string(spaces, ' ')};
}

bool takes_runs(const std::filesystem::path& path, const FileSinkOptions& options) {
  const Format& format = find_format(path);
  const bool is_packed =
      format.info.suffix == ".pcd" && options.pcd == PcdEncoding::binary_compressed;
  return format.append != nullptr && !is_packed && options.layout.empty();
}

std::filesystem::path output_path(const std::filesystem::path& path) {
  return find_format(path).info.is_folder ? without_separators(path) : path;
}

const Format& find_format(const std::filesystem::path& path) {
  const Format* format = matching_format(path);
  if (format == nullptr) refuse_suffix(path, {});
  require_known_kind(path, *format);
  return *format;
}

bool has_format(const std::filesystem::path& path) {
  return matching_format(path) != nullptr;
}

void refuse_suffix(const std::filesystem::path& given, const std::vector<std::string>& others) {
  const std::string suffix = lower_case(without_separators(given).extension().string());
  std::vector<std::string> all;
  for (const Format& format : formats()) all.push_back(format.info.suffix);
  all.insert(all.end(), others.begin(), others.end());
  const std::string nearest = suffix.empty() ? "" : closest_match(suffix, all);
  constexpr std::array<std::string_view, 6> kVideos = {".mp4", ".mkv", ".mov",
                                                       ".avi", ".gif", ".webm"};
  if (std::ranges::find(kVideos, suffix) != kVideos.end()) {
    throw Error({given.string(), "a video", "pictures, which ffmpeg joins",
                 "write numbered pictures, -o frame.png --duration 2, and run: ffmpeg -framerate "
                 "10 -i frame_%06d.png -pix_fmt yuv420p " +
                     excerpt(given.string())});
  }
  throw Error({given.string(),
               suffix.empty() ? "the name has no suffix that selects a format"
                              : fmt::format("no format has the suffix {}", excerpt(suffix)),
               fmt::format("{}", fmt::join(all, " ")),
               nearest.empty() ? "" : fmt::format("did you mean {}?", nearest)});
}

std::span<const FileFormat> file_formats() {
  static const std::vector<FileFormat> kInfos = [] {
    std::vector<FileFormat> infos;
    for (const Format& format : formats()) infos.push_back(format.info);
    return infos;
  }();
  return kInfos;
}

const FileFormat& format_for(const std::filesystem::path& path) {
  return find_format(path).info;
}

std::string all_suffixes() {
  std::string text;
  for (const Format& format : formats()) text += (text.empty() ? "" : " ") + format.info.suffix;
  return text;
}

bool takes_layout(const std::filesystem::path& path) {
  const Format& format = find_format(path);
  return format.info.takes_more && format.content == Content::points;
}

std::string suffixes_with_layouts() {
  std::string text;
  for (const Format& format : formats()) {
    if (takes_layout("a" + format.info.suffix))
      text += (text.empty() ? "" : " ") + format.info.suffix;
  }
  return text;
}

std::string suffixes_with_columns() {
  std::string text;
  for (const Format& format : formats()) {
    if (format.info.takes_more) text += (text.empty() ? "" : " ") + format.info.suffix;
  }
  return text;
}

std::vector<std::string> needed_columns(const FileFormat& format) {
  std::vector<std::string> columns = format.columns;
  columns.insert(columns.end(), format.optional_columns.begin(), format.optional_columns.end());
  return columns;
}

bool is_text(const FileFormat& format, const FileSinkOptions& options) {
  const Format& entry = entry_of(format);
  return entry.is_text != nullptr && entry.is_text(options);
}

bool has_boxes(const FileFormat& format, const FileSinkOptions& options) {
  return format.reads_boxes || (options.sidecar && has_sidecar(entry_of(format)));
}

Misfit find_misfit(const FileFormat& format, const CloudPictureOptions& picture,
                   const Sensor& sensor, const Beams& beams) {
  const Format& entry = entry_of(format);
  return entry.misfit != nullptr ? entry.misfit(picture, sensor, beams) : Misfit{};
}

}  // namespace glidar
