// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to glidar/io.

#include <glidar/core/material.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glidar {

/// What an instance changes of one of its model's materials.
struct MaterialOverride {
  std::string material;  ///< name in the model, "*" for all
  std::string where;     ///< for errors
  std::optional<Eigen::Vector3f> ambient;
  std::optional<Eigen::Vector3f> diffuse;
  std::optional<Eigen::Vector3f> specular;
  std::optional<float> shininess;
  std::optional<float> opacity;
  std::optional<Brdf> backscatter;
  LookupTable spectrum;  ///< empty: that of the model
  std::optional<float> mirror;
  std::optional<float> noise_scale;
  std::string noise_texture;        ///< path of a PNG file; empty: as it was
  std::string where_noise_texture;  ///< for errors
};

/// Keys of one entry of `materials` in scene files.
void describe(MaterialOverride& change, FieldVisitor& visitor);

/// Moves the changes of all materials, "*", to the front: those of one material take precedence.
void sort_overrides(std::vector<MaterialOverride>& changes);

/// `spectrum`: pairs of wavelength and reflectance.
void visit_spectrum(FieldVisitor& visitor, bool is_required, LookupTable& spectrum);

}  // namespace glidar
