// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/box_classes.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <algorithm>
#include <array>

namespace glidar {
namespace {

struct ClassKind {
  std::string_view name;
  bool is_countable;
};

/// Classes of Cityscapes, KITTI, nuScenes, SemanticKITTI and LAS: "things" and "stuff", as Kirillov
/// et al., "Panoptic Segmentation", CVPR 2019, call them.
constexpr std::array kClassKinds = {
    // clang-format off
    ClassKind{"car", true}, ClassKind{"van", true}, ClassKind{"truck", true},
    ClassKind{"bus", true}, ClassKind{"trailer", true}, ClassKind{"tram", true},
    ClassKind{"train", true}, ClassKind{"vehicle", true}, ClassKind{"bicycle", true},
    ClassKind{"motorcycle", true}, ClassKind{"person", true}, ClassKind{"pedestrian", true},
    ClassKind{"cyclist", true}, ClassKind{"rider", true}, ClassKind{"animal", true},
    ClassKind{"pole", true}, ClassKind{"tree", true}, ClassKind{"traffic_sign", true},
    ClassKind{"traffic_light", true}, ClassKind{"traffic_cone", true},

    ClassKind{"bridge", false}, ClassKind{"building", false}, ClassKind{"bush", false},
    ClassKind{"ceiling", false}, ClassKind{"column", false}, ClassKind{"curb", false},
    ClassKind{"driveable_surface", false}, ClassKind{"facade", false}, ClassKind{"fence", false},
    ClassKind{"field", false}, ClassKind{"floor", false}, ClassKind{"forest", false},
    ClassKind{"grass", false}, ClassKind{"ground", false}, ClassKind{"guard_rail", false},
    ClassKind{"hedge", false}, ClassKind{"high_vegetation", false}, ClassKind{"house", false},
    ClassKind{"kerb", false}, ClassKind{"lake", false}, ClassKind{"lane", false},
    ClassKind{"lane_marking", false}, ClassKind{"low_vegetation", false},
    ClassKind{"manmade", false}, ClassKind{"medium_vegetation", false},
    ClassKind{"other_flat", false}, ClassKind{"other_ground", false},
    ClassKind{"other_structure", false}, ClassKind{"parking", false},
    ClassKind{"pavement", false}, ClassKind{"rail", false}, ClassKind{"rail_track", false},
    ClassKind{"railway", false}, ClassKind{"river", false}, ClassKind{"road", false},
    ClassKind{"road_marking", false}, ClassKind{"road_surface", false}, ClassKind{"roof", false},
    ClassKind{"room", false}, ClassKind{"sand", false}, ClassKind{"sea", false},
    ClassKind{"sidewalk", false}, ClassKind{"sky", false}, ClassKind{"snow", false},
    ClassKind{"soil", false}, ClassKind{"street", false}, ClassKind{"structure", false},
    ClassKind{"terrain", false}, ClassKind{"track", false}, ClassKind{"tunnel", false},
    ClassKind{"vegetation", false}, ClassKind{"wall", false}, ClassKind{"water", false},
    // clang-format on
};

const ClassKind* find_kind(std::string_view name) {
  const auto* found = std::ranges::find(kClassKinds, name, &ClassKind::name);
  return found != kClassKinds.end() ? found : nullptr;
}

[[noreturn]] void refuse_class(const std::string& name, std::span<const std::string> known,
                               const std::string& where) {
  std::string allowed = "all";
  for (std::size_t i = 1; i < known.size(); ++i) allowed += ", " + excerpt(known[i]);
  const std::string nearest = closest_match(name, known);
  throw Error({where, "no object has the class '" + excerpt(name) + "'", allowed,
               nearest.empty() ? "" : "did you mean '" + excerpt(nearest) + "'?"});
}

}  // namespace

bool is_countable(std::string_view class_name) {
  std::string name = lower_case(class_name);
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '-'; }, '_');
  const ClassKind* kind = find_kind(name);
  if (kind == nullptr && name.ends_with('s')) {
    name.pop_back();
    kind = find_kind(name);
  }
  return kind == nullptr || kind->is_countable;
}

BoxedClasses boxed_classes(std::span<const std::string> class_names,
                           std::span<const std::string> names, const std::string& where) {
  BoxedClasses boxed(class_names.size());
  for (std::size_t i = 1; i < boxed.size() && names.empty(); ++i)
    boxed[i] = is_countable(class_names[i]);
  for (const std::string& name : names) {
    bool is_known = name == "all";
    for (std::size_t i = 1; i < boxed.size(); ++i) {
      if (name != class_names[i] && name != "all") continue;
      boxed[i] = true;
      is_known = true;
    }
    if (!is_known) refuse_class(name, class_names, where);
  }
  return boxed;
}

}  // namespace glidar
