// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Vectors of 16-bit and 8-bit integers of the instruction set that kernel.cpp is compiled for, in
// namespace glidar::stereo::GLIDAR_KERNEL.
#ifndef GLIDAR_KERNEL
#define GLIDAR_KERNEL baseline
#endif
#include <cstddef>
#include <cstdint>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace glidar::stereo::GLIDAR_KERNEL {
namespace {

#if defined(__AVX512BW__)
constexpr std::size_t kVectorBytes = 64;
#elif defined(__AVX2__)
constexpr std::size_t kVectorBytes = 32;
#else
constexpr std::size_t kVectorBytes = 16;
#endif
constexpr std::size_t kWords = kVectorBytes / sizeof(std::int16_t);

using Words = std::int16_t __attribute__((vector_size(kVectorBytes)));
using Bytes = std::uint8_t __attribute__((vector_size(kVectorBytes)));
using HalfBytes = std::uint8_t __attribute__((vector_size(kVectorBytes / 2)));

#define GLIDAR_INLINE [[gnu::always_inline]] inline

/// A vector from any address: one instruction, without the alignment that a reference requires.
template <class Vector>
GLIDAR_INLINE Vector load_unaligned(const void* from) {
  Vector value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

GLIDAR_INLINE Words load(const std::int16_t* from) {
  return load_unaligned<Words>(from);
}
GLIDAR_INLINE void store(std::int16_t* to, Words value) {
  std::memcpy(to, &value, sizeof value);
}
GLIDAR_INLINE Bytes load(const std::uint8_t* from) {
  return load_unaligned<Bytes>(from);
}
GLIDAR_INLINE void store(std::uint8_t* to, Bytes value) {
  std::memcpy(to, &value, sizeof value);
}
/// kWords bytes as words.
GLIDAR_INLINE Words load_widened(const std::uint8_t* from) {
  return __builtin_convertvector(load_unaligned<HalfBytes>(from), Words);
}
/// The low bytes of words.
GLIDAR_INLINE void store_narrowed(std::uint8_t* to, Words value) {
  const HalfBytes low = __builtin_convertvector(value, HalfBytes);
  std::memcpy(to, &low, sizeof low);
}

GLIDAR_INLINE Words broadcast(int value) {
  return Words{} + static_cast<std::int16_t>(value);
}
GLIDAR_INLINE Bytes broadcast_byte(std::uint8_t value) {
  return Bytes{} + value;
}

/// a + b modulo 2^16: sums in lanes beyond the search may wrap.
GLIDAR_INLINE Words wrapped_sum(Words a, Words b) {
  using Unsigned = std::uint16_t __attribute__((vector_size(kVectorBytes)));
  return reinterpret_cast<Words>(reinterpret_cast<Unsigned>(a) + reinterpret_cast<Unsigned>(b));
}

GLIDAR_INLINE Words min(Words a, Words b) {
#if defined(__AVX512BW__)
  return reinterpret_cast<Words>(
      _mm512_min_epi16(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
#elif defined(__AVX2__)
  return reinterpret_cast<Words>(
      _mm256_min_epi16(reinterpret_cast<__m256i>(a), reinterpret_cast<__m256i>(b)));
#elif defined(__x86_64__)
  return reinterpret_cast<Words>(
      _mm_min_epi16(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
  return a < b ? a : b;
#endif
}
GLIDAR_INLINE Words max(Words a, Words b) {
  return ~min(~a, ~b);
}

/// `yes` where a < b, else `no`.
GLIDAR_INLINE Words select_below(Words a, Words b, Words yes, Words no) {
#if defined(__AVX512BW__)
  const __mmask32 below =
      _mm512_cmplt_epi16_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
  return reinterpret_cast<Words>(_mm512_mask_blend_epi16(below, reinterpret_cast<__m512i>(no),
                                                         reinterpret_cast<__m512i>(yes)));
#elif defined(__AVX2__)
  const __m256i below =
      _mm256_cmpgt_epi16(reinterpret_cast<__m256i>(b), reinterpret_cast<__m256i>(a));
  return reinterpret_cast<Words>(
      _mm256_blendv_epi8(reinterpret_cast<__m256i>(no), reinterpret_cast<__m256i>(yes), below));
#else
  const Words below = a < b;
  return (yes & below) | (no & ~below);
#endif
}

#ifdef __SSE4_1__
GLIDAR_INLINE int least_of_eight(__m128i words) {
  const __m128i offset = _mm_set1_epi16(-32768);  // the instruction compares unsigned words
  return _mm_extract_epi16(_mm_minpos_epu16(_mm_xor_si128(words, offset)), 0) - 32768;
}
#endif

/// The least of the lanes.
GLIDAR_INLINE int least(Words value) {
#if defined(__AVX512BW__)
  const __m512i all = reinterpret_cast<__m512i>(value);
  const __m256i half =
      _mm256_min_epi16(_mm512_castsi512_si256(all), _mm512_extracti64x4_epi64(all, 1));
  return least_of_eight(
      _mm_min_epi16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1)));
#elif defined(__AVX2__)
  const __m256i all = reinterpret_cast<__m256i>(value);
  return least_of_eight(
      _mm_min_epi16(_mm256_castsi256_si128(all), _mm256_extracti128_si256(all, 1)));
#elif defined(__x86_64__)
  __m128i all = reinterpret_cast<__m128i>(value);
  all = _mm_min_epi16(all, _mm_srli_si128(all, 8));  // of the low half; the high one is unused
  all = _mm_min_epi16(all, _mm_shufflelo_epi16(all, 0x4E));
  all = _mm_min_epi16(all, _mm_shufflelo_epi16(all, 0xB1));
  return static_cast<std::int16_t>(_mm_cvtsi128_si32(all));
#else
  int lowest = value[0];
  for (std::size_t i = 1; i < kWords; ++i) lowest = value[i] < lowest ? value[i] : lowest;
  return lowest;
#endif
}

/// The number of bits that are set in each byte.
GLIDAR_INLINE Bytes bit_counts(Bytes value) {
#if defined(__AVX512BW__)
  const __m512i table =
      _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
  const __m512i low = reinterpret_cast<__m512i>(value & broadcast_byte(0x0F));
  const __m512i high = _mm512_and_si512(_mm512_srli_epi16(reinterpret_cast<__m512i>(value), 4),
                                        _mm512_set1_epi8(0x0F));
  return reinterpret_cast<Bytes>(
      _mm512_add_epi8(_mm512_shuffle_epi8(table, low), _mm512_shuffle_epi8(table, high)));
#elif defined(__AVX2__)
  const __m256i table =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
  const __m256i low = reinterpret_cast<__m256i>(value & broadcast_byte(0x0F));
  const __m256i high = _mm256_and_si256(_mm256_srli_epi16(reinterpret_cast<__m256i>(value), 4),
                                        _mm256_set1_epi8(0x0F));
  return reinterpret_cast<Bytes>(
      _mm256_add_epi8(_mm256_shuffle_epi8(table, low), _mm256_shuffle_epi8(table, high)));
#else
  // Warren, Hacker's Delight, 5-1, on words: bits that cross bytes are masked
  using Wide = std::uint16_t __attribute__((vector_size(kVectorBytes)));
  const auto shifted = [](Bytes bytes, int count) {
    return reinterpret_cast<Bytes>(reinterpret_cast<Wide>(bytes) >> count);
  };
  value -= shifted(value, 1) & broadcast_byte(0x55);
  value = (value & broadcast_byte(0x33)) + (shifted(value, 2) & broadcast_byte(0x33));
  return (value + (shifted(value, 4) & broadcast_byte(0x0F))) & broadcast_byte(0x0F);
#endif
}

}  // namespace
}  // namespace glidar::stereo::GLIDAR_KERNEL
