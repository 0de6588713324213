// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/frame.hpp>

#include <glidar/core/scene.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>

namespace glidar {

double occlusion(const ObjectBox& box) {
  if (box.beams == 0) return kNaN;
  return 1.0 - static_cast<double>(box.visible_beams) / static_cast<double>(box.beams);
}

Eigen::AlignedBox3d surface_bounds(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) box.extend(vertex_m(mesh, corner));
  }
  return box;
}

bool has_classes(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(),
                     [](const Instance& instance) { return instance.class_id != 0; });
}

std::string_view name(Status status) {
  switch (status) {
    case Status::hit:
      return "hit";
    case Status::miss:
      return "miss";
    case Status::too_near:
      return "too near";
    case Status::too_far:
      return "too far";
    case Status::invalid_pixel:
      return "invalid pixel";
    case Status::below_threshold:
      return "below threshold";
    case Status::dropped:
      return "dropped";
    case Status::occluded:
      return "occluded";
    case Status::phase_ambiguous:
      return "phase ambiguous";
    case Status::saturated:
      return "saturated";
    case Status::weather:
      return "weather";
    case Status::no_return_of_rank:
      return "no return of that rank";
    case Status::image_border:
      return "image border";
    case Status::no_texture:
      return "no texture";
    case Status::outside_search:
      return "outside the search";
    case Status::ambiguous_match:
      return "ambiguous match";
    case Status::left_right_mismatch:
      return "left-right mismatch";
    case Status::projector_shadow:
      return "projector shadow";
    case Status::transparent:
      return "transparent";
    case Status::filtered_edge:
      return "filtered edge";
    case Status::low_modulation:
      return "low modulation";
    case Status::weak_code:
      return "weak code";
    case Status::inconsistent_code:
      return "inconsistent code";
    case Status::outside_projector:
      return "outside projector";
  }
  return "unknown";
}

std::string_view name(ReturnSource source) {
  switch (source) {
    case ReturnSource::none:
      return "none";
    case ReturnSource::surface:
      return "surface";
    case ReturnSource::mixed_pixel:
      return "mixed pixel";
    case ReturnSource::ghost:
      return "ghost";
    case ReturnSource::false_alarm:
      return "false alarm";
    case ReturnSource::fog:
      return "fog";
    case ReturnSource::rain:
      return "rain";
    case ReturnSource::snow:
      return "snow";
    case ReturnSource::crosstalk:
      return "crosstalk";
  }
  return "unknown";
}

void invalidate_return(Frame& frame, std::size_t entry, Status why) {
  frame.status[entry] = why;
  frame.range_m[entry] = kNaN;
  frame.intensity[entry] = 0.0F;
  if (!frame.sigma_m.empty()) frame.sigma_m[entry] = 0.0F;
  if (!frame.radial_velocity_m_s.empty()) {
    frame.radial_velocity_m_s[entry] = kNaN;
  }
  if (!frame.return_source.empty()) frame.return_source[entry] = ReturnSource::none;
}

RngKey rng_key(const Frame& frame, Purpose purpose, std::size_t beam) {
  return {.seed = frame.seed,
          .sensor = frame.sensor_id,
          .frame = frame.number,
          .beam = static_cast<std::uint32_t>(beam),
          .purpose = purpose};
}

void resize(Frame& frame, std::size_t size) {
  frame.range_m.resize(size);
  frame.intensity.resize(size);
  frame.status.resize(size);
}

}  // namespace glidar
