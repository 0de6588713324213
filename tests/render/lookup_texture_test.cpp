// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/math/constants.hpp>
#include <glidar/render/surface.hpp>

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <random>
#include <vector>

namespace glidar {
namespace {

Texture random_texture(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  texture.channels = channels;
  std::mt19937 random(width + 100 * height + channels);
  texture.texels.resize(std::size_t{width} * height * channels);
  for (std::uint8_t& byte : texture.texels) byte = static_cast<std::uint8_t>(random() & 0xFFU);
  return texture;
}

/// Texture coordinates within the texture, around it, far away, on texels' borders, and non-finite.
std::vector<float> coordinates() {
  std::vector<float> values = {0.0F,   1.0F,   -1.0F, 0.5F,   0.25F,      1e-30F,
                               1e6F,   -1e6F,  1e20F, -1e30F, 3.4e38F,    -0.0F,
                               0.875F, 1.125F, 2.0F,  -2.0F,  0.9999999F, 16777217.0F};
  values.push_back(kNaNf);
  values.push_back(std::numeric_limits<float>::infinity());
  values.push_back(-std::numeric_limits<float>::infinity());
  std::mt19937 random(7);
  std::uniform_real_distribution<float> near(-3.0F, 3.0F);
  while (values.size() < 96) values.push_back(near(random));
  return values;
}

/// Bits of three numbers.
std::array<std::uint32_t, 3> bits_of(const Eigen::Vector3f& v) {
  return {std::bit_cast<std::uint32_t>(v.x()), std::bit_cast<std::uint32_t>(v.y()),
          std::bit_cast<std::uint32_t>(v.z())};
}

void expect_equal_bits(const Texture& texture, const TextureUse& use) {
  const std::vector<Texture> textures = {texture};
  const LookupTexture lookup(texture);
  const std::vector<float> values = coordinates();
  std::mt19937 random(11);
  for (int block = 0; block < 60; ++block) {
    Lanes<float> u;
    Lanes<float> v;
    for (unsigned i = 0; i < kLanes; ++i) {
      u[i] = values[random() % values.size()];
      v[i] = values[random() % values.size()];
    }
    Lanes3<float> rgb;
    lookup.sample(use, u, v, rgb);
    for (unsigned i = 0; i < kLanes; ++i) {
      const Eigen::Vector3f expected = sample(use, textures, {u[i], v[i]}).head<3>();
      EXPECT_EQ(bits_of(rgb.get(i)), bits_of(expected)) << "u " << u[i] << ", v " << v[i];
    }
  }
}

TEST(LookupTexture, EqualsTheTextureForAllSizesAndChannels) {
  for (const std::uint32_t channels : {1U, 2U, 3U, 4U}) {
    for (const auto& [width, height] :
         {std::pair{1U, 1U}, {1U, 7U}, {5U, 1U}, {3U, 3U}, {4U, 4U}, {17U, 9U}, {64U, 33U}}) {
      SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
      expect_equal_bits(random_texture(width, height, channels), {.texture = 0});
    }
  }
}

TEST(LookupTexture, EqualsTheTextureForAllWrapModesFiltersAndTransforms) {
  const Texture texture = random_texture(13, 6, 3);
  for (const Wrap wrap_u : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const Wrap wrap_v : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
      for (const Filter filter : {Filter::linear, Filter::nearest}) {
        TextureUse use{.texture = 0, .wrap_u = wrap_u, .wrap_v = wrap_v, .filter = filter};
        expect_equal_bits(texture, use);
        use.uv_scale_rotate << 1.7F, -0.3F, 0.2F, -2.9F;
        use.uv_offset = {0.37F, -11.1F};
        expect_equal_bits(texture, use);
      }
    }
  }
}

}  // namespace
}  // namespace glidar
