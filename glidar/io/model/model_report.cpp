// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/model_report.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace glidar {
namespace {

std::string name_of(const TextureUse& use, const Model& model) {
  if (!use.used()) return "";
  return model.textures.at(static_cast<std::size_t>(use.texture)).name;
}

std::vector<MaterialSummary> summaries(const Model& model) {
  std::vector<MaterialSummary> all;
  for (const Material& m : model.materials) {
    all.push_back(
        {m.name, 0, luminance(m.diffuse), name_of(m.diffuse_texture, model),
         name_of(m.specular_texture, model), name_of(m.normal_texture, model),
         name_of(m.alpha_texture, model),
         m.alpha_cutoff > 0.0F && (m.alpha_texture.used() || m.opacity < m.alpha_cutoff)});
  }
  for (std::uint32_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const std::uint16_t slot = material_slot(model.mesh, t);
    if (slot < all.size()) ++all[slot].triangles;
  }
  return all;
}

/// Each image once: a height map is followed by the normal map made from it, with the same name.
std::vector<TextureSummary> texture_summaries(const Model& model) {
  std::vector<TextureSummary> all;
  for (const Texture& t : model.textures) {
    const bool is_listed = std::any_of(all.begin(), all.end(), [&](const TextureSummary& other) {
      return other.name == t.name && other.width == t.width && other.height == t.height;
    });
    if (!is_listed) all.push_back({t.name, t.width, t.height, t.channels});
  }
  return all;
}

Winding winding_of(const MeshCheck& check, bool closed) {
  if (check.inconsistent_edges > 0) return Winding::inconsistent;
  if (!closed || check.signed_volume_m3 == 0.0) return Winding::undecided;
  return check.signed_volume_m3 > 0.0 ? Winding::outward : Winding::inward;
}

/// "declared by the file", or how the applied value differs from it.
template <class Value, class Text>
std::string origin_of(const std::optional<Value>& declared, const std::optional<Value>& applied,
                      const Text& text) {
  if (declared == applied) return "declared by the file or its format";
  return declared ? "as specified; the file declares " + text(*declared) : "as specified";
}

std::string unit_sentence(const Model& model, double longest_side_m) {
  const std::optional<double>& applied = model.applied.metres_per_unit;
  if (!applied) return "1 m assumed, the file declares none; " + guess_unit(longest_side_m);
  const auto text = [](double metres) { return fmt::format("{:g} m", metres); };
  return text(*applied) + ", " + origin_of(model.declared.metres_per_unit, applied, text);
}

std::string up_sentence(const Model& model) {
  const std::optional<Axis>& applied = model.applied.up;
  if (!applied) return "axes as in the file, which declares none";
  const auto text = [](Axis axis) {
    return std::string(1, static_cast<char>('x' + static_cast<int>(axis)));
  };
  return text(*applied) + " of the file is z here, " + origin_of(model.declared.up, applied, text);
}

}  // namespace

std::string to_string(Winding winding) {
  constexpr std::array kWords = {"outward", "inward", "inconsistent", "undecided"};
  return kWords[static_cast<std::size_t>(winding)];
}

std::string guess_unit(double longest_side_m) {
  constexpr double kSmall = 0.02;
  constexpr double kLarge = 200.0;
  constexpr double kHuge = 200'000.0;
  const std::string across = fmt::format("{:.4g} m across", longest_side_m);
  if (longest_side_m > kHuge) {
    return "very large: " + across + "; a planet, or millimetres of something large?";
  }
  if (longest_side_m > kLarge) {
    return fmt::format("large: {}; a site or terrain, or millimetres of an object of {:.4g} m",
                       across, longest_side_m / 1000.0);
  }
  if (longest_side_m < kSmall) {
    return "very small: " + across + "; a tiny part, or kilometres or inches taken for metres?";
  }
  return "plausible as metres: " + across;
}

ModelReport inspect(const Model& model) {
  ModelReport report;
  report.source = model.source;
  report.format = model.format;
  report.hash = model.hash;
  report.from_cache = model.from_cache;
  report.triangles = model.mesh.triangles.size();
  report.vertices = model.mesh.positions_m.size();
  report.parts = model.parts;
  if (const Eigen::AlignedBox3d box = bounds(model.mesh); !box.isEmpty()) {
    report.min_m = box.min();
    report.max_m = box.max();
    report.size_m = box.sizes();
  }
  report.check = check_mesh(model.mesh);
  report.closed = report.triangles > 0 && report.check.open_edges == 0;
  report.winding = winding_of(report.check, report.closed);
  report.materials = summaries(model);
  report.textures = texture_summaries(model);
  report.missing_textures = model.missing_textures;
  report.stated = model.stated;
  report.loaded = model.loaded;
  report.notes = model.notes;
  report.metres_per_unit = model.applied.metres_per_unit.value_or(1.0);
  report.unit_declared = model.declared.metres_per_unit;
  report.unit_guess = unit_sentence(model, report.size_m.maxCoeff());
  report.up = up_sentence(model);
  return report;
}

}  // namespace glidar
