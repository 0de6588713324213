// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/lookup_texture.hpp>

#include <glidar/math/simd.hpp>

#include <cmath>

namespace glidar {
namespace {

constexpr std::uint32_t kTileShift = 2;  // tiles of 4x4 texels
constexpr std::uint32_t kTileMask = (1U << kTileShift) - 1U;

/// Index of a texel; tiles are stored row by row.
inline std::uint32_t tiled_index(std::uint32_t row, std::uint32_t column,
                                 std::uint32_t tile_columns) {
  const std::uint32_t tile = (row >> kTileShift) * tile_columns + (column >> kTileShift);
  return (tile << (2 * kTileShift)) | ((row & kTileMask) << kTileShift) | (column & kTileMask);
}

std::uint32_t rgb_of(const Texture& texture, std::size_t texel) {
  const std::uint8_t* bytes = &texture.texels[texel * texture.channels];
  const std::uint32_t red = bytes[0];
  if (texture.channels < 3) return red | red << 8U | red << 16U;  // grey
  return red | std::uint32_t{bytes[1]} << 8U | std::uint32_t{bytes[2]} << 16U;
}

/// Size and wrap mode of a texture along one axis.
struct Axis {
  double size;
  double period;  ///< of repeat and mirror
  double per_period;
  bool clamps;

  Axis(std::uint32_t texels, Wrap wrap)
      : size(texels),
        period(wrap == Wrap::mirror ? 2.0 * size : size),
        per_period(1.0 / period),
        clamps(wrap == Wrap::clamp) {}

  /// An integer coordinate modulo the period. The quotient is below 2^50, so that its two roundings
  /// change it by at most 1/4 and its floor by at most one; all other operations are exact.
  [[nodiscard]] inline double rest_of(double index) const {
    double rest = index - std::floor(index * per_period) * period;
    rest = rest < 0.0 ? rest + period : rest;
    return rest >= period ? rest - period : rest;
  }

  /// The rest of the next coordinate.
  [[nodiscard]] inline double next_rest(double rest) const {
    return rest + 1.0 >= period ? rest + 1.0 - period : rest + 1.0;
  }

  /// The texel of an integer coordinate.
  [[nodiscard]] inline std::int32_t texel(double index, double rest) const {
    const double mirrored = rest >= size ? period - 1.0 - rest : rest;
    const double not_below = index > 0.0 ? index : 0.0;
    const double clamped = not_below < size - 1.0 ? not_below : size - 1.0;
    return static_cast<std::int32_t>(clamps ? clamped : mirrored);
  }
};

/// Texel coordinates, see sample(): whole and fractional parts.
struct TexelPosition {
  Lanes<double> first;
  Lanes<float> rest;
};

/// One row of TextureUse's transform of texture coordinates.
struct Transform {
  float at_u;
  float at_v;
  float offset;

