// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidar {

/// Whether the objects of a class are things that are counted, such as cars; false for stuff that
/// is measured as a surface, such as roads, buildings and terrain. Plurals, capitals, spaces and
/// hyphens do not matter; unknown classes are countable.
bool is_countable(std::string_view class_name);

/// By class_id: whether the instances of the class have boxes; never those without a class, 0.
using BoxedClasses = std::vector<bool>;

/// The classes of these names, or all for "all"; no names: the countable ones. `class_names` are
/// those of the scene. Throws Error at `where` for a class that the scene does not have.
BoxedClasses boxed_classes(std::span<const std::string> class_names,
                           std::span<const std::string> names = {}, const std::string& where = {});

}  // namespace glidar
