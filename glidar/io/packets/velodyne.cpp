// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/velodyne.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>
#include <glidar/io/packets/packet_codec.hpp>
#include <glidar/math/constants.hpp>
#include <glidar/math/portable.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace glidar {
namespace {

constexpr std::size_t kBlockBytes = 4 + 3 * kVelodyneBlockPoints;
constexpr std::size_t kHourOffset = 0xC6;  // of a position packet
constexpr std::size_t kNmeaOffset = 0xCE;
constexpr std::size_t kMaxNmea = 128;
constexpr std::int64_t kMicrosecond = 1'000;
constexpr std::int64_t kHour_us = 3'600'000'000;

VelodynePacket::Block decode_block(ByteView bytes) {
  VelodynePacket::Block block;
  block.flag = get<std::uint16_t>(bytes, 0);
  block.azimuth = get<std::uint16_t>(bytes, 2);
  for (std::size_t i = 0; i < kVelodyneBlockPoints; ++i) {
    block.distance[i] = get<std::uint16_t>(bytes, 4 + 3 * i);
    block.reflectivity[i] = get<std::uint8_t>(bytes, 6 + 3 * i);
  }
  return block;
}

std::int64_t floor_divide(std::int64_t value, std::int64_t by) {
  const std::int64_t quotient = value / by;
  return value % by < 0 ? quotient - 1 : quotient;
}

/// Degrees as NMEA writes them: whole degrees and minutes with four decimals.
std::string nmea_angle(double angle_deg, int digits, const char* sides) {
  const auto minutes_e4 = static_cast<long long>(std::llround(std::abs(angle_deg) * 60.0 * 1e4));
  const long long degrees = minutes_e4 / 600'000;
  const double minutes = static_cast<double>(minutes_e4 % 600'000) * 1e-4;
  return fmt::format("{:0{}}{:07.4f},{}", degrees, digits, minutes, sides[angle_deg < 0.0 ? 1 : 0]);
}

}  // namespace

std::vector<std::byte> encode(const VelodynePacket& packet) {
  Bytes bytes;
  bytes.reserve(kVelodynePacketBytes);
  for (const VelodynePacket::Block& block : packet.blocks) {
    put_little(bytes, block.flag, 2);
    put_little(bytes, block.azimuth, 2);
    for (std::size_t i = 0; i < kVelodyneBlockPoints; ++i) {
      put_little(bytes, block.distance[i], 2);
      put_little(bytes, block.reflectivity[i], 1);
    }
  }
  put_little(bytes, packet.hour_us, 4);
  put_little(bytes, packet.mode, 1);
  put_little(bytes, packet.model, 1);
  return bytes;
}

VelodynePacket decode_velodyne_packet(std::span<const std::byte> payload) {
  require_packet_size(payload, kVelodynePacketBytes, "Velodyne data packet");
  VelodynePacket packet;
  for (std::size_t i = 0; i < kVelodyneBlocks; ++i)
    packet.blocks[i] = decode_block(payload.subspan(i * kBlockBytes, kBlockBytes));
  packet.hour_us = get<std::uint32_t>(payload, kVelodyneBlocks * kBlockBytes);
  packet.mode = get<std::uint8_t>(payload, kVelodynePacketBytes - 2);
  packet.model = get<std::uint8_t>(payload, kVelodynePacketBytes - 1);
  return packet;
}

std::vector<std::byte> encode(const VelodynePosition& position) {
  if (position.nmea.size() > kMaxNmea - 2) {
    throw Error({"Velodyne position packet", std::to_string(position.nmea.size()) + " characters",
                 "at most 126 characters"});
  }
  Bytes bytes(kHourOffset);
  put_little(bytes, position.hour_us, 4);
  put_little(bytes, position.pps_state, 1);
  bytes.resize(kNmeaOffset);
  for (const char letter : position.nmea + "\r\n") bytes.push_back(static_cast<std::byte>(letter));
  bytes.resize(kVelodynePositionBytes);
  return bytes;
}

VelodynePosition decode_velodyne_position(std::span<const std::byte> payload) {
  require_packet_size(payload, kVelodynePositionBytes, "Velodyne position packet");
  VelodynePosition position;
  position.hour_us = get<std::uint32_t>(payload, kHourOffset);
  position.pps_state = get<std::uint8_t>(payload, kHourOffset + 4);
  for (std::size_t i = kNmeaOffset; i < kNmeaOffset + kMaxNmea; ++i) {
    const auto letter = std::to_integer<unsigned char>(payload[i]);
    if (letter < 0x20U || letter > 0x7EU) break;  // the line's end, or no text
    position.nmea.push_back(static_cast<char>(letter));
  }
  return position;
}

std::string nmea_rmc(std::int64_t stamp_ns, double latitude_deg, double longitude_deg,
                     bool has_fix) {
  using std::chrono::days;
  using std::chrono::seconds;
  const std::chrono::sys_seconds time{seconds(floor_divide(stamp_ns, 1'000'000'000))};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{time - day};
  const std::string body = fmt::format(
      "GPRMC,{:02}{:02}{:02},{},{},{},000.0,000.0,{:02}{:02}{:02},000.0,E", clock.hours().count(),
      clock.minutes().count(), clock.seconds().count(), has_fix ? 'A' : 'V',
      nmea_angle(latitude_deg, 2, "NS"), nmea_angle(longitude_deg, 3, "EW"),
      static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
      std::abs(static_cast<int>(date.year())) % 100);
  unsigned sum = 0;
  for (const char letter : body) sum ^= static_cast<unsigned char>(letter);
  return fmt::format("${}*{:02X}", body, sum);
}

std::uint32_t hour_us(std::int64_t stamp_ns) {
  const std::int64_t us = floor_divide(stamp_ns, kMicrosecond);
  return static_cast<std::uint32_t>(us - floor_divide(us, kHour_us) * kHour_us);
}

std::int64_t stamp_in_hour(std::uint32_t hour_us, std::int64_t near_ns) {
  const std::int64_t near_us = floor_divide(near_ns, kMicrosecond);
  const std::int64_t late_us = near_us - std::int64_t{hour_us};
  const std::int64_t hours = floor_divide(late_us + kHour_us / 2, kHour_us);
  return (hours * kHour_us + std::int64_t{hour_us}) * kMicrosecond;
}

namespace {

// VLP-16 User Manual 63-9243, 9.3.2: 2.304 us from laser to laser.
double vlp16_time_ns(std::size_t laser, bool /*is_dual*/) {
  return 2304.0 * static_cast<double>(laser);
}

// VLP-32C User Manual 63-9325: two lasers at once.
double vlp32_time_ns(std::size_t laser, bool /*is_dual*/) {
  const std::size_t pair = laser / 2;
  return 2304.0 * static_cast<double>(pair);
}

// HDL-32E Application Note 63-9277: 1.152 us from laser to laser.
double hdl32_time_ns(std::size_t laser, bool /*is_dual*/) {
  return 1152.0 * static_cast<double>(laser);
}

// HDL-64E S2 and S3 User's Manuals, laser firing time tables: groups of four, both blocks at once.
double hdl64_time_ns(std::size_t laser, bool is_dual) {
  constexpr std::array<double, 4> kSingle_ns = {0.0, 1260.0, 2460.0, 3660.0};
  constexpr std::array<double, 4> kDual_ns = {0.0, 1300.0, 2500.0, 3700.0};
  const std::size_t group = laser % 32 / 4;
  const auto groups = static_cast<double>(group);
  return is_dual ? 7200.0 * groups + kDual_ns[laser % 4] : 6000.0 * groups + kSingle_ns[laser % 4];
}

// VLS-128 User Manual 63-9483, 9.3.1: eight lasers at once, an empty slot after the eighth group.
double vls128_time_ns(std::size_t laser, bool /*is_dual*/) {
  const std::size_t slot = laser / 8 + laser / 64;
  return 2665.0 * static_cast<double>(slot);
}

// Factory bytes: VLP-16 User Manual 63-9243, 9.3.1.7, and those of the other models. HDL-64E: its
// last two bytes are a status (63-HDL64ES3, appendix E). VLS-128: the time is that of the fourth
// group, 7 us after the first.
constexpr std::array<VelodyneModel, 6> kVelodyneModels = {{
    {"VLP-16", 16, 0.002, 55296.0, 55296.0, vlp16_time_ns, 0x22, 0.0},
    {"Puck Hi-Res", 16, 0.002, 55296.0, 55296.0, vlp16_time_ns, 0x24, 0.0},
    {"VLP-32C", 32, 0.004, 55296.0, 55296.0, vlp32_time_ns, 0x28, 0.0},
    {"HDL-32E", 32, 0.002, 46080.0, 46080.0, hdl32_time_ns, 0x21, 0.0},
    {"HDL-64E S3", 64, 0.002, 48000.0, 57600.0, hdl64_time_ns, 0, 0.0},
    {"VLS-128", 128, 0.004, 53300.0, 53300.0, vls128_time_ns, 0xA1, 7000.0},
}};

constexpr double kTimeTolerance_ns = 2.0;

[[noreturn]] void fail(const Sensor& sensor, std::string found, std::string allowed) {
  throw Error({"Velodyne packets of " + sensor.name, std::move(found), std::move(allowed),
               "use the preset of the model, or write clouds"});
}

void check_firings(const Sensor& sensor, const VelodyneLayout& layout) {
  const Spinning& spinning = spinning_optics(sensor, "Velodyne packets");
  const std::string model(layout.model.name);
  if (spinning.channels.size() != layout.model.lasers)
    fail(sensor, std::to_string(spinning.channels.size()) + " channels",
         std::to_string(layout.model.lasers) + ", as the " + model);
  if (spinning.rotation_direction != Spinning::RotationDirection::clockwise)
    fail(sensor, "counterclockwise rotation", "clockwise, as the " + model);
  if (std::abs(sequence_period_ns(spinning) - layout.period_ns()) > kTimeTolerance_ns)
    fail(sensor, "firing_period_us: " + number_text(sequence_period_ns(spinning) * 1e-3),
         number_text(layout.period_ns() * 1e-3) + ", as the " + model +
             (layout.is_dual() ? " with two returns" : ""));
  for (std::size_t laser = 0; laser < layout.model.lasers; ++laser) {
    const double fires_ns = layout.model.fire_time_ns(laser, layout.is_dual());
    const double found_ns = spinning.channels[laser].fire_time_ns;
    if (std::abs(found_ns - fires_ns) <= kTimeTolerance_ns) continue;
    fail(sensor, "fire_time_us[" + std::to_string(laser) + "]: " + number_text(found_ns * 1e-3),
         number_text(fires_ns * 1e-3) + ", as the " + model +
             (layout.is_dual() ? " with two returns" : ""));
  }
}

}  // namespace

const VelodyneModel* find_velodyne_model(const Sensor& sensor) {
  for (const VelodyneModel& model : kVelodyneModels)
    if (sensor.name.find(model.name) != std::string::npos) return &model;
  return nullptr;
}

VelodyneLayout velodyne_layout(const Sensor& sensor) {
  const VelodyneModel* model = find_velodyne_model(sensor);
  if (model == nullptr)
    fail(sensor, "no Velodyne model of this name",
         "VLP-16, Puck Hi-Res, VLP-32C, HDL-32E, HDL-64E S3, VLS-128");
  VelodyneLayout layout{
      .model = *model,
      .returns = select_packet_returns(sensor, "Velodyne packets of " + sensor.name)};
  check_firings(sensor, layout);
  const std::size_t points = kVelodyneBlocks * kVelodyneBlockPoints / (layout.is_dual() ? 2 : 1);
  layout.sequences = points / model->lasers;  // VLS-128, two returns: one, a third is empty
  return layout;
}

VelodyneSlot velodyne_slot(const VelodyneLayout& layout, std::size_t sequence, std::size_t laser,
                           bool is_last) {
  const std::size_t index = sequence * layout.model.lasers + laser;
  const std::size_t block = index / kVelodyneBlockPoints;
  const std::size_t point = index % kVelodyneBlockPoints;
  if (!layout.is_dual()) return {block, point};
  // HDL-64E: both banks of the strongest return, then both of the last (63-HDL64ES3, appendix E);
  // the others: a block of the last return, then the same of the strongest (63-9243, 9.3.3)
  if (layout.model.lasers == 64) return {4 * (block / 2) + block % 2 + (is_last ? 2U : 0U), point};
  return {2 * block + (is_last ? 0U : 1U), point};
}

std::size_t velodyne_bank(const VelodyneLayout& layout, std::size_t block) {
  if (layout.model.lasers == 64) return block % 2;
  if (layout.model.lasers == 128) return layout.is_dual() ? block / 2 % 4 : block % 4;
  return 0;
}

namespace {

constexpr std::size_t kGroupPackets = 16;
constexpr std::string_view kStateTypes = "HMSDNYGTV";
constexpr std::size_t kGroupValues = kGroupPackets - kStateTypes.size();
constexpr std::string_view kMark = "UNIT#";
constexpr std::size_t kFirstLaser = kGroupValues;
constexpr std::size_t kLaserValues = 28;
constexpr std::size_t kLasers = 64;
constexpr std::size_t kParameters = kFirstLaser + kLasers * kLaserValues - kGroupValues;
// What a simulation has no values for: those of the manual's examples.
constexpr std::uint8_t kThreshold = 24;
constexpr std::uint8_t kTemperature = 27;  // degrees Celsius
constexpr std::uint8_t kFirmware = 0x47;
constexpr std::uint8_t kHasSync = 'P';
constexpr std::uint8_t kAutomaticPower = 0xA8;
constexpr std::array<std::uint8_t, 6> kCalibrationTime = {13, 1, 1, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> kAddresses = {192, 168, 3, 43, 192, 168, 3, 255};

/// CRC-16 with the polynomial 8005, the highest bit first.
std::uint16_t add_crc(std::uint16_t crc, std::uint8_t byte) {
  constexpr std::uint32_t kPolynomial = 0x8005;
  std::uint32_t rest = crc ^ (std::uint32_t{byte} << 8U);
  for (int bit = 0; bit < 8; ++bit)
    rest = (rest << 1U) ^ ((rest & 0x8000U) != 0 ? kPolynomial : 0U);
  return static_cast<std::uint16_t>(rest);
}

/// The type of a value: its number in the group, except for those that the manual's table names.
std::uint8_t value_type(std::size_t index) {
  constexpr std::array<std::uint8_t, 6> kSpeedAndView = {0xFE, 0xFF, 0xFC, 0xFD, 0xFA, 0xFB};
  constexpr std::size_t kSpeed = kParameters + kGroupValues;
  constexpr std::size_t kReturns = kParameters + 3 * kGroupValues + 2;
  if (index >= kSpeed && index < kSpeed + kSpeedAndView.size())
    return kSpeedAndView[index - kSpeed];
  if (index == kReturns) return 0xF9;
  if (index == kReturns + 2) return 0xF8;
  const bool is_laser = index >= kFirstLaser && index < kParameters;
  if (is_laser && (index - kFirstLaser) % kLaserValues == 3 * kGroupValues) return 'W';
  return static_cast<std::uint8_t>('1' + index % kGroupValues);
}

}  // namespace

Hdl64Status::Hdl64Status(const Spinning& spinning, PacketReturnMode mode, bool has_position)
    : has_position_(has_position) {
  std::copy(kMark.begin(), kMark.end(), values_.begin());
  values_[kMark.size()] = values_[kMark.size() + 1] = kThreshold;
  std::uint16_t crc = 0;
  for (std::size_t laser = 0; laser < std::min(kLasers, spinning.channels.size()); ++laser) {
    put_laser(laser, spinning.channels[laser]);
    const std::size_t first = kFirstLaser + laser * kLaserValues;
    for (std::size_t i = 1; i <= 20; ++i) crc = add_crc(crc, values_[first + i]);
  }
  std::copy(kCalibrationTime.begin(), kCalibrationTime.end(), values_.begin() + kParameters);
  constexpr std::size_t kSpeed = kParameters + kGroupValues;
  put_number(kSpeed, 60.0 * spinning.rotation_hz);
  put_number(kSpeed + 4, 36'000.0);  // the view begins at 0
  std::copy(kAddresses.begin(), kAddresses.end(), values_.begin() + kSpeed + 8);
  constexpr std::size_t kReturns = kSpeed + 16;
  values_[kReturns] = static_cast<std::uint8_t>(static_cast<int>(mode) -
                                                static_cast<int>(PacketReturnMode::strongest));
  values_[kReturns + 2] = kAutomaticPower;
  put_number(kValues - 2, crc);
}

/// Little-endian, limited to its range; negative numbers as two's complement.
void Hdl64Status::put_number(std::size_t at, double number, int bytes) {
  const long rounded = std::lround(std::clamp(number, -32'768.0, 65'535.0));
  const auto bits = static_cast<std::uint32_t>(rounded);
  for (int i = 0; i < bytes; ++i) {
    const auto shift = static_cast<unsigned>(8 * i);
    values_[at + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(bits >> shift);
  }
}

/// Angles, and the offsets across the beam that move its origin: the height turns with the beam.
/// The correction of distances is the same near and far, and intensities have the whole range of a
/// byte.
void Hdl64Status::put_laser(std::size_t laser, const SpinningChannel& channel) {
  constexpr double kCentidegree_rad = 0.01 * kDegree;
  const std::size_t at = kFirstLaser + laser * kLaserValues;
  const double elevation = channel.elevation_rad;
  const double height_m = channel.origin_m.z() * portable_cos(elevation) -
                          channel.origin_m.x() * portable_sin(elevation);
  values_[at] = static_cast<std::uint8_t>(laser);
  put_number(at + 1, elevation / kCentidegree_rad);
  put_number(at + 3, channel.azimuth_offset_rad / kCentidegree_rad);
  for (const std::size_t correction : {at + 5, at + 7, at + 9})
    put_number(correction, channel.distance_correction_m / kMillimetre_m);
  put_number(at + 11, height_m / kMillimetre_m);
  put_number(at + 13, channel.origin_m.y() / kMillimetre_m);
  put_number(at + 20, 255.0, 1);
}

std::uint8_t Hdl64Status::unit_state(std::size_t index, std::int64_t stamp_ns) const {
  using std::chrono::days;
  const std::chrono::sys_time<std::chrono::nanoseconds> time{std::chrono::nanoseconds(stamp_ns)};
  const auto day = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss clock{std::chrono::floor<std::chrono::seconds>(time) - day};
  const std::array<std::uint8_t, kStateTypes.size()> state = {
      static_cast<std::uint8_t>(clock.hours().count()),
      static_cast<std::uint8_t>(clock.minutes().count()),
      static_cast<std::uint8_t>(clock.seconds().count()),
      static_cast<std::uint8_t>(static_cast<unsigned>(date.day())),
      static_cast<std::uint8_t>(static_cast<unsigned>(date.month())),
      static_cast<std::uint8_t>(static_cast<int>(date.year()) % 100),
      has_position_ ? kHasSync : std::uint8_t{0},
      kTemperature,
      kFirmware};
  return state[index];
}

Hdl64Status::Entry Hdl64Status::at(std::uint64_t packet, std::int64_t stamp_ns) const {
  const std::size_t in_cycle = packet % kCycle;
  const std::size_t in_group = in_cycle % kGroupPackets;
  if (in_group < kStateTypes.size())
    return {static_cast<std::uint8_t>(kStateTypes[in_group]), unit_state(in_group, stamp_ns)};
  const std::size_t index = in_cycle / kGroupPackets * kGroupValues + in_group - kStateTypes.size();
  return {value_type(index), values_[index]};
}

namespace {

constexpr std::array<std::uint16_t, 4> kBankFlags = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
constexpr std::uint16_t kTurn_cdeg = 36'000;
constexpr std::int64_t kPositionPeriod_ns = 6'800'000;  // as a VLP-16 sends them

std::uint16_t azimuth_cdeg(double azimuth_rad) {
  const double clockwise = std::fmod(-azimuth_rad * kDegreesPerRadian * 100.0, kTurn_cdeg);
  const long rounded = std::lround(clockwise < 0.0 ? clockwise + kTurn_cdeg : clockwise);
  return static_cast<std::uint16_t>(rounded % kTurn_cdeg);
}

std::uint16_t distance_units(double range_m, double unit_m) {
  return static_cast<std::uint16_t>(std::clamp(std::round(range_m / unit_m), 0.0, 65535.0));
}

void put(const PacketReturn& found, const VelodyneSlot& slot, double unit_m,
         VelodynePacket& packet) {
  VelodynePacket::Block& block = packet.blocks[slot.block];
  block.distance[slot.point] = distance_units(found.range_m, unit_m);
  block.reflectivity[slot.point] = block.distance[slot.point] > 0 ? found.reflectivity : 0;
}

/// Both returns of a laser, in two blocks with the azimuth of the first.
void put_both(const VelodyneLayout& layout, std::size_t sequence, std::size_t laser,
              const LastAndStrongest& found, VelodynePacket& packet) {
  const VelodyneSlot slot = velodyne_slot(layout, sequence, laser, false);
  const VelodyneSlot other = velodyne_slot(layout, sequence, laser, true);
  packet.blocks[other.block].azimuth = packet.blocks[slot.block].azimuth;
  packet.blocks[other.block].flag = packet.blocks[slot.block].flag;
  put(found.strongest, slot, layout.model.unit_m, packet);
  put(found.last, other, layout.model.unit_m, packet);
}

VelodynePacket make_packet(const VelodyneLayout& layout, std::span<const FiringSequence> firings) {
  VelodynePacket packet;
  const std::size_t lasers = layout.model.lasers;
  for (std::size_t s = 0; s < firings.size(); ++s) {
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      const VelodyneSlot slot = velodyne_slot(layout, s, laser, false);
      VelodynePacket::Block& block = packet.blocks[slot.block];
      if (slot.point == 0) block.azimuth = azimuth_cdeg(firings[s].azimuth_rad);
      block.flag = kBankFlags[velodyne_bank(layout, slot.block)];
      if (layout.is_dual())
        put_both(layout, s, laser, last_and_strongest(firings[s], lasers, laser), packet);
      else
        put(firings[s].returns[laser], slot, layout.model.unit_m, packet);
    }
  }
  packet.hour_us = hour_us(firings.front().stamp_ns + std::llround(layout.model.stamp_offset_ns));
  packet.mode = static_cast<std::uint8_t>(layout.returns.mode);
  packet.model = layout.model.factory_byte;
  return packet;
}

class VelodyneEncoder final : public PacketEncoder {
 public:
  VelodyneEncoder(const Sensor& sensor, const std::optional<GeoPosition>& position)
      : sensor_(sensor), layout_(velodyne_layout(sensor)), position_(position) {
    if (layout_.model.factory_byte != 0) return;
    status_.emplace(std::get<Spinning>(sensor_.optics), layout_.returns.mode,
                    position_.has_value());
  }

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
    for (FiringSequence& sequence : firing_sequences(sensor_, frame, beams, layout_.model.unit_m)) {
      // a gap in time, as between frames that do not join: the packet ends before it
      if (!waiting_.empty() && std::abs(static_cast<double>(sequence.stamp_ns - next_stamp_ns())) >
                                   0.5 * layout_.period_ns())
        finish(packets);
      waiting_.push_back(std::move(sequence));
      if (waiting_.size() == layout_.sequences) send(packets);
    }
  }

  void finish(std::vector<UdpPacket>& packets) override {
    if (waiting_.empty()) return;
    const double turn_rad =
        turn_rate_rad_per_ns(std::get<Spinning>(sensor_.optics)) * layout_.period_ns();
    while (waiting_.size() < layout_.sequences) {
      FiringSequence next{next_stamp_ns(), waiting_.back().azimuth_rad + turn_rad, {}};
      next.returns.resize(waiting_.back().returns.size());
      waiting_.push_back(std::move(next));
    }
    send(packets);
  }

 private:
  [[nodiscard]] std::int64_t next_stamp_ns() const {
    return waiting_.back().stamp_ns + std::llround(layout_.period_ns());
  }

  void send(std::vector<UdpPacket>& packets) {
    const std::int64_t end_ns = next_stamp_ns();
    VelodynePacket packet = make_packet(layout_, waiting_);
    if (status_) {
      const Hdl64Status::Entry entry = status_->at(count_, waiting_.front().stamp_ns);
      packet.mode = entry.type;
      packet.model = entry.value;
    }
    ++count_;
    packets.push_back({end_ns, kVelodynePort, kVelodynePort, glidar::encode(packet)});
    waiting_.clear();
    if (end_ns < next_position_ns_) return;
    next_position_ns_ = end_ns + kPositionPeriod_ns;
    const GeoPosition at = position_.value_or(GeoPosition{});
    const VelodynePosition report{
        hour_us(end_ns), static_cast<std::uint8_t>(position_.has_value() ? 2 : 0),
        nmea_rmc(end_ns, at.latitude_deg, at.longitude_deg, position_.has_value())};
    packets.push_back(
        {end_ns, kVelodynePositionPort, kVelodynePositionPort, glidar::encode(report)});
  }

  Sensor sensor_;
  VelodyneLayout layout_;
  std::optional<GeoPosition> position_;
  std::optional<Hdl64Status> status_;  ///< of an HDL-64E
  std::uint64_t count_ = 0;            ///< of data packets
  std::int64_t next_position_ns_ = INT64_MIN;
  std::vector<FiringSequence> waiting_;
};

class VelodyneDecoder final : public PacketDecoder {
 public:
  explicit VelodyneDecoder(const Sensor& sensor)
      : sensor_(sensor), layout_(velodyne_layout(sensor)), assembler_(sensor) {}

  void decode(const UdpPacket& received, std::vector<DecodedFrame>& frames) override {
    if (received.payload.size() == kVelodynePositionBytes) return;
    const VelodynePacket packet = decode_velodyne_packet(received.payload);
    check(packet);
    const std::int64_t first_ns = stamp_in_hour(packet.hour_us, received.stamp_ns) -
                                  std::llround(layout_.model.stamp_offset_ns);
    for (std::size_t s = 0; s < layout_.sequences; ++s) {
      FiringSequence sequence;
      sequence.stamp_ns = first_ns + std::llround(static_cast<double>(s) * layout_.period_ns());
      sequence.azimuth_rad = azimuth_rad(packet, s);
      sequence.returns.resize(layout_.model.lasers * sensor_.receiver.returns.size());
      for (std::size_t laser = 0; laser < layout_.model.lasers; ++laser)
        read_laser(packet, s, laser, sequence);
      assembler_.add(std::move(sequence), frames);
    }
  }

  void finish(std::vector<DecodedFrame>& frames) override { assembler_.finish(frames); }

 private:
  void check(const VelodynePacket& packet) const {
    const std::string where = "Velodyne packet for " + sensor_.name;
    const std::uint8_t factory = layout_.model.factory_byte;
    if (factory != 0 && packet.model != factory)
      throw Error({where, "factory byte " + std::to_string(packet.model), std::to_string(factory),
                   "decode with the sensor that sent the packets"});
    const auto mode = static_cast<std::uint8_t>(layout_.returns.mode);
    if (factory != 0 && packet.mode != mode)
      throw Error({where, "return mode " + std::to_string(packet.mode), std::to_string(mode),
                   "set receiver.returns of the sensor"});
    const std::size_t used = layout_.model.lasers == 128 && layout_.is_dual() ? 8 : kVelodyneBlocks;
    for (std::size_t block = 0; block < used; ++block) {
      if (packet.blocks[block].flag != kBankFlags[velodyne_bank(layout_, block)] ||
          packet.blocks[block].azimuth > kTurn_cdeg)
        throw Error(
            {where, "block " + std::to_string(block) + " with another flag or an azimuth above 360",
             "the blocks of its model"});
    }
  }

  /// Blocks that contain two sequences have the azimuth of the first: the second is half way to the
  /// next block.
  [[nodiscard]] double azimuth_rad(const VelodynePacket& packet, std::size_t s) const {
    const VelodyneSlot slot = velodyne_slot(layout_, s, 0, false);
    const auto at = static_cast<double>(packet.blocks[slot.block].azimuth);
    const double toward = slot.point == 0 ? 0.0 : 0.5 * block_step_cdeg(packet, slot.block);
    return -(at + toward) * 0.01 * kDegree;
  }

  [[nodiscard]] double block_step_cdeg(const VelodynePacket& packet, std::size_t block) const {
    const std::size_t step = layout_.is_dual() ? 2 : 1;
    const std::size_t from = block + step < kVelodyneBlocks ? block : block - step;
    const int turned = packet.blocks[from + step].azimuth - packet.blocks[from].azimuth;
    return turned < 0 ? turned + kTurn_cdeg : turned;
  }

  void read_laser(const VelodynePacket& packet, std::size_t s, std::size_t laser,
                  FiringSequence& sequence) const {
    const PacketReturn strongest = read(packet, velodyne_slot(layout_, s, laser, false));
    if (!layout_.is_dual()) {
      sequence.returns[laser] = strongest;
      return;
    }
    const PacketReturn last = read(packet, velodyne_slot(layout_, s, laser, true));
    store_returns({last, strongest}, layout_.returns, layout_.model.lasers, laser, sequence);
  }

  [[nodiscard]] PacketReturn read(const VelodynePacket& packet, const VelodyneSlot& slot) const {
    const VelodynePacket::Block& block = packet.blocks[slot.block];
    const std::uint8_t byte = block.reflectivity[slot.point];
    return {block.distance[slot.point] * layout_.model.unit_m, static_cast<float>(byte), byte};
  }

  Sensor sensor_;
  VelodyneLayout layout_;
  RevolutionAssembler assembler_;
};

}  // namespace

bool is_velodyne(const Sensor& sensor) {
  return find_velodyne_model(sensor) != nullptr;
}

std::unique_ptr<PacketEncoder> make_velodyne_encoder(const Sensor& sensor,
                                                     const std::optional<GeoPosition>& position) {
  return std::make_unique<VelodyneEncoder>(sensor, position);
}

std::unique_ptr<PacketDecoder> make_velodyne_decoder(const Sensor& sensor) {
  return std::make_unique<VelodyneDecoder>(sensor);
}

}  // namespace glidar
