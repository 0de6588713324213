// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/ouster.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/math/constants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
namespace {

constexpr std::size_t kHeadBytes = 32;
constexpr std::size_t kFootBytes = 32;
constexpr std::size_t kColumnHead = 12;
constexpr std::size_t kLegacyHead = 16;
constexpr std::size_t kLegacyTail = 4;
constexpr std::uint32_t kEncoderTurn = 90'112;  // counts of a revolution, LEGACY
constexpr std::uint32_t kLegacyValid = 0xFFFFFFFF;

constexpr std::array<std::string_view, 6> kNames = {
    "LEGACY",          "RNG19_RFL8_SIG16_NIR16",       "RNG19_RFL8_SIG16_NIR16_DUAL",
    "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16_RGB16", "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"};

bool is_legacy(const OusterFormat& format) {
  return format.profile == OusterProfile::legacy;
}

std::size_t pixel_bytes(OusterProfile profile) {
  switch (profile) {
    case OusterProfile::rng19_rfl8_sig16_nir16_dual:
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16:
      return 16;
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual:
      return 20;
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

/// Range, flags and reflectivity in one word.
std::uint32_t return_word(const OusterPixel& pixel) {
  return range_word(pixel) | std::uint32_t{pixel.reflectivity} << 24U;
}

void put_colour(Bytes& bytes, const OusterPixel& pixel) {
  for (const float value : pixel.colour) put_little(bytes, Eigen::half(value).x, 2);
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
      for (const OusterPixel& pixel : {first, second}) put_little(bytes, return_word(pixel), 4);
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
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16:
      put_little(bytes, return_word(first), 4);
      put_little(bytes, first.signal, 2);
      put_little(bytes, first.near_ir, 2);
      put_colour(bytes, first);
      put_little(bytes, 0, 2);
      return;
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual:
      for (const OusterPixel& pixel : {first, second}) put_little(bytes, return_word(pixel), 4);
      put_little(bytes, first.signal, 2);
      put_little(bytes, second.signal, 2);
      put_little(bytes, first.near_ir, 2);
      put_colour(bytes, first);
      return;
  }
}

OusterPixel rng19(std::uint32_t word) {
  return {.range_mm = word & 0x7FFFFU, .flags = static_cast<std::uint8_t>(word >> 19U & 0x1FU)};
}

/// Of return_word().
OusterPixel return_of(std::uint32_t word) {
  OusterPixel pixel = rng19(word);
  pixel.reflectivity = static_cast<std::uint8_t>(word >> 24U);
  return pixel;
}

std::array<float, 3> get_colour(ByteView bytes, std::size_t at) {
  std::array<float, 3> colour{};
  for (std::size_t i = 0; i < colour.size(); ++i)
    colour[i] = static_cast<float>(
        Eigen::half(Eigen::half_impl::raw_uint16_to_half(get<std::uint16_t>(bytes, at + 2 * i))));
  return colour;
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
      first = return_of(get<std::uint32_t>(bytes, 0));
      *second = return_of(get<std::uint32_t>(bytes, 4));
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
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16:
      first = return_of(get<std::uint32_t>(bytes, 0));
      first.signal = get<std::uint16_t>(bytes, 4);
      first.near_ir = get<std::uint16_t>(bytes, 6);
      first.colour = get_colour(bytes, 8);
      return;
    case OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual:
      first = return_of(get<std::uint32_t>(bytes, 0));
      *second = return_of(get<std::uint32_t>(bytes, 4));
      first.signal = get<std::uint16_t>(bytes, 8);
      second->signal = get<std::uint16_t>(bytes, 10);
      first.near_ir = second->near_ir = get<std::uint16_t>(bytes, 12);
      first.colour = second->colour = get_colour(bytes, 14);
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
  return profile == OusterProfile::rng19_rfl8_sig16_nir16_dual ||
                 profile == OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual
             ? 2
             : 1;
}

bool has_colour(OusterProfile profile) {
  return profile == OusterProfile::rng19_rfl8_sig16_nir16_rgb16 ||
         profile == OusterProfile::rng19_rfl8_sig16_nir16_rgb16_dual;
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

namespace {

using Json = nlohmann::ordered_json;

const TextFileKind kOusterJson = {"a JSON file of an Ouster sensor", 1, ""};
constexpr std::array<const char*, 6> kModes = {"512x10",  "512x20",  "1024x10",
                                               "1024x20", "2048x10", "4096x5"};
constexpr std::size_t kColumnsPerPacket = 16;

[[noreturn]] void fail_of(const Sensor& sensor, std::string found, std::string allowed) {
  throw Error({"Ouster packets of " + sensor.name, std::move(found), std::move(allowed),
               "use a preset of an Ouster sensor, or write clouds"});
}

std::string mode_of(const Sensor& sensor, const Spinning& spinning) {
  const std::string mode =
      std::to_string(spinning.columns_per_turn) + "x" + number_text(spinning.rotation_hz);
  if (std::find(kModes.begin(), kModes.end(), mode) != kModes.end()) return mode;
  fail_of(sensor, "columns and turns per second: " + mode,
          "512x10, 512x20, 1024x10, 1024x20, 2048x10, 4096x5");
}

/// "OS-1-128" of "Ouster OS1-128".
std::string product_line(const Sensor& sensor) {
  const std::string prefix = "Ouster OS";
  std::string line = is_ouster(sensor) ? sensor.name.substr(prefix.size()) : "1-128";
  return "OS-" + line.substr(0, line.find(' '));
}

std::vector<double> degrees_of(const Spinning& spinning, double SpinningChannel::*angle_rad,
                               double sign) {
  std::vector<double> angles_deg;
  for (const SpinningChannel& channel : spinning.channels) {
    const double angle_deg = sign * channel.*angle_rad * kDegreesPerRadian;
    angles_deg.push_back(std::round(angle_deg * 1e9) * 1e-9);
  }
  return angles_deg;
}

Json beam_intrinsics(const Spinning& spinning) {
  const double origin_mm = std::round(spinning.beam_origin_m * 1e9) * 1e-6;
  const double height_mm = std::round(spinning.beam_origin_height_m * 1e9) * 1e-6;
  return {{"beam_altitude_angles", degrees_of(spinning, &SpinningChannel::elevation_rad, 1.0)},
          {"beam_azimuth_angles", degrees_of(spinning, &SpinningChannel::azimuth_offset_rad, -1.0)},
          {"beam_to_lidar_transform",
           {1.0, 0.0, 0.0, origin_mm, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, height_mm, 0.0, 0.0, 0.0,
            1.0}},
          {"lidar_origin_to_beam_origin_mm", origin_mm}};
}

/// Columns by which each row is rotated against the head.
std::vector<int> pixel_shifts(const Spinning& spinning) {
  std::vector<int> shifts;
  for (const SpinningChannel& channel : spinning.channels) {
    const double turns = -channel.azimuth_offset_rad / kTwoPi;
    shifts.push_back(static_cast<int>(std::lround(turns * spinning.columns_per_turn)));
  }
  return shifts;
}

/// The first and the last column in the sector.
std::vector<std::uint32_t> column_window(const Spinning& spinning) {
  const std::uint32_t columns = spinning.columns_per_turn;
  std::vector<std::uint32_t> window = {0, columns - 1};
  for (std::uint32_t column = 0; column < columns; ++column) {
    const auto k = std::int64_t{column};
    if (!is_in_sector(spinning, k)) continue;
    if (!is_in_sector(spinning, k - 1)) window[0] = column;
    if (!is_in_sector(spinning, k + 1)) window[1] = column;
  }
  return window;
}

Json config_of(const Sensor& sensor, const OusterFormat& format, const OusterIdentity& identity) {
  const Spinning& spinning = spinning_optics(sensor, "Ouster packets");
  return {{"azimuth_window", {0, 360000}},
          {"columns_per_packet", format.columns_per_packet},
          {"lidar_mode", mode_of(sensor, spinning)},
          {"multipurpose_io_mode", "OFF"},
          {"operating_mode", "NORMAL"},
          {"phase_lock_enable", false},
          {"phase_lock_offset", 0},
          {"signal_multiplier", 1},
          {"timestamp_mode", "TIME_FROM_INTERNAL_OSC"},
          {"udp_dest", identity.udp_destination},
          {"udp_port_imu", identity.imu_port},
          {"udp_port_lidar", identity.lidar_port},
          {"udp_profile_imu", "LEGACY"},
          {"udp_profile_lidar", name(format.profile)}};
}

Json data_format_of(const Spinning& spinning, const OusterFormat& format) {
  return {{"column_window", column_window(spinning)},
          {"columns_per_frame", spinning.columns_per_turn},
          {"columns_per_packet", format.columns_per_packet},
          {"fps", static_cast<int>(std::lround(spinning.rotation_hz))},
          {"pixel_shift_by_row", pixel_shifts(spinning)},
          {"pixels_per_column", format.rows},
          {"udp_profile_imu", "LEGACY"},
          {"udp_profile_lidar", name(format.profile)}};
}

Json info_of(const Sensor& sensor, const OusterIdentity& identity) {
  return {{"build_date", "2024-01-01T00:00:00Z"},
          {"build_rev", "v3.1.0"},
          {"image_rev", "ousteros-image-prod-bootes-v3.1.0+20240101000000"},
          {"initialization_id", identity.init_id},
          {"prod_line", product_line(sensor)},
          {"prod_pn", "840-000000-00"},
          {"prod_sn", std::to_string(identity.serial)},
          {"status", "RUNNING"}};
}

/// A homogeneous matrix, row by row, with the translation in mm.
std::vector<double> matrix_mm(const Pose& pose) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) {
      const bool is_translation = row < 3 && col == 3;
      numbers.push_back(pose.matrix()(row, col) / (is_translation ? kMillimetre_m : 1.0));
    }
  }
  return numbers;
}

std::uint64_t whole_number(const nlohmann::json* value, std::uint64_t otherwise, std::uint64_t max,
                           const std::string& where) {
  if (value == nullptr || value->is_null()) return otherwise;
  if (value->is_number_unsigned() && value->get<std::uint64_t>() <= max)
    return value->get<std::uint64_t>();
  throw Error({where, "no whole number", "0 to " + std::to_string(max),
               "use the sensor's own metadata JSON"});
}

OusterProfile profile_of(const nlohmann::json* value, const std::string& where) {
  if (value == nullptr || value->is_null()) return OusterProfile::legacy;
  const std::string word = value->is_string() ? value->get<std::string>() : "";
  const auto names = ouster_profile_names();
  const auto at = std::find(names.begin(), names.end(), word);
  if (at != names.end()) return static_cast<OusterProfile>(at - names.begin());
  throw Error({where, "'" + shown(word) + "'", fmt::format("{}", fmt::join(names, ", ")),
               "record with one of these profiles"});
}

/// The packets of a sensor. Throws Error, naming the sensor, unless its columns and rate are a mode
/// of Ouster sensors and its rows and returns fit the profile.
OusterFormat ouster_format(const Sensor& sensor, const OusterOptions& options) {
  const Spinning& spinning = spinning_optics(sensor, "Ouster packets");
  mode_of(sensor, spinning);
  const std::size_t returns = sensor.receiver.returns.size();
  if (returns > 2) fail_of(sensor, std::to_string(returns) + " returns", "1 or 2");
  const bool is_dual = returns == 2;
  OusterFormat format;
  format.profile = options.profile.value_or(is_dual ? OusterProfile::rng19_rfl8_sig16_nir16_dual
                                                    : OusterProfile::rng19_rfl8_sig16_nir16);
  if (ouster_returns(format.profile) != returns)
    fail_of(sensor, std::to_string(returns) + " returns with " + std::string(name(format.profile)),
            "two returns with the profiles ..._DUAL, one with the others");
  format.rows = spinning.channels.size();
  format.columns_per_packet = kColumnsPerPacket;
  if (format.rows != 16 && format.rows != 32 && format.rows != 64 && format.rows != 128)
    fail_of(sensor, std::to_string(format.rows) + " rows", "16, 32, 64 or 128");
  for (const SpinningChannel& channel : spinning.channels)
    if (channel.fire_time_ns != 0.0 || !channel.origin_m.isZero(0.0))
      fail_of(sensor, "fire times or origins of channels", "all channels fire together");
  if (spinning.rotation_direction != Spinning::RotationDirection::clockwise)
    fail_of(sensor, "counterclockwise rotation", "clockwise");
  return format;
}

constexpr std::uint64_t kMaxInitId = (1U << 24U) - 1U;

/// Number of the column: the encoder angle is 2 pi (1 - number / columns per turn).
std::uint16_t measurement_of(const Spinning& spinning, double azimuth_rad) {
  const double turned = (azimuth_at_start_rad(spinning) - azimuth_rad) / kTwoPi;
  const double share = turned - std::floor(turned);
  const long number = std::lround(share * spinning.columns_per_turn);
  return static_cast<std::uint16_t>(number % static_cast<long>(spinning.columns_per_turn));
}

OusterPixel pixel_of(const PacketReturn& found) {
  if (!(found.range_m > 0.0)) return {};
  const double signal = std::clamp(std::round(static_cast<double>(found.intensity)), 0.0, 65535.0);
  const double range_mm = std::clamp(std::round(found.range_m / kMillimetre_m), 0.0, 1e9);
  return {.range_mm = static_cast<std::uint32_t>(range_mm),
          .reflectivity = found.reflectivity,
          .signal = static_cast<std::uint16_t>(signal),
          .colour = found.colour};
}

class OusterEncoder final : public PacketEncoder {
 public:
  OusterEncoder(Sensor sensor, const OusterOptions& options)
      : sensor_(std::move(sensor)),
        format_(ouster_format(sensor_, options)),
        identity_(options.identity) {}

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    if (has_colour(format_.profile) && frame.ground_truth.colour.empty())
      throw Error({"Ouster packets of " + sensor_.name, "a frame without the column colour",
                   "colours with " + std::string(name(format_.profile)),
                   "simulate with this column: columns=[..., \"colour\"] in Python"});
    const double unit_m =
        (format_.profile == OusterProfile::rng15_rfl8_nir8 ? 8.0 : 1.0) * kMillimetre_m;
    for (const FiringSequence& sequence : firing_sequences(sensor_, frame, beams, unit_m)) {
      const std::uint16_t number = measurement_of(spinning(), sequence.azimuth_rad);
      const std::size_t first = number - number % format_.columns_per_packet;
      const std::int64_t gap_ns = sequence.stamp_ns - last_ns_;
      const bool joins = is_started_ && first == first_ && number > last_ && gap_ns >= 0 &&
                         gap_ns < std::int64_t{1'000'000'000};
      if (!joins) start_packet(first, number, packets);
      fill(sequence, number);
      if (number - first + 1U == format_.columns_per_packet) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (is_started_) send(packets);
  }

 private:
  [[nodiscard]] const Spinning& spinning() const { return std::get<Spinning>(sensor_.optics); }

  void start_packet(std::size_t first, std::uint16_t number, std::vector<UdpPacket>& packets) {
    finish(packets);
    if (has_frame_ && number <= last_) ++frame_;
    has_frame_ = true;
    is_started_ = true;
    first_ = first;
    packet_ = {};
    packet_.frame = frame_;
    packet_.init_id = identity_.init_id;
    packet_.serial = identity_.serial;
    packet_.columns.resize(format_.columns_per_packet);
    for (std::size_t i = 0; i < packet_.columns.size(); ++i) {
      OusterColumn& column = packet_.columns[i];
      column.measurement = static_cast<std::uint16_t>(first + i);
      column.pixels.resize(format_.rows * ouster_returns(format_.profile));
    }
  }

  void fill(const FiringSequence& sequence, std::uint16_t number) {
    OusterColumn& column = packet_.columns[number - first_];
    column.stamp_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, sequence.stamp_ns));
    column.is_valid = true;
    std::transform(sequence.returns.begin(), sequence.returns.end(), column.pixels.begin(),
                   pixel_of);
    last_ = number;
    last_ns_ = sequence.stamp_ns;
  }

