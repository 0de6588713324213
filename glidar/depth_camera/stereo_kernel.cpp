// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/depth_camera/stereo_kernel.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

// This file is compiled once for each instruction set.
#ifndef GLIDAR_KERNEL
#define GLIDAR_KERNEL baseline
#endif
#define GLIDAR_STEREO_STRING_OF(word) #word
#define GLIDAR_STEREO_STRING(word) GLIDAR_STEREO_STRING_OF(word)
#define GLIDAR_INLINE [[gnu::always_inline]] inline

namespace glidar::stereo::GLIDAR_KERNEL {
namespace {

// Vectors of 16-bit and 8-bit integers.
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

// Inner loops that select the winner of each pixel.
constexpr int kGreatestSum = 32767;

/// The lanes of the last block that are beyond the search have the greatest sum.
struct BeyondSums {
  std::int16_t lane[kLaneBlock];
  BeyondSums(std::size_t disparities, std::size_t lanes) {
    const std::size_t begin = lanes - kLaneBlock;
    for (std::size_t i = 0; i < kLaneBlock; ++i) {
      lane[i] = begin + i < disparities ? -kSumOffset : kGreatestSum;
    }
  }
};

/// The numbers 0, 1, 2 ... of the lanes.
GLIDAR_INLINE Words lane_numbers() {
  Words numbers;
  for (std::size_t i = 0; i < kWords; ++i) numbers[i] = static_cast<std::int16_t>(i);
  return numbers;
}

/// Least sum and first lane that has it.
struct Best {
  Words sum = broadcast(kGreatestSum);
  Words lane = broadcast(kGreatestSum);

