// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/ouster_packet.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <algorithm>
#include <string>

namespace glidar {
namespace {

constexpr std::size_t kHeadBytes = 32;
constexpr std::size_t kFootBytes = 32;
constexpr std::size_t kColumnHead = 12;
constexpr std::size_t kLegacyHead = 16;
constexpr std::size_t kLegacyTail = 4;
constexpr std::uint32_t kEncoderTurn = 90'112;  // counts of a revolution, LEGACY
constexpr std::uint32_t kLegacyValid = 0xFFFFFFFF;

constexpr std::array<std::string_view, 4> kNames = {
    "LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8"};

bool is_legacy(const OusterFormat& format) {
  return format.profile == OusterProfile::legacy;
}

std::size_t pixel_bytes(OusterProfile profile) {
  switch (profile) {
    case OusterProfile::rng19_rfl8_sig16_nir16_dual:
      return 16;
    case OusterProfile::rng15_rfl8_nir8:
      return 4;
    default:
      return 12;
  }
}

std::size_t column_bytes(const OusterFormat& format) {
  const std::size_t around = is_legacy(format) ? kLegacyHead + kLegacyTail : kColumnHead;
  return around + format.rows * pixel_bytes(format.profile);
}

std::uint32_t limited(std::uint32_t value, unsigned bits) {
  return std::min(value, (1U << bits) - 1U);
}

/// Range and flags of the RNG19 profiles: 19 and 5 bits.
std::uint32_t range_word(const OusterPixel& pixel) {
  return limited(pixel.range_mm, 19) | (pixel.flags & 0x1FU) << 19U;
}

void put_pixel(Bytes& bytes, OusterProfile profile, const OusterPixel& first,
               const OusterPixel& second) {
  switch (profile) {
    case OusterProfile::legacy:
      put_little(bytes, limited(first.range_mm, 20) | (first.flags & 0xFU) << 28U, 4);
      put_little(bytes, first.reflectivity, 2);
      put_little(bytes, first.signal, 2);
      put_little(bytes, first.near_ir, 4);
      return;
    case OusterProfile::rng19_rfl8_sig16_nir16:
      put_little(bytes, range_word(first), 4);
      put_little(bytes, first.reflectivity, 2);
      put_little(bytes, first.signal, 2);
      put_little(bytes, first.near_ir, 3);
      put_little(bytes, first.window, 1);
      return;
    case OusterProfile::rng19_rfl8_sig16_nir16_dual:
      for (const OusterPixel& pixel : {first, second})
        put_little(bytes, range_word(pixel) | std::uint32_t{pixel.reflectivity} << 24U, 4);
      put_little(bytes, first.signal, 2);
      put_little(bytes, second.signal, 2);
      put_little(bytes, first.near_ir, 3);
      put_little(bytes, first.window, 1);
      return;
    case OusterProfile::rng15_rfl8_nir8:
      put_little(bytes, limited((first.range_mm + 4) / 8, 15) | (first.flags & 1U) << 15U, 2);
      put_little(bytes, first.reflectivity, 1);
      put_little(bytes, limited(first.near_ir / 16U, 8), 1);
      return;
  }
}

OusterPixel rng19(std::uint32_t word) {
  return {.range_mm = word & 0x7FFFFU, .flags = static_cast<std::uint8_t>(word >> 19U & 0x1FU)};
}

void get_pixel(ByteView bytes, OusterProfile profile, OusterPixel& first, OusterPixel* second) {
  const auto word = get<std::uint16_t>(bytes, 0);
  switch (profile) {
    case OusterProfile::legacy:
    case OusterProfile::rng19_rfl8_sig16_nir16: {
      const auto range = get<std::uint32_t>(bytes, 0);
      first = rng19(range);
      if (profile == OusterProfile::legacy)
        first = {.range_mm = range & 0xFFFFFU, .flags = static_cast<std::uint8_t>(range >> 28U)};
      else
        first.window = get<std::uint8_t>(bytes, 11);
      first.reflectivity = get<std::uint8_t>(bytes, 4);
      first.signal = get<std::uint16_t>(bytes, 6);
      first.near_ir = get<std::uint16_t>(bytes, 8);
      return;
    }
    case OusterProfile::rng19_rfl8_sig16_nir16_dual:
      first = rng19(get<std::uint32_t>(bytes, 0));
      *second = rng19(get<std::uint32_t>(bytes, 4));
      first.reflectivity = get<std::uint8_t>(bytes, 3);
      second->reflectivity = get<std::uint8_t>(bytes, 7);
      first.signal = get<std::uint16_t>(bytes, 8);
      second->signal = get<std::uint16_t>(bytes, 10);
      first.near_ir = second->near_ir = get<std::uint16_t>(bytes, 12);
      first.window = second->window = get<std::uint8_t>(bytes, 15);
      return;
    case OusterProfile::rng15_rfl8_nir8:
      first.range_mm = 8U * (word & 0x7FFFU);
      first.flags = static_cast<std::uint8_t>(word >> 15U);
      first.reflectivity = get<std::uint8_t>(bytes, 2);
      first.near_ir = static_cast<std::uint16_t>(16U * get<std::uint8_t>(bytes, 3));
      return;
  }
}

void put_column(Bytes& bytes, const OusterColumn& column, const OusterPacket& packet,
                const OusterFormat& format, std::uint32_t columns_per_turn) {
  put_little(bytes, column.stamp_ns, 8);
  put_little(bytes, column.measurement, 2);
  if (is_legacy(format)) {
    put_little(bytes, packet.frame, 2);
    put_little(bytes, std::uint64_t{column.measurement} * kEncoderTurn / columns_per_turn, 4);
  } else {
    put_little(bytes, column.is_valid ? 1 : 0, 2);
  }
  for (std::size_t row = 0; row < format.rows; ++row) {
    const std::size_t second = ouster_returns(format.profile) == 2 ? format.rows + row : row;
    put_pixel(bytes, format.profile, column.pixels[row], column.pixels[second]);
  }
  if (is_legacy(format)) put_little(bytes, column.is_valid ? kLegacyValid : 0, 4);
}

OusterColumn get_column(ByteView bytes, const OusterFormat& format) {
  OusterColumn column;
  column.stamp_ns = get<std::uint64_t>(bytes, 0);
  column.measurement = get<std::uint16_t>(bytes, 8);
  column.is_valid = is_legacy(format)
                        ? get<std::uint32_t>(bytes, bytes.size() - kLegacyTail) == kLegacyValid
                        : (get<std::uint16_t>(bytes, 10) & 1U) != 0;
  const bool is_dual = ouster_returns(format.profile) == 2;
  column.pixels.resize(format.rows * ouster_returns(format.profile));
  const std::size_t size = pixel_bytes(format.profile);
  const std::size_t head = is_legacy(format) ? kLegacyHead : kColumnHead;
  for (std::size_t row = 0; row < format.rows; ++row) {
    OusterPixel* second = is_dual ? &column.pixels[format.rows + row] : nullptr;
    get_pixel(bytes.subspan(head + row * size, size), format.profile, column.pixels[row], second);
  }
  return column;
}

void check_columns(const OusterPacket& packet, const OusterFormat& format) {
  const std::size_t pixels = format.rows * ouster_returns(format.profile);
  bool fits = packet.columns.size() == format.columns_per_packet;
  for (const OusterColumn& column : packet.columns) fits = fits && column.pixels.size() == pixels;
  if (!fits) throw Error({"Ouster packet", "columns of another size", "those of its format"});
}

/// Header and footer of all profiles but LEGACY.
void get_frame(ByteView payload, OusterPacket& packet) {
  if (get<std::uint16_t>(payload, 0) != 1)
    throw Error({"Ouster packet", "type " + std::to_string(get<std::uint16_t>(payload, 0)), "1"});
  packet.frame = get<std::uint16_t>(payload, 2);
  packet.init_id = static_cast<std::uint32_t>(get_little(payload, 4, 3));
  packet.serial = get_little(payload, 7, 5);
  packet.alert = get<std::uint8_t>(payload, 12);
  std::copy_n(payload.begin() + 13, packet.status.size(), packet.status.begin());
  const std::size_t end = payload.size() - 8;
  const ByteView foot = payload.subspan(payload.size() - kFootBytes);
  std::copy_n(foot.begin(), packet.footer.size(), packet.footer.begin());
  const auto crc = get<std::uint64_t>(payload, end);
  packet.has_crc = crc == crc64(payload.first(end));
  // firmware before 3.0 has zeros, or a mark that ends with DEADBEEF
  const bool is_unused = crc == 0 || (crc & 0xFFFFFFFFU) == 0xEFBEADDEU ||
                         (crc >> 32U) == 0xEFBEADDEU || (crc >> 32U) == 0xDEADBEEFU;
  if (!packet.has_crc) packet.mark = crc;
  if (!packet.has_crc && !is_unused)
    throw Error({"Ouster packet", "a wrong CRC-64", "", "discard the packet: it is damaged"});
}

}  // namespace

std::span<const std::string_view> ouster_profile_names() {
  return kNames;
}

std::string_view name(OusterProfile profile) {
  return kNames[static_cast<std::size_t>(profile)];
}

std::size_t ouster_returns(OusterProfile profile) {
  return profile == OusterProfile::rng19_rfl8_sig16_nir16_dual ? 2 : 1;
}

std::size_t ouster_packet_bytes(const OusterFormat& format) {
  const std::size_t around = is_legacy(format) ? 0 : kHeadBytes + kFootBytes;
  return around + format.columns_per_packet * column_bytes(format);
}

std::vector<std::byte> encode(const OusterPacket& packet, const OusterFormat& format,
                              std::uint32_t columns_per_turn) {
  check_columns(packet, format);
  Bytes bytes;
  bytes.reserve(ouster_packet_bytes(format));
  if (!is_legacy(format)) {
    put_little(bytes, 1, 2);
    put_little(bytes, packet.frame, 2);
    put_little(bytes, packet.init_id, 3);
    put_little(bytes, packet.serial, 5);
    put_little(bytes, packet.alert, 1);
    bytes.insert(bytes.end(), packet.status.begin(), packet.status.end());
  }
  for (const OusterColumn& column : packet.columns)
    put_column(bytes, column, packet, format, columns_per_turn);
  if (is_legacy(format)) return bytes;
  bytes.insert(bytes.end(), packet.footer.begin(), packet.footer.end());
  put_little(bytes, packet.has_crc ? crc64(bytes) : packet.mark, 8);
  return bytes;
}

OusterPacket decode_ouster_packet(std::span<const std::byte> payload, const OusterFormat& format) {
  require_packet_size(payload, ouster_packet_bytes(format), "Ouster lidar packet");
  OusterPacket packet;
  if (is_legacy(format)) {
    packet.frame = get<std::uint16_t>(payload, 10);
  } else {
    get_frame(payload, packet);
  }
  const std::size_t head = is_legacy(format) ? 0 : kHeadBytes;
  const std::size_t size = column_bytes(format);
  for (std::size_t i = 0; i < format.columns_per_packet; ++i)
    packet.columns.push_back(get_column(payload.subspan(head + i * size, size), format));
  return packet;
}

std::uint64_t crc64(std::span<const std::byte> bytes) {
  static constexpr std::array<std::uint64_t, 256> kTable = [] {
    std::array<std::uint64_t, 256> table{};
    for (std::uint64_t i = 0; i < table.size(); ++i) {
      std::uint64_t rest = i;
      for (int bit = 0; bit < 8; ++bit)
        rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xC96C5795D7870F42U : 0U);
      table[i] = rest;
    }
    return table;
  }();
  std::uint64_t crc = UINT64_MAX;
  for (const std::byte byte : bytes)
    crc = kTable[(crc ^ std::to_integer<std::uint64_t>(byte)) & 0xFFU] ^ (crc >> 8U);
  return ~crc;
}

std::vector<std::byte> encode(const OusterImu& imu) {
  Bytes bytes;
  for (const std::uint64_t stamp_ns : {imu.stamp_ns, imu.acceleration_stamp_ns, imu.rate_stamp_ns})
    put_little(bytes, stamp_ns, 8);
  for (const float value : imu.acceleration_g) put_float(bytes, value);
  for (const float value : imu.rate_deg_s) put_float(bytes, value);
  return bytes;
}

OusterImu decode_ouster_imu(std::span<const std::byte> payload) {
  require_packet_size(payload, kOusterImuBytes, "Ouster IMU packet");
  OusterImu imu{get<std::uint64_t>(payload, 0), get<std::uint64_t>(payload, 8),
                get<std::uint64_t>(payload, 16)};
  for (std::size_t i = 0; i < 3; ++i) {
    imu.acceleration_g[i] = get_float(payload, 24 + 4 * i);
    imu.rate_deg_s[i] = get_float(payload, 36 + 4 * i);
  }
  return imu;
}

}  // namespace glidar
