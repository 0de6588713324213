// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/format.hpp>

#include <glidar/io/formats/exr_encoder.hpp>

#include <array>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

/// Names that other programs know: OpenEXR reserves Z and R G B; P, N and Ns are pbrt's.
struct KnownChannels {
  std::string_view column;
  std::array<std::string_view, 3> channels;
};

constexpr std::array kKnownChannels = {
    KnownChannels{"depth", {"Z", "", ""}},
    KnownChannels{"xyz", {"P.X", "P.Y", "P.Z"}},
    KnownChannels{"normal", {"N.X", "N.Y", "N.Z"}},
    KnownChannels{"shading_normal", {"Ns.X", "Ns.Y", "Ns.Z"}},
    KnownChannels{"colour", {"R", "G", "B"}},
};

std::string channel_name(const Column& column, std::size_t component) {
  for (const KnownChannels& known : kKnownChannels) {
    if (known.column == column.name && component < known.channels.size())
      return std::string(known.channels[component]);
  }
  const std::string& name = column.components[component];
  return column.components.size() == 1 ? name : column.name + "." + name;
}

std::vector<PointField> exr_fields(const PointCloud& cloud) {
  std::vector<PointField> fields;
  for (const Column& column : cloud.columns) {
    const Stored type = native_type(column);
    if (type == Stored::i64) continue;
    const bool is_real = type == Stored::f32 || type == Stored::f64;
    for (std::size_t k = 0; k < column.components.size(); ++k)
      fields.push_back({channel_name(column, k), &column, k, is_real ? Stored::f32 : Stored::u32});
  }
  return fields;
}

template <class T, class Source>
std::vector<T> plane_of(const std::vector<Source>& values, const PointField& field) {
  const std::size_t stride = field.column->components.size();
  std::vector<T> plane(values.size() / stride);
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] = static_cast<T>(values[i * stride + field.component]);
  return plane;
}

ExrChannel channel_of(const PointField& field) {
  const auto fill = [&](const auto& values) -> ExrChannel {
    if (field.stored == Stored::f32) return {field.name, plane_of<float>(values, field)};
    return {field.name, plane_of<std::uint32_t>(values, field)};
  };
  return std::visit(fill, field.column->values);
}

void write_exr(const CloudFile& job, AtomicFile& file) {
  ExrImage image{job.cloud.rows, job.cloud.cols, {}, job.pixels};
  for (const PointField& field : job.fields) image.channels.push_back(channel_of(field));
  file.write(encode_exr(image, file.path()));
}

}  // namespace

Format exr_format() {
  return {.info = {.suffix = ".exr",
                   .description = "OpenEXR image, a channel for each column",
                   .columns = {},
                   .takes_more = true,
                   .optional_columns = {"depth"},
                   .missing = has_openexr() ? "" : "OpenEXR (Debian: libopenexr-dev)"},
          .content = Content::image,
          .fields = exr_fields,
          .write = write_exr,
          .pixels =
              "columns of the cloud, metres and radians; NaN: no return or no surface; "
              "4294967295: no id"};
}

}  // namespace glidar
