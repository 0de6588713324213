// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/texture_search.hpp>

#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glidar {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kPlaces = {"", "textures", "materials/textures",
                                                     "../materials/textures", "../textures"};
/// Of names that are paths.
constexpr std::array<std::string_view, 3> kSchemes = {"file://", "model://", "package://"};
constexpr std::string_view kPadding = " \t\r\n\v\f\"";
constexpr std::size_t kMaxTextureName = 4096;  // PATH_MAX of Linux

std::string base_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

bool is_absolute(const std::string& path) {
  return path.starts_with('/') || (path.size() > 1 && path[1] == ':');
}

/// The name without padding and scheme, with slashes.
std::string tidied(const std::string& name) {
  std::string tidy(trimmed(name, kPadding));
  std::replace(tidy.begin(), tidy.end(), '\\', '/');
  for (const std::string_view scheme : kSchemes) {
    if (tidy.starts_with(scheme)) return tidy.substr(scheme.size());
  }
  return tidy;
}

/// The names to search for, the model's own first.
std::vector<std::string> spellings(const std::string& name) {
  const std::string tidy = tidied(name);
  std::vector<std::string> all;
  const auto add = [&all](std::string spelling) {
    if (spelling.empty()) return;
    if (is_absolute(spelling)) spelling = base_name(spelling);
    if (!spelling.empty() && std::find(all.begin(), all.end(), spelling) == all.end()) {
      all.push_back(std::move(spelling));
    }
  };
  add(name);
  add(tidy);
  add(percent_decoded(name));
  add(percent_decoded(tidy));
  for (std::size_t i = 0, count = all.size(); i < count; ++i) add(base_name(all[i]));
  // Material files put options before the name, and importers keep those that they do not know.
  const std::size_t option = tidy.find(" -");
  if (option != std::string::npos) add(tidy.substr(tidy.find_last_of(' ') + 1));
  return all;
}

bool has_scheme(std::string_view name) {
  return name.find("://") != std::string_view::npos &&
         std::none_of(kSchemes.begin(), kSchemes.end(),
                      [name](std::string_view scheme) { return name.starts_with(scheme); });
}

/// The last components of the name, most of them first: of "../a/b.png" a/b.png and b.png.
std::vector<fs::path> endings(const std::string& name) {
  std::vector<fs::path> all;
  constexpr std::ptrdiff_t kMost = 16;  // components
  const std::string tidy = tidied(name);
  for (const std::string& spelling : {tidy, percent_decoded(tidy)}) {
    const fs::path path = fs::path(spelling).lexically_normal().relative_path();
    for (auto from = path.begin(); from != path.end(); ++from) {
      if (*from == ".." || std::distance(from, path.end()) > kMost) continue;
      fs::path ending;
      for (auto part = from; part != path.end(); ++part) ending /= *part;
      all.push_back(std::move(ending));
    }
  }
  return all;
}

/// Folders to search, in this order.
std::vector<fs::path> places(const ModelFolder& folder) {
  std::vector<fs::path> all;
  for (const std::string_view place : kPlaces) {
    if (!place.starts_with("..") || folder.root != folder.folder)
      all.push_back(folder.folder / place);
  }
  all.insert(all.end(), folder.material_folders.begin(), folder.material_folders.end());
  return all;
}

}  // namespace

std::string percent_decoded(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const std::string digits = text[i] == '%' ? text.substr(i + 1, 2) : "";
    const char* const end = digits.data() + digits.size();
    const bool is_code =
        digits.size() == 2 && std::from_chars(digits.data(), end, code, 16).ptr == end;
    decoded += is_code ? static_cast<char>(code) : text[i];
    if (is_code) i += 2;
  }
  return decoded;
}

TextureSearch::TextureSearch(ModelFolder folder) : folder_(std::move(folder)) {}

fs::path TextureSearch::any_case(const fs::path& place, const std::string& base) {
  const auto [listing, is_new] = listings_.try_emplace(place);
  auto& names = listing->second;
  std::error_code error;
  for (fs::directory_iterator entry(is_new ? place : fs::path(), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto [known, first] = names.try_emplace(lower_case(name), name);
    if (!first) known->second = std::min(known->second, name);
  }
  const auto match = names.find(lower_case(base));
  return match == names.end() ? fs::path() : place / match->second;
}

TextureLookup TextureSearch::find(const std::string& name) {
  TextureLookup result{name, "", "not found"};
  if (name.size() > kMaxTextureName) return {name, "", "the name is too long for a file"};
  if (has_scheme(trimmed(name, kPadding))) return {name, "", "network addresses are not followed"};
  if (name.find("://") != std::string::npos && !name.starts_with("file://")) {
    result.reason = "not found; name the folder of its package with --texture-folder";
  } else if (is_absolute(tidied(name))) {
    result.reason =
        "not found; name a folder above it with --texture-folder, or copy it into the "
        "model's folder";
  }
  const std::vector<std::string> wanted = spellings(name);
  const auto take = [&](const fs::path& path) {
    const ConfinedFile file = confine(path, folder_);
    if (file.access == Access::granted) result = {name, file.path.string(), ""};
    if (file.access == Access::outside || file.access == Access::not_a_file) {
      result.reason = reason(file.access);
    }
    return file.access == Access::granted;
  };
  std::vector<fs::path> look_in = places(folder_);
  for (const std::string& spelling : wanted) {
    for (const fs::path& place : look_in) {
      if (take(place / spelling)) return result;
    }
  }
  const std::vector<fs::path>& others = folder_.texture_folders;
  for (const fs::path& ending : others.empty() ? std::vector<fs::path>() : endings(name)) {
    for (const fs::path& place : others) {
      if (take(place / ending)) return result;
    }
  }
  look_in.insert(look_in.end(), others.begin(), others.end());
  for (const fs::path& place : look_in) {
    for (const std::string& spelling : wanted) {
      const fs::path match = any_case(place, base_name(spelling));
      if (!match.empty() && take(match)) return result;
    }
  }
  return result;
}

}  // namespace glidar
