// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/ouster_codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_text.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/io/formats/ouster_file.hpp>
#include <glidar/io/packets/firing_sequence.hpp>
#include <glidar/math/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace glidar {
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
  throw Error({where, "'" + shown(word) + "'",
               "LEGACY, RNG19_RFL8_SIG16_NIR16, RNG19_RFL8_SIG16_NIR16_DUAL, RNG15_RFL8_NIR8",
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
            "two returns with RNG19_RFL8_SIG16_NIR16_DUAL, one with the others");
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
          .signal = static_cast<std::uint16_t>(signal)};
}

class OusterEncoder final : public PacketEncoder {
 public:
  OusterEncoder(Sensor sensor, const OusterOptions& options)
      : sensor_(std::move(sensor)),
        format_(ouster_format(sensor_, options)),
        identity_(options.identity) {}

  void encode(const Frame& frame, const Beams& beams, std::vector<UdpPacket>& packets) override {
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
      : source_(std::move(source)), assembler_(source_.sensor) {}

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
      sequence.returns.push_back(
          {pixel.range_mm * kMillimetre_m, static_cast<float>(value), pixel.reflectivity});
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
