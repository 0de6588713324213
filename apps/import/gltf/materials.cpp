// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/materials.hpp>

#include <import/gltf/data_uri.hpp>

#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace glidar::import::gltf {
namespace {

/// A number within limits; NaN cannot be in JSON.
float limited(double value, double low, double high) {
  return static_cast<float>(std::clamp(value, low, high));
}

/// A colour of 3 or more components, each 0..1.
Eigen::Vector3f colour_of(const std::vector<double>& numbers) {
  return {limited(numbers[0], 0.0, 1.0), limited(numbers[1], 0.0, 1.0),
          limited(numbers[2], 0.0, 1.0)};
}

/// Karis, Specular BRDF reference, 2013.
void set_highlights(const Eigen::Vector3f& reflectance, double roughness, Material& m) {
  constexpr double kMaxShininess = 128.0;
  const double r = std::clamp(roughness, 0.0, 1.0);
  const double r4 = std::max(r * r * r * r, 1e-6);
  m.specular = static_cast<float>(1.0 - r) * reflectance;
  m.shininess = limited(2.0 / r4 - 2.0, 0.0, kMaxShininess);
}

Wrap wrap_of(const Value& value) {
  constexpr std::size_t kClampToEdge = 33071;
  constexpr std::size_t kMirroredRepeat = 33648;
  constexpr std::size_t kRepeat = 10497;
  const std::size_t mode = value.count_or(kRepeat);
  if (mode == kClampToEdge) return Wrap::clamp;
  if (mode == kMirroredRepeat) return Wrap::mirror;
  if (mode != kRepeat) {
    value.refuse(fmt::format("{} is no wrapping mode (allowed: 33071, 33648, 10497)", mode));
  }
  return Wrap::repeat;
}

/// KHR_texture_transform: u' = offset + R S u in coordinates with v down, R turning
/// counter-clockwise in the image; the result is for v up.
void set_transform(const Value& transform, TextureUse& use) {
  const std::vector<double> offset = transform["offset"].numbers_or({0, 0});
  const std::vector<double> scale = transform["scale"].numbers_or({1, 1});
  const double angle = transform["rotation"].number_or(0.0);
  const double c = portable_cos(angle);
  const double s = portable_sin(angle);
  Eigen::Matrix2d turn;
  turn << c * scale[0], -s * scale[1], s * scale[0], c * scale[1];
  const Eigen::Vector2d moved(offset[0] + s * scale[1], 1.0 - offset[1] - c * scale[1]);
  if (!turn.cast<float>().allFinite() || !moved.cast<float>().allFinite()) {
    transform.refuse("its numbers are too large");
  }
  use.uv_scale_rotate = turn.cast<float>();
  use.uv_offset = moved.cast<float>();
}

class Reader {
 public:
  Reader(Document& document, Buffers& buffers, SourceModel& model)
      : document_(document), buffers_(buffers), model_(model) {}

  void read(const Value& source) {
    SourceMaterial to;
    to.material.name = source["name"].text_or("");
    if (to.material.name.empty()) to.material.name = Material().name;
    read_colours(source, to);
    read_alpha(source, to);
    read_normals(source["normalTexture"], to);
    note_left_out(source);
    to.material.ambient = to.material.diffuse;
    uv_sets.push_back(place_sets(source, to));
    model_.materials.push_back(std::move(to));
  }

  std::vector<UvSets> uv_sets;

 private:
  void read_colours(const Value& source, SourceMaterial& to) {
    const Value glossiness = source.extension("KHR_materials_pbrSpecularGlossiness");
    if (glossiness) {
      read_glossiness(glossiness, to);
      if (source["pbrMetallicRoughness"]) {
        note("KHR_materials_pbrSpecularGlossiness replaces pbrMetallicRoughness");
      }
    } else {
      read_metallic(source, to);
    }
    if (!source.extension("KHR_materials_unlit")) return;
    to.material.specular.setZero();
    to.specular.reset();
  }