  [[nodiscard]] inline float of(float u, float v) const { return at_u * u + at_v * v + offset; }
};

inline double clamped(double x) {
  constexpr double kFar = 1e15;  // as sample()
  const double above = x > -kFar ? x : -kFar;
  return above < kFar ? above : kFar;
}

/// Splits coordinates along an axis; `at`: finite, 1 at the end of the texture.
GLIDAR_SIMD void find_texels(const Lanes<double>& at, double size, bool is_nearest,
                             TexelPosition& position) {
  const double half = is_nearest ? 0.0 : 0.5;
  for (unsigned i = 0; i < kLanes; ++i) {
    const double x = clamped(at[i] * size) - half;
    const double first = std::floor(x);
    position.first[i] = first;
    position.rest[i] = is_nearest ? 0.0F : static_cast<float>(x - first);
  }
}

/// Two adjacent texels along an axis.
struct TexelPair {
  Lanes<std::int32_t> first;
  Lanes<std::int32_t> next;
};

GLIDAR_SIMD void wrap(const Axis& axis, const Lanes<double>& first, TexelPair& texels) {
  const Axis a = axis;  // a copy, so that the loop vectorises
  for (unsigned i = 0; i < kLanes; ++i) {
    const double rest = a.rest_of(first[i]);
    texels.first[i] = a.texel(first[i], rest);
    texels.next[i] = a.texel(first[i] + 1.0, a.next_rest(rest));
  }
}

/// byte / 255, correctly rounded without a division: the first product is exact, and the second one
/// too small for its rounding to matter.
constexpr float part_of(std::uint32_t byte) {
  const auto whole = static_cast<float>(static_cast<std::int32_t>(byte));
  return whole * 0x1.01p-8F + whole * 0x1.0101p-24F;
}

constexpr bool are_parts_exact() {
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    if (part_of(byte) != static_cast<float>(byte) / 255.0F) return false;
  }
  return true;
}
static_assert(are_parts_exact());

/// Texture coordinates after TextureUse's transform, v downwards. Non-finite ones become 0 and are
/// marked.
GLIDAR_SIMD void transform(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
                           Lanes<double>& x, Lanes<double>& y, Lanes<std::int32_t>& is_finite) {
  const Transform to_x{use.uv_scale_rotate(0, 0), use.uv_scale_rotate(0, 1), use.uv_offset.x()};
  const Transform to_y{use.uv_scale_rotate(1, 0), use.uv_scale_rotate(1, 1), use.uv_offset.y()};
  for (unsigned i = 0; i < kLanes; ++i) {
    const float at_x = to_x.of(u[i], v[i]);
    const float at_y = to_y.of(u[i], v[i]);
    const float sum = (at_x - at_x) + (at_y - at_y);  // 0 only of finite numbers
    const bool finite = sum == 0.0F;
    is_finite[i] = finite ? 1 : 0;
    x[i] = finite ? static_cast<double>(at_x) : 0.0;
    y[i] = finite ? 1.0 - static_cast<double>(at_y) : 0.0;
  }
}

GLIDAR_SIMD void load(const std::uint32_t* texels, std::uint32_t tile_columns,
                      const Lanes<std::int32_t>& row, const Lanes<std::int32_t>& column,
                      Lanes3<float>& rgb) {
  Lanes<std::uint32_t> texel;
  for (unsigned i = 0; i < kLanes; ++i) {
    texel[i] = texels[tiled_index(static_cast<std::uint32_t>(row[i]),
                                  static_cast<std::uint32_t>(column[i]), tile_columns)];
  }
  for (unsigned i = 0; i < kLanes; ++i) rgb.x[i] = part_of(texel[i] & 0xFFU);
  for (unsigned i = 0; i < kLanes; ++i) rgb.y[i] = part_of(texel[i] >> 8U & 0xFFU);
  for (unsigned i = 0; i < kLanes; ++i) rgb.z[i] = part_of(texel[i] >> 16U & 0xFFU);
}

/// a = (1 - t) a + t b
GLIDAR_SIMD void blend(const Lanes<float>& t, const Lanes3<float>& b, Lanes3<float>& a) {
  for (unsigned i = 0; i < kLanes; ++i) a.x[i] = (1.0F - t[i]) * a.x[i] + t[i] * b.x[i];
  for (unsigned i = 0; i < kLanes; ++i) a.y[i] = (1.0F - t[i]) * a.y[i] + t[i] * b.y[i];
  for (unsigned i = 0; i < kLanes; ++i) a.z[i] = (1.0F - t[i]) * a.z[i] + t[i] * b.z[i];
}

void whiten(const Lanes<std::int32_t>& is_finite, Lanes3<float>& rgb) {
  for (unsigned i = 0; i < kLanes; ++i) {
    if (is_finite[i] == 0) rgb.set(i, Eigen::Vector3f::Ones());
  }
}

}  // namespace

LookupTexture::LookupTexture(const Texture& texture)
    : width_(texture.width),
      height_(texture.height),
      tile_columns_((texture.width + kTileMask) >> kTileShift) {
  const std::size_t tile_rows = (height_ + kTileMask) >> kTileShift;
  texels_.resize(tile_rows * tile_columns_ << (2 * kTileShift));
  for (std::uint32_t row = 0; row < height_; ++row) {
    for (std::uint32_t column = 0; column < width_; ++column) {
      texels_[tiled_index(row, column, tile_columns_)] =
          rgb_of(texture, std::size_t{row} * width_ + column);
    }
  }
}

void LookupTexture::sample(const TextureUse& use, const Lanes<float>& u, const Lanes<float>& v,
                           Lanes3<float>& rgb) const {
  const bool is_nearest = use.filter == Filter::nearest;
  const Axis columns(width_, use.wrap_u);
  const Axis rows(height_, use.wrap_v);
  const auto fetch = [&](const Lanes<std::int32_t>& at_row, const Lanes<std::int32_t>& at_column,
                         Lanes3<float>& out) {
    load(texels_.data(), tile_columns_, at_row, at_column, out);
  };
  Lanes<double> x;
  Lanes<double> y;
  Lanes<std::int32_t> is_finite;
  transform(use, u, v, x, y, is_finite);
  TexelPosition across;
  TexelPosition down;
  find_texels(x, columns.size, is_nearest, across);
  find_texels(y, rows.size, is_nearest, down);
  TexelPair column;
  TexelPair row;
  wrap(columns, across.first, column);
  wrap(rows, down.first, row);
  fetch(row.first, column.first, rgb);
  if (!is_nearest) {
    Lanes3<float> other;
    Lanes3<float> lower;
    fetch(row.first, column.next, other);
    blend(across.rest, other, rgb);
    fetch(row.next, column.first, lower);
    fetch(row.next, column.next, other);
    blend(across.rest, other, lower);
    blend(down.rest, lower, rgb);
  }
  whiten(is_finite, rgb);
}

}  // namespace glidar
