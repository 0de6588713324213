// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/scene.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace glidar {
namespace {

void require(bool holds, const Instance& instance, std::string found, std::string allowed,
             std::string remedy = "") {
  if (holds) return;
  throw Error({.where = "instance '" + instance.name + "'",
               .found = std::move(found),
               .allowed = std::move(allowed),
               .remedy = std::move(remedy)});
}

/// The largest coordinate of a mesh, in the object frame.
double reach_of(const Mesh& mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  return box.isEmpty() ? 0.0 : box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

void validate_reach(const Instance& instance, double mesh_reach) {
  const double reach_m = instance.scale * mesh_reach;
  require(mesh_reach == 0.0 || (reach_m >= kMinReach_m && reach_m <= kMaxCoordinate_m), instance,
          "its vertices reach " + number_text(reach_m) + " m from its origin", "1e-30 m to 1e15 m",
          "choose another unit or scale, or an origin nearer to the vertices");
}

void validate(const Instance& instance, const Scene& scene) {
  require(instance.mesh < scene.meshes.size(), instance, "mesh " + std::to_string(instance.mesh),
          "an index of the scene's meshes");
  require(instance.scale >= kMinScale && instance.scale <= kMaxScale, instance,
          "scale " + number_text(instance.scale), "1e-15 to 1e15", "choose another unit or scale");
  require(is_rigid(instance.world_from_object), instance, "a pose that is not a rigid transform",
          "finite numbers and a rotation");
  require(is_within_reach(instance.world_from_object.translation()), instance,
          "a position too far away", "up to 1e15 m from the world's origin",
          "move the world's origin nearer to it");
  require(instance.class_id < scene.class_names.size(), instance,
          "class " + std::to_string(instance.class_id), "an index of the scene's class names");
  require(instance.materials.size() >= slot_count(scene.meshes[instance.mesh]), instance,
          std::to_string(instance.materials.size()) + " materials", "one per material slot");
  for (const std::uint32_t material : instance.materials) {
    require(material < scene.materials.size(), instance, "material " + std::to_string(material),
            "an index of the scene's materials");
  }
}

void validate(const Texture& texture) {
  constexpr std::size_t kMaxTexels = std::size_t{1} << 30U;
  const std::size_t texels = std::size_t{texture.width} * texture.height;
  const std::size_t size = texels * texture.channels;
  if (size > 0 && texture.channels <= 4 && texture.texels.size() == size && texels <= kMaxTexels) {
    return;
  }
  throw Error({.where = "texture '" + texture.name + "'",
               .found = std::to_string(texture.texels.size()) + " bytes, " +
                        std::to_string(texture.width) + " x " + std::to_string(texture.height) +
                        " texels",
               .allowed = "width x height x channels bytes, 1 to 4 channels, 1 to 2^30 texels"});
}

void validate(const TextureUse& use, const Scene& scene, const Material& material) {
  if (use.uv_set > 1) {
    throw Error({.where = "material '" + material.name + "'",
                 .found = "uv set " + std::to_string(use.uv_set),
                 .allowed = "0 or 1"});
  }
  if (!use.used() || static_cast<std::size_t>(use.texture) < scene.textures.size()) return;
  throw Error({.where = "material '" + material.name + "'",
               .found = "texture " + std::to_string(use.texture),
               .allowed = "an index of the scene's textures"});
}

}  // namespace

bool is_visible(const Instance& instance, std::uint32_t sensor_id) {
  const auto contains = [sensor_id](const std::vector<std::uint32_t>& ids) {
    return std::find(ids.begin(), ids.end(), sensor_id) != ids.end();
  };
  return (instance.visible_to.empty() || contains(instance.visible_to)) &&
         !contains(instance.hidden_from);
}

const Material& material_of(const Scene& scene, const Instance& instance, std::uint32_t triangle) {
  return scene.materials[instance.materials[material_slot(scene.meshes[instance.mesh], triangle)]];
}

Eigen::AlignedBox3d bounds(const Scene& scene) {
  Eigen::AlignedBox3d world;
  for (const Instance& instance : scene.instances) {
    const Eigen::AlignedBox3d object = bounds(scene.meshes[instance.mesh]);
    if (object.isEmpty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      world.extend(instance.world_from_object * (instance.scale * object.corner(type)));
    }
  }
  return world;
}

void validate(const Scene& scene) {
  if (scene.sources.size() != scene.meshes.size()) {
    throw Error({.where = "scene, sources",
                 .found = std::to_string(scene.sources.size()) + " entries",
                 .allowed = std::to_string(scene.meshes.size()) + " (one per mesh)"});
  }
  std::vector<double> reaches;
  for (const Mesh& mesh : scene.meshes) {
    validate(mesh);
    reaches.push_back(reach_of(mesh));
  }
  for (const Texture& texture : scene.textures) validate(texture);
  for (const Instance& instance : scene.instances) {
    validate(instance, scene);
    validate_reach(instance, reaches[instance.mesh]);
  }
  for (const Material& material : scene.materials) {
    validate(material.diffuse_texture, scene, material);
    validate(material.specular_texture, scene, material);
    validate(material.alpha_texture, scene, material);
    validate(material.normal_texture, scene, material);
    validate(material.noise_texture, scene, material);
    if (material.noise_scale >= 0.0F) continue;
    throw Error({.where = "material '" + material.name + "'",
                 .found = "noise scale " + std::to_string(material.noise_scale),
                 .allowed = "0 or more"});
  }
}

}  // namespace glidar
