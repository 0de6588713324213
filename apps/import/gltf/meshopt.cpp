// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/gltf/meshopt.hpp>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace glidar::import::gltf {
namespace {

/// Reads and writes elements of a buffer in place, whatever its alignment.
template <class T, std::size_t N>
class Elements {
 public:
  Elements(std::string& bytes, std::size_t stride) : bytes_(bytes), stride_(stride) {}
  [[nodiscard]] std::array<T, N> get(std::size_t i) const {
    std::array<T, N> values;
    std::memcpy(values.data(), bytes_.data() + i * stride_, sizeof values);
    return values;
  }
  void set(std::size_t i, const std::array<T, N>& values) {
    std::memcpy(bytes_.data() + i * stride_, values.data(), sizeof values);
  }

 private:
  std::string& bytes_;
  std::size_t stride_;
};

// The filters of EXT_meshopt_compression, "Filters". Those of the library round differently with
// and without vector instructions; these give the same bytes everywhere.

/// A number of the range -1 to 1, as an integer.
template <class T>
T quantized(double value) {
  return static_cast<T>(std::round(std::clamp(value, -1.0, 1.0) * std::numeric_limits<T>::max()));
}

/// Unit vectors in an octahedral map; the third component is the number that means 1.
template <class T>
void unfold_octahedra(std::string& bytes, const MeshoptLayout& layout) {
  Elements<T, 4> elements(bytes, layout.stride);
  for (std::size_t i = 0; i < layout.count; ++i) {
    std::array<T, 4> v = elements.get(i);
    const double one = v[2] == 0 ? 1.0 : v[2];
    double x = v[0] / one;
    double y = v[1] / one;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    const double below = std::min(z, 0.0);
    x += x >= 0.0 ? below : -below;
    y += y >= 0.0 ? below : -below;
    const double length = std::max(std::sqrt(x * x + y * y + z * z), 1e-30);
    v[0] = quantized<T>(x / length);
    v[1] = quantized<T>(y / length);
    v[2] = quantized<T>(z / length);
    elements.set(i, v);
  }
}

/// Unit quaternions without their largest component, whose index is in the last number.
void complete_quaternions(std::string& bytes, const MeshoptLayout& layout) {
  Elements<std::int16_t, 4> elements(bytes, layout.stride);
  const double range = std::sqrt(0.5);
  for (std::size_t i = 0; i < layout.count; ++i) {
    const std::array<std::int16_t, 4> v = elements.get(i);
    const auto last = static_cast<std::uint16_t>(v[3]);
    const double one = last | 3U;
    const std::size_t largest = last & 3U;
    const double x = v[0] / one * range;
    const double y = v[1] / one * range;
    const double z = v[2] / one * range;
    const double w = std::sqrt(std::max(0.0, 1.0 - x * x - y * y - z * z));
    std::array<std::int16_t, 4> q{};
    q[(largest + 1) % 4] = quantized<std::int16_t>(x);
    q[(largest + 2) % 4] = quantized<std::int16_t>(y);
    q[(largest + 3) % 4] = quantized<std::int16_t>(z);
    q[largest] = quantized<std::int16_t>(w);
    elements.set(i, q);
  }
}

/// Numbers with an exponent of 8 and a mantissa of 24 bits, both signed.
void raise_exponents(std::string& bytes) {
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    const auto exponent = static_cast<std::int32_t>(word) >> 24;
    const auto mantissa = static_cast<std::int32_t>(word << 8U) >> 8;
    const auto value = static_cast<float>(std::ldexp(static_cast<double>(mantissa), exponent));
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }
}

void apply_filter(const Value& filter, const MeshoptLayout& layout, std::string& bytes) {
  const std::string name = filter.text_or("NONE");
  if (name == "NONE") return;
  if (name == "OCTAHEDRAL" && layout.stride == 4) {
    unfold_octahedra<std::int8_t>(bytes, layout);
  } else if (name == "OCTAHEDRAL" && layout.stride == 8) {
    unfold_octahedra<std::int16_t>(bytes, layout);
  } else if (name == "QUATERNION" && layout.stride == 8) {
    complete_quaternions(bytes, layout);
  } else if (name == "EXPONENTIAL" && layout.stride % 4 == 0) {
    raise_exponents(bytes);
  } else {
    filter.refuse(
        fmt::format("{} with a byteStride of {} (allowed: NONE, OCTAHEDRAL with 4 or 8, "
                    "QUATERNION with 8, EXPONENTIAL)",
                    in_quotes(name), layout.stride));
  }
}

/// The number of elements that so much compressed data can hold at most.
std::size_t most_elements(const std::string& mode, std::size_t stride, std::size_t size) {
  // Of vertices, 16 equal bytes take 2 bits; of triangles and indices, each takes a byte.
  constexpr std::size_t kPerByte = 64;
  if (mode == "ATTRIBUTES") return (size * kPerByte) / stride + kPerByte;
  return mode == "TRIANGLES" ? size * 3 : size;
}

}  // namespace

MeshoptLayout meshopt_layout(const Value& extension, std::size_t compressed_bytes) {
  const Value mode = extension.required("mode");
  const Value count = extension.required("count");
  const Value stride = extension.required("byteStride");
  const MeshoptLayout layout{mode.text(), count.count(), stride.count()};
  constexpr std::size_t kLargestStride = 256;
  const bool is_index = layout.mode == "TRIANGLES" || layout.mode == "INDICES";
  if (!is_index && layout.mode != "ATTRIBUTES") {
    mode.refuse(in_quotes(layout.mode) + " (allowed: ATTRIBUTES, TRIANGLES, INDICES)");
  }
  const bool fits =
      is_index ? layout.stride == 2 || layout.stride == 4
               : layout.stride > 0 && layout.stride % 4 == 0 && layout.stride <= kLargestStride;
  if (!fits) stride.refuse(fmt::format("{} bytes for the mode {}", layout.stride, layout.mode));
  if (layout.mode == "TRIANGLES" && layout.count % 3 != 0)
    count.refuse("it is not a multiple of 3");
  if (layout.count > most_elements(layout.mode, layout.stride, compressed_bytes)) {
    count.refuse(
        fmt::format("{} elements, more than {} bytes can hold", layout.count, compressed_bytes));
  }
  return layout;
}

std::string decode_meshopt(const Value& extension, const MeshoptLayout& layout,
                           std::string_view compressed) {
  std::string decoded(layout.count * layout.stride, '\0');
  const auto* const data = reinterpret_cast<const unsigned char*>(compressed.data());
  using Decode = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  Decode decode = &meshopt_decodeVertexBuffer;
  if (layout.mode == "TRIANGLES") decode = &meshopt_decodeIndexBuffer;
  if (layout.mode == "INDICES") decode = &meshopt_decodeIndexSequence;
  if (decode(decoded.data(), layout.count, layout.stride, data, compressed.size()) != 0) {
    extension.refuse("its data cannot be decompressed");
  }
  if (layout.mode == "ATTRIBUTES") {
    apply_filter(extension["filter"], layout, decoded);
  } else if (extension["filter"].text_or("NONE") != "NONE") {
    extension["filter"].refuse("indices have none");
  }
  return decoded;
}

}  // namespace glidar::import::gltf