  void send(std::vector<UdpPacket>& packets) {
    is_started_ = false;
    const std::uint32_t columns = spinning().columns_per_turn;
    packets.push_back({last_ns_ + std::llround(sequence_period_ns(spinning())),
                       identity_.lidar_port, identity_.lidar_port,
                       glidar::encode(packet_, format_, columns)});
  }

  Sensor sensor_;
  OusterFormat format_;
  OusterIdentity identity_;
  OusterPacket packet_;
  std::size_t first_ = 0;  ///< number of the packet's first column
  std::uint16_t last_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint16_t frame_ = 0;
  bool is_started_ = false;
  bool has_frame_ = false;
};

class OusterDecoder final : public PacketDecoder {
 public:
  explicit OusterDecoder(OusterSource source)
      : source_(std::move(source)),
        assembler_(source_.sensor, true, has_colour(source_.format.profile)) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    if (received.port != source_.identity.lidar_port) return;
    const OusterPacket packet = decode_ouster_packet(received.payload, source_.format);
    const bool has_id = source_.format.profile != OusterProfile::legacy;
    if (has_id && source_.identity.init_id != 0 && packet.init_id != source_.identity.init_id) {
      throw Error({"Ouster packet", "initialization_id " + std::to_string(packet.init_id),
                   std::to_string(source_.identity.init_id), "use the metadata of this recording"});
    }
    const auto& spinning = std::get<Spinning>(source_.sensor.optics);
    for (const OusterColumn& column : packet.columns) {
      if (!column.is_valid || column.measurement >= spinning.columns_per_turn) continue;
      if (column.stamp_ns > std::uint64_t{INT64_MAX} / 2) continue;
      assembler_.add(sequence_of(column, spinning), frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  [[nodiscard]] FiringSequence sequence_of(const OusterColumn& column,
                                           const Spinning& spinning) const {
    FiringSequence sequence;
    sequence.stamp_ns = static_cast<std::int64_t>(column.stamp_ns);
    sequence.azimuth_rad =
        azimuth_at_start_rad(spinning) - kTwoPi * column.measurement / spinning.columns_per_turn;
    const bool has_signal = source_.format.profile != OusterProfile::rng15_rfl8_nir8;
    const auto add = [&](const OusterPixel& pixel) {
      const double value = has_signal ? pixel.signal : pixel.reflectivity;
      sequence.returns.push_back({pixel.range_mm * kMillimetre_m, static_cast<float>(value),
                                  pixel.reflectivity, pixel.colour});
    };
    const OusterFormat& format = source_.format;
    if (format.slots.empty()) std::for_each(column.pixels.begin(), column.pixels.end(), add);
    for (std::size_t first = 0; first < column.pixels.size(); first += format.rows)
      for (const std::size_t slot : format.slots) add(column.pixels[first + slot]);
    return sequence;
  }

  OusterSource source_;
  RevolutionAssembler assembler_;
};

}  // namespace

bool is_ouster(const Sensor& sensor) {
  return sensor.name.starts_with("Ouster OS");
}

std::unique_ptr<PacketEncoder> make_ouster_encoder(const Sensor& sensor,
                                                   const OusterOptions& options) {
  if (options.identity.init_id > kMaxInitId)
    throw Error({"Ouster packets", "initialization_id " + std::to_string(options.identity.init_id),
                 "at most 16777215"});
  return std::make_unique<OusterEncoder>(sensor, options);
}

std::string ouster_metadata(const Sensor& sensor, const OusterOptions& options) {
  const OusterFormat format = ouster_format(sensor, options);
  const Spinning& spinning = spinning_optics(sensor, "Ouster packets");
  const Json all = {
      {"beam_intrinsics", beam_intrinsics(spinning)},
      {"calibration_status",
       {{"reflectivity", {{"timestamp", "2024-01-01T00:00:00"}, {"valid", true}}}}},
      {"config_params", config_of(sensor, format, options.identity)},
      {"imu_intrinsics", {{"imu_to_sensor_transform", matrix_mm(options.sensor_from_imu)}}},
      {"lidar_data_format", data_format_of(spinning, format)},
      {"lidar_intrinsics",
       {{"lidar_to_sensor_transform",
         {-1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}}}},
      {"sensor_info", info_of(sensor, options.identity)},
      {"user_data", ""}};
  return all.dump(2) + "\n";
}

OusterSource load_ouster_source(const std::filesystem::path& metadata) {
  return parse_ouster_source(read_text_file(metadata, kOusterJson), metadata.string());
}

OusterSource parse_ouster_source(const std::string& text, const std::string& file) {
  OusterSource source;
  OusterMetadata metadata = parse_ouster_metadata(text, file);
  const Spinning& spinning = metadata.spinning;
  const auto all = parse_json<nlohmann::json>(file, text);
  const auto value = [&](const char* key) { return find_ouster_value(all, key); };
  source.format.profile = profile_of(value("udp_profile_lidar"), file + ": udp_profile_lidar");
  source.format.rows = metadata.slot_count;
  source.format.slots = std::move(metadata.slots);
  source.format.columns_per_packet = whole_number(value("columns_per_packet"), kColumnsPerPacket,
                                                  64, file + ": columns_per_packet");
  if (source.format.columns_per_packet == 0)
    throw Error({file + ": columns_per_packet", "0", "1 to 64"});
  source.identity.init_id = static_cast<std::uint32_t>(
      whole_number(value("initialization_id"), 0, UINT32_MAX, file + ": initialization_id"));
  source.identity.lidar_port = static_cast<std::uint16_t>(
      whole_number(value("udp_port_lidar"), kOusterLidarPort, 65'535, file + ": udp_port_lidar"));
  source.identity.imu_port = static_cast<std::uint16_t>(
      whole_number(value("udp_port_imu"), kOusterImuPort, 65'535, file + ": udp_port_imu"));
  const nlohmann::json* line = value("prod_line");
  const bool has_line = line != nullptr && line->is_string();
  source.sensor.name = "Ouster " + (has_line ? shown(line->get<std::string>()) : "sensor");
  source.sensor.rate_hz = spinning.rotation_hz;
  source.sensor.notes = std::move(metadata.notes);
  source.sensor.optics = std::move(metadata.spinning);
  source.sensor.receiver.returns.resize(ouster_returns(source.format.profile));
  return source;
}

std::unique_ptr<PacketDecoder> make_ouster_decoder(const OusterSource& source) {
  return std::make_unique<OusterDecoder>(source);
}

std::unique_ptr<PacketDecoder> make_ouster_decoder(const Sensor& sensor,
                                                   const OusterOptions& options) {
  return std::make_unique<OusterDecoder>(
      OusterSource{sensor, ouster_format(sensor, options), options.identity});
}

}  // namespace glidar
