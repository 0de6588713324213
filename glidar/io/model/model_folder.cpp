// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model_folder.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

namespace glidar {
namespace fs = std::filesystem;

bool is_inside(const fs::path& path, const fs::path& root) {
  const auto [in_root, in_path] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return in_root == root.end();
}

std::vector<fs::path> ModelFolder::allowed() const {
  std::vector<fs::path> all = {root};
  all.insert(all.end(), texture_folders.begin(), texture_folders.end());
  return all;
}

ModelFolder model_folder(const fs::path& canonical_model, std::vector<fs::path> texture_folders) {
  const fs::path folder = canonical_model.parent_path();
  const fs::path parent = folder.parent_path();
  std::error_code ignored;  // an inaccessible folder is not a package
  const bool package =
      fs::is_regular_file(parent / "model.config", ignored) ||
      (folder.filename() == "meshes" && fs::is_directory(parent / "materials", ignored));
  return {folder, package ? parent : folder, {}, std::move(texture_folders)};
}

ConfinedFile confine(const fs::path& wanted, const ModelFolder& folder) {
  if (wanted.native().find('\0') != std::string::npos) return {Access::absent, {}};
  const std::vector<fs::path> allowed = folder.allowed();
  const auto is_allowed = [&allowed](const fs::path& resolved) {
    return std::any_of(allowed.begin(), allowed.end(),
                       [&](const fs::path& one) { return is_inside(resolved, one); });
  };
  const fs::path path = folder.folder / wanted;
  const fs::path lexical = path.lexically_normal();
  std::error_code error;
  // After a symbolic link, "link/.." is the parent of the link's target.
  fs::path real = fs::canonical(path, error);
  // Models refer to missing folders ("..\\source\\..\\wood.png"); the normalised path may exist.
  if (error && is_allowed(lexical)) real = fs::canonical(lexical, error);
  if (error) return {is_allowed(lexical) ? Access::absent : Access::outside, {}};
  if (!is_allowed(real)) return {Access::outside, {}};
  if (!fs::is_regular_file(real, error) || error) return {Access::not_a_file, {}};
  return {Access::granted, real};
}

std::string reason(Access access) {
  switch (access) {
    case Access::granted:
      return "";
    case Access::absent:
      return "not found";
    case Access::outside:
      return "outside the model's folder; name its folder with --texture-folder, or copy it into "
             "the model's folder";
    case Access::not_a_file:
      return "not a file";
  }
  return "";
}

}  // namespace glidar