  GLIDAR_INLINE void add(Words sums, Words lanes) {
    lane = select_below(sums, sum, lanes, lane);
    sum = min(sums, sum);
  }
  [[nodiscard]] GLIDAR_INLINE int first_lane(int lowest) const {
    return least(select_below(broadcast(lowest), sum, broadcast(kGreatestSum), lane));
  }
};

/// The greatest sum that rivals a least sum: S (100 - percent) <= 100 best, both without offset.
int rival_limit(int best, std::uint32_t uniqueness_percent) {
  const std::uint32_t sum = static_cast<std::uint32_t>(best + kSumOffset);
  const std::uint32_t limit = sum * 100 / (100 - uniqueness_percent);
  const std::uint32_t greatest = kGreatestSum - 1 + kSumOffset;  // not lanes beyond the search
  return static_cast<int>(limit < greatest ? limit : greatest) - kSumOffset;
}

int count_rivals(const WinnerRow& row, const std::int16_t* sum, int limit) {
  const Words above = broadcast(limit + 1);
  Words count = {};
  for (std::size_t d = 0; d < row.lanes; d += kWords) {
    count += select_below(load(sum + d), above, broadcast(1), Words{});
  }
  int total = 0;
  for (std::size_t i = 0; i < kWords; ++i) total += count[i];
  return total;
}

/// Lanes beyond the search count as rivals only if a wrapped sum is low; these are taken off.
int count_beyond(const WinnerRow& row, const std::int16_t* sum, int limit) {
  int count = 0;
  for (std::size_t d = row.disparities; d < row.lanes; ++d) count += sum[d] <= limit ? 1 : 0;
  return count;
}

/// The winner of a pixel, which also competes for the right pixels that it may match.
GLIDAR_INLINE Best find_best(const WinnerRow& row, const BeyondSums& beyond,
                             const std::int16_t* sum, std::size_t x) {
  const std::size_t mirrored = row.width - 1 - x;
  std::int16_t* const mirror_best = row.mirror_best + mirrored;
  std::int16_t* const mirror_winner = row.mirror_winner + mirrored;
  const std::size_t last = row.lanes - kLaneBlock;
  Best best;
  Words lanes = lane_numbers();
  for (std::size_t d = 0; d < row.lanes; d += kWords) {
    Words sums = load(sum + d);
    if (d >= last) sums = max(sums, load(beyond.lane + (d - last)));
    best.add(sums, lanes);
    const Words rival = load(mirror_best + d);
    store(mirror_winner + d, select_below(sums, rival, lanes, load(mirror_winner + d)));
    store(mirror_best + d, min(sums, rival));
    lanes += broadcast(kWords);
  }
  return best;
}

void win_row(const WinnerRow& row) {
  const BeyondSums beyond(row.disparities, row.lanes);
  for (std::size_t i = 0; i < row.width + row.lanes; ++i) row.mirror_best[i] = kGreatestSum;
  for (std::size_t x = 0; x < row.width; ++x) {
    const std::int16_t* const sum = row.sum + x * row.lanes;
    const Best best = find_best(row, beyond, sum, x);
    const int lowest = least(best.sum);
    row.best[x] = static_cast<std::int16_t>(lowest);
    row.winner[x] = static_cast<std::int16_t>(best.first_lane(lowest));
    if (row.uniqueness_percent == 0) continue;
    const int limit = rival_limit(lowest, row.uniqueness_percent);
    row.rivals[x] =
        static_cast<std::int16_t>(count_rivals(row, sum, limit) - count_beyond(row, sum, limit));
  }
}

// Inner loops of the path costs,
// L(p, d) = C(p, d) + min(L(q, d), L(q, d-1) + P1, L(q, d+1) + P1, m + P2) - m, m = min L(q),
// q the pixel before p on the path (Hirschmueller 2008, eq. 13).
struct Penalties {
  Words p1;
  Words p2;
};

/// L from C and L of the pixel before: at lane d, d - 1 and d + 1, and its least.
GLIDAR_INLINE Words path_cost(Words cost, Words same, Words below, Words above, Words before_least,
                              const Penalties& penalties) {
  const Words step = min(below, above) + penalties.p1;
  return cost + min(min(same, step) - before_least, penalties.p2);
}

/// kNoCost in the lanes of the last block that are beyond the search, 0 in the others.
struct Beyond {
  std::int16_t lane[kLaneBlock];
  Beyond(std::size_t disparities, std::size_t lanes) {
    const std::size_t begin = lanes - kLaneBlock;
    for (std::size_t i = 0; i < kLaneBlock; ++i) lane[i] = begin + i < disparities ? 0 : kNoCost;
  }
};

/// One pixel of a sweep; `before` and `after` are states of the pixel before and of this one.
/// Returns the least of its path costs.
template <bool kIsFirst>
GLIDAR_INLINE int sweep_pixel(const SweepRow& row, const Beyond& beyond, std::size_t x,
                              const std::int16_t* before, std::int16_t* after, int before_least) {
  const Penalties penalties = {broadcast(row.p1), broadcast(row.p2)};
  const std::int16_t* const cost = row.cost + x * row.lanes;
  std::int16_t* const sum = row.sum + x * row.lanes;
  const Words floor = broadcast(before_least);
  Words lowest = broadcast(kNoCost);
  const auto step = [&](std::size_t d) {
    return path_cost(load(cost + d), load(before + d), load(before + d - 1), load(before + d + 1),
                     floor, penalties);
  };
  const auto finish = [&](std::size_t d, Words path) {
    store(after + d, path);
    lowest = min(lowest, path);
    store(sum + d, kIsFirst ? path ^ broadcast(-kSumOffset) : wrapped_sum(load(sum + d), path));
  };
  const std::size_t last = row.lanes - kLaneBlock;
  for (std::size_t d = 0; d < last; d += kWords) finish(d, step(d));
  for (std::size_t i = 0; i < kLaneBlock; i += kWords) {
    finish(last + i, max(step(last + i), load(beyond.lane + i)));
  }
  return least(lowest);
}

template <bool kIsFirst>
void sweep_all(const SweepRow& row) {
  const Beyond beyond(row.disparities, row.lanes);
  const std::size_t stride = row.lanes + kStateGap;
  std::int16_t* before = row.state + kStateGap;
  std::int16_t* after = before + stride;
  for (std::size_t i = 0; i < 2 * stride + kStateGap; ++i) row.state[i] = kNoCost;
  for (std::size_t d = 0; d < row.lanes; ++d) before[d] = 0;
  int lowest = 0;
  for (std::size_t i = 0; i < row.width; ++i) {
    const std::size_t x = row.is_backwards ? row.width - 1 - i : i;
    lowest = sweep_pixel<kIsFirst>(row, beyond, x, before, after, lowest);
    std::int16_t* const swapped = before;
    before = after;
    after = swapped;
  }
}

void sweep_row(const SweepRow& row) {
  if (row.is_first) return sweep_all<true>(row);
  sweep_all<false>(row);
}

/// One path at one pixel, from lane to lane. The state is replaced in place: lane d - 1 of the
/// pixel before is read before its successor is written.
struct PathStep {
  std::int16_t* state;
  Words floor;
  Words lowest;
  Words below;