  void read_metallic(const Value& source, SourceMaterial& to) {
    const Value pbr = source["pbrMetallicRoughness"];
    const Value specular = source.extension("KHR_materials_specular");
    set_base(pbr["baseColorFactor"], pbr["baseColorTexture"], to);
    const double ior = source.extension("KHR_materials_ior")["ior"].number_or(1.5);
    // An index of 0 is full reflection (KHR_materials_ior).
    const double root = ior == 0.0 ? 1.0 : (ior - 1.0) / (ior + 1.0);
    const double strength = specular["specularFactor"].number_or(1.0);
    const std::vector<double> tint = specular["specularColorFactor"].numbers_or({1, 1, 1});
    Eigen::Vector3f dielectric;
    for (int k = 0; k < 3; ++k) {
      const double reflected = std::min(root * root * tint[static_cast<std::size_t>(k)], 1.0);
      dielectric[k] = limited(reflected * strength, 0.0, 1.0);
    }
    const float metallic = limited(pbr["metallicFactor"].number_or(1.0), 0.0, 1.0);
    const Eigen::Vector3f reflectance = dielectric + metallic * (to.material.diffuse - dielectric);
    set_highlights(reflectance, pbr["roughnessFactor"].number_or(1.0), to.material);
    leave_out(pbr["metallicRoughnessTexture"], "textures of metal and roughness are left out");
    leave_out(specular["specularTexture"], "textures of KHR_materials_specular are left out");
    leave_out(specular["specularColorTexture"], "textures of KHR_materials_specular are left out");
  }

  void read_glossiness(const Value& pbr, SourceMaterial& to) {
    set_base(pbr["diffuseFactor"], pbr["diffuseTexture"], to);
    const Eigen::Vector3f specular = colour_of(pbr["specularFactor"].numbers_or({1, 1, 1}));
    set_highlights(specular, 1.0 - pbr["glossinessFactor"].number_or(1.0), to.material);
    to.specular = texture(pbr["specularGlossinessTexture"]);
    if (to.specular) note("glossiness of textures is left out, its factor is used");
  }

  void set_base(const Value& factor, const Value& info, SourceMaterial& to) {
    const std::vector<double> base = factor.numbers_or({1, 1, 1, 1});
    to.material.diffuse = colour_of(base);
    to.material.opacity = limited(base[3], 0.0, 1.0);
    to.diffuse = texture(info);
  }

  static void read_alpha(const Value& source, SourceMaterial& to) {
    const Value value = source["alphaMode"];
    const std::string mode = value.text_or("OPAQUE");
    if (mode == "MASK") {
      to.alpha = AlphaMode::cut_out;
    } else if (mode == "BLEND") {
      to.alpha = AlphaMode::blend;
    } else if (mode == "OPAQUE") {
      to.alpha = AlphaMode::opaque;
    } else {
      value.refuse(in_quotes(mode) + " (allowed: OPAQUE, MASK, BLEND)");
    }
    to.cutoff = limited(source["alphaCutoff"].number_or(0.5), 0.0, 1.0);
  }

  void read_normals(const Value& info, SourceMaterial& to) {
    to.normals = texture(info);
    if (!to.normals) return;
    const double scale = info["scale"].number_or(1.0);
    constexpr double kLargest = 1e30;
    to.normals->bump = limited(scale, -kLargest, kLargest);
  }

  void note_left_out(const Value& source) {
    leave_out(source["occlusionTexture"], "textures of occlusion are left out");
    const std::vector<double> emitted = source["emissiveFactor"].numbers_or({0, 0, 0});
    const bool is_dark =
        std::all_of(emitted.begin(), emitted.end(), [](double e) { return e == 0; });
    if (!is_dark) note("light that surfaces emit is left out");
  }

  void note(const std::string& text) { model_.notes.add(text); }
  void leave_out(const Value& texture_info, const std::string& text) {
    if (texture_info) note(text);
  }