  GLIDAR_INLINE void start(std::int16_t* at, int before_least) {
    state = at;
    floor = broadcast(before_least);
    lowest = broadcast(kNoCost);
    below = load(at - 1);
  }
  GLIDAR_INLINE Words next(std::size_t d, Words cost, Words beyond, const Penalties& penalties) {
    const Words path =
        max(path_cost(cost, load(state + d), below, load(state + d + 1), floor, penalties), beyond);
    below = load(state + d + kWords - 1);
    store(state + d, path);
    lowest = min(lowest, path);
    return path;
  }
};

template <std::size_t kPaths>
GLIDAR_INLINE void down_pixel(const DownRow& row, const Beyond& beyond, std::size_t x) {
  const Penalties penalties = {broadcast(row.p1), broadcast(row.p2)};
  const std::size_t offset = x * row.lanes;
  PathStep steps[kPaths];
  for (std::size_t k = 0; k < kPaths; ++k) {
    steps[k].start(row.state[k] + x * (row.lanes + kStateGap), row.least[k][x]);
  }
  const auto advance = [&](std::size_t d, Words past) {
    const Words cost = load(row.cost + offset + d);
    Words sum = load(row.sum + offset + d);
    for (std::size_t k = 0; k < kPaths; ++k) {
      sum = wrapped_sum(sum, steps[k].next(d, cost, past, penalties));
    }
    store(row.new_sum + offset + d, sum);
  };
  const std::size_t last = row.lanes - kLaneBlock;
  for (std::size_t d = 0; d < last; d += kWords) advance(d, Words{});
  for (std::size_t i = 0; i < kLaneBlock; i += kWords) advance(last + i, load(beyond.lane + i));
  for (std::size_t k = 0; k < kPaths; ++k) {
    row.least[k][x] = static_cast<std::int16_t>(least(steps[k].lowest));
  }
}

template <std::size_t kPaths>
void down_all(const DownRow& row) {
  const Beyond beyond(row.disparities, row.lanes);
  for (std::size_t x = 0; x < row.count; ++x) down_pixel<kPaths>(row, beyond, x);
}

void down_row(const DownRow& row) {
  if (row.paths == 1) return down_all<1>(row);
  down_all<3>(row);
}

// Inner loops from pixels to matching costs.
/// The bits [begin, end) of the pixels from `centre` on, one pixel in each lane.
GLIDAR_INLINE Words census_bits(const CensusRow& row, const std::int16_t* centre, std::size_t begin,
                                std::size_t end) {
  Words bits = {};
  Words value = broadcast(1);
  for (std::size_t bit = begin; bit < end; ++bit) {
    bits |=
        select_below(load(centre + row.first[bit]), load(centre + row.second[bit]), value, Words{});
    value += value;
  }
  return bits;
}

void census_row(const CensusRow& row) {
  for (std::size_t begin = 0; begin < row.bits; begin += kPlaneBits) {
    const std::size_t end = begin + kPlaneBits < row.bits ? begin + kPlaneBits : row.bits;
    std::uint8_t* const plane = row.planes + begin / kPlaneBits * row.plane_stride;
    for (std::size_t x = 0; x < row.width; x += kWords)
      store_narrowed(plane + x, census_bits(row, row.centre + x, begin, end));
  }
}

/// Lanes whose pixel is outside the right image.
GLIDAR_INLINE void fill_outside(const HammingRow& row, std::size_t x, std::uint8_t* distances) {
  const std::size_t inside = x >= row.min_disparity ? x - row.min_disparity + 1 : 0;
  for (std::size_t d = inside; d < row.lanes; ++d) distances[d] = row.outside;
}

template <std::size_t kPlanes>
void hamming_pixel(const HammingRow& row, std::size_t x, std::uint8_t* distances) {
  Bytes left[kPlanes];
  for (std::size_t p = 0; p < kPlanes; ++p) {
    left[p] = broadcast_byte(row.left[p * row.left_stride + x]);
  }
  const std::uint8_t* const right = row.right + (row.width - 1 - x) + row.min_disparity;
  for (std::size_t d = 0; d < row.lanes; d += kVectorBytes) {
    Bytes total = {};
    for (std::size_t p = 0; p < kPlanes; ++p) {
      total += bit_counts(left[p] ^ load(right + p * row.right_stride + d));
    }
    store(distances + d, total);
  }
}

template <std::size_t kPlanes>
void hamming_planes(const HammingRow& row) {
  for (std::size_t x = 0; x < row.width; ++x) {
    std::uint8_t* const distances = row.distances + x * row.lanes;
    hamming_pixel<kPlanes>(row, x, distances);
    fill_outside(row, x, distances);
  }
}

void hamming_row(const HammingRow& row) {
  if (row.planes == 3) return hamming_planes<3>(row);
  if (row.planes == 6) return hamming_planes<6>(row);
  hamming_planes<kMaxPlanes>(row);
}

void add_row(std::int16_t* total, const std::uint8_t* added, std::size_t count) {
  for (std::size_t i = 0; i < count; i += kWords) {
    store(total + i, load(total + i) + load_widened(added + i));
  }
}

void slide_rows(std::int16_t* total, const std::uint8_t* added, const std::uint8_t* removed,
                std::size_t count) {
  for (std::size_t i = 0; i < count; i += kWords) {
    store(total + i, load(total + i) + load_widened(added + i) - load_widened(removed + i));
  }
}

void box_row(const std::int16_t* total, std::int16_t* cost, std::size_t width, std::size_t lanes,
             std::size_t radius) {
  const std::size_t last = width - 1;
  for (std::size_t d = 0; d < lanes; d += kWords) {  // pixel 0
    Words sum = load(total + d);
    for (std::size_t i = 1; i <= radius; ++i) {
      sum += load(total + d) + load(total + (i < last ? i : last) * lanes + d);
    }
    store(cost + d, sum);
  }
  for (std::size_t x = 1; x < width; ++x) {
    const std::size_t added = x + radius < last ? x + radius : last;
    const std::size_t removed = x > radius ? x - 1 - radius : 0;
    const std::int16_t* const before = cost + (x - 1) * lanes;
    for (std::size_t d = 0; d < lanes; d += kWords) {
      store(cost + x * lanes + d,
            load(before + d) + load(total + added * lanes + d) - load(total + removed * lanes + d));
    }
  }
}

}  // namespace

extern const Kernel kKernel;
const Kernel kKernel = {
    .name = GLIDAR_STEREO_STRING(GLIDAR_KERNEL),
    .census = census_row,
    .hamming = hamming_row,
    .add = add_row,
    .slide = slide_rows,
    .box = box_row,
    .sweep = sweep_row,
    .down = down_row,
    .win = win_row,
};

}  // namespace glidar::stereo::GLIDAR_KERNEL