  /// The texture that a textureInfo names; none if it is absent or has no image.
  std::optional<NamedTexture> texture(const Value& info) {
    if (!info) return std::nullopt;
    const Value source = document_.target("textures", info.required("index"));
    const auto image = image_of(source);
    if (!image) return std::nullopt;
    NamedTexture named;
    named.name = *image;
    if (source["sampler"]) {
      constexpr std::size_t kNearest = 9728;
      const Value sampler = document_.target("samplers", source["sampler"]);
      named.use.wrap_u = wrap_of(sampler["wrapS"]);
      named.use.wrap_v = wrap_of(sampler["wrapT"]);
      if (sampler["magFilter"].count_or(0) == kNearest) named.use.filter = Filter::nearest;
    }
    const Value transform = info.extension("KHR_texture_transform");
    if (transform) set_transform(transform, named.use);
    const Value changed = transform["texCoord"];
    const Value set = changed ? changed : info["texCoord"];
    const std::size_t number = set.count_or(0);
    if (number > std::numeric_limits<std::uint8_t>::max()) set.refuse("there is no such set");
    named.use.uv_set = static_cast<std::uint8_t>(number);  // place_sets() makes it 0 or 1
    return named;
  }

  /// Gives TEXCOORD_0 and 1 their own places if these suffice, else the first two sets in use.
  UvSets place_sets(const Value& source, SourceMaterial& material) {
    const std::array textures = {&material.diffuse, &material.normals, &material.specular};
    std::vector<std::size_t> used;
    for (const auto* texture : textures) {
      if (!*texture) continue;
      const std::size_t set = (*texture)->use.uv_set;
      if (std::find(used.begin(), used.end(), set) == used.end()) used.push_back(set);
    }
    const bool is_plain =
        std::all_of(used.begin(), used.end(), [](std::size_t set) { return set < 2; });
    UvSets sets;
    for (std::size_t k = 0; k < used.size() && k < 2 && !is_plain; ++k) sets.sets[k] = used[k];
    for (auto* texture : textures) {
      if (!*texture) continue;
      const auto* const place =
          std::find(sets.sets.begin(), sets.sets.end(), std::size_t{(*texture)->use.uv_set});
      if (place == sets.sets.end()) {
        note(source.path() +
             " uses more than two sets of texture coordinates: a texture is left out");
        texture->reset();
        continue;
      }
      const auto k = static_cast<std::size_t>(place - sets.sets.begin());
      (*texture)->use.uv_set = static_cast<std::uint8_t>(k);
      sets.needed.at(k) = true;
    }
    return sets;
  }

  /// The name of the image of a texture.
  std::optional<std::string> image_of(const Value& texture) {
    for (const char* extension : {"EXT_texture_webp", "KHR_texture_basisu"}) {
      const Value other = texture.extension(extension)["source"];
      const bool is_read = std::string_view(extension) == "EXT_texture_webp";
      if (other && (is_read || !texture["source"])) return name_of(other);
    }
    if (texture["source"]) return name_of(texture["source"]);
    note(texture.path() + " has no image that GLIDAR reads: left out");
    return std::nullopt;
  }

  std::string name_of(const Value& index) {
    const Value image = document_.target("images", index);
    const Value uri = image["uri"];
    const Value view = image["bufferView"];
    if (uri && view) image.refuse("it has both a URI and a buffer view");
    const std::string text = view ? "" : uri.text();
    if (!view && !is_data_uri(text)) return text;
    const std::string name =
        image["name"].text_or("").empty() ? image.path() : embedded_name(image);
    if (model_.images.contains(name)) return name;
    EmbeddedImage& to = model_.images[name];
    if (view) {
      const View bytes = buffers_.view(view);
      buffers_.take(Budget::held_bytes, bytes.bytes.size(), image.path());
      to.bytes.assign(bytes.bytes.begin(), bytes.bytes.end());
    } else {
      const auto content = data_uri_content(text);
      if (!content) uri.refuse("the data URI is malformed");
      to.bytes.assign(content->begin(), content->end());
    }
    return name;
  }

  /// Names of images need not differ.
  static std::string embedded_name(const Value& image) {
    return image.path() + " " + image["name"].text().substr(0, 200);
  }

  Document& document_;
  Buffers& buffers_;
  SourceModel& model_;
};

}  // namespace

std::vector<UvSets> read_materials(Document& document, Buffers& buffers, SourceModel& model) {
  Reader reader(document, buffers, model);
  const Value materials = document.root()["materials"];
  for (std::size_t i = 0; i < materials.size(); ++i) reader.read(materials.at(i));
  model.materials.emplace_back();
  reader.uv_sets.emplace_back();
  return reader.uv_sets;
}

}  // namespace glidar::import::gltf
