// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/commands/commands.hpp>
#include <apps/glidar/options/option_group.hpp>
#include <apps/glidar/options/option_values.hpp>
#include <apps/glidar/options/output_options.hpp>
#include <apps/glidar/options/sensor_options.hpp>
#include <apps/glidar/run/console.hpp>
#include <apps/glidar/run/outputs.hpp>
#include <apps/glidar/run/sensor_setup.hpp>
#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/packets/packet_frames.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace glidar::app {
namespace {

constexpr const char* kDecodeExamples =
    R"(Writes the clouds of a packet capture (.pcap, .pcapng) or of a bag (.mcap, .bag, .rosbag2 or a
folder of rosbag2) with messages PointCloud2, CustomMsg, VelodyneScan or PacketMsg: a file for each
frame.
Examples:
  glidar decode scan.pcap --sensor VLP-16 -o cloud.pcd     # cloud_000000.pcd ...
  glidar decode ouster.pcap -o cloud.npz                   # with ouster.json, the sensor's metadata
  glidar decode run.mcap --topic /lidar/points -o cloud.ply)";

struct DecodeFlags {
  std::string input;
  std::string sensor;     ///< that sent the packets
  std::string mode;       ///< of this sensor; empty: its default mode
  SensorOptions options;  ///< its calibration
  std::string metadata;   ///< of an Ouster sensor; empty: FILE.json
  std::string topic;      ///< of a bag; empty: the first that fits
  std::optional<std::uint64_t> frames;
  OutputFlags output;
  bool quiet = false;
};

/// Columns that packets contain.
const std::vector<std::string> kDecodedColumns = {"xyz", "intensity", "range", "ring", "time"};

/// The metadata of an Ouster sensor for this capture; empty: none.
std::filesystem::path metadata_of(const DecodeFlags& flags) {
  if (!flags.metadata.empty()) return flags.metadata;
  if (!flags.sensor.empty()) return {};
  const std::filesystem::path beside =
      std::filesystem::path(flags.input).replace_extension(".json");
  return std::filesystem::exists(beside) ? beside : std::filesystem::path();
}

/// The sensor that sent the packets, and the decoder for them.
struct Sender {
  Sensor sensor;
  std::unique_ptr<PacketDecoder> decoder;
};

Sender sender_of(const DecodeFlags& flags) {
  const std::filesystem::path metadata = metadata_of(flags);
  if (!metadata.empty()) {
    const OusterSource source = load_ouster_source(metadata);
    return {source.sensor, make_ouster_decoder(source)};
  }
  const std::string recorded = flags.sensor.empty() ? ouster_metadata_of(flags.input) : "";
  if (!recorded.empty()) {
    const OusterSource source = parse_ouster_source(recorded, flags.input + ", metadata");
    return {source.sensor, make_ouster_decoder(source)};
  }
  if (flags.sensor.empty()) {
    throw Error(
        {flags.input, "packets, which do not state the sensor that sent them",
         "--sensor with a preset of Velodyne, Ouster, Hesai or Livox, or --metadata of an Ouster",
         "add --sensor VLP-16, for example"});
  }
  Sender sender{load_sensor(flags.sensor, flags.mode), nullptr};
  apply_calibrations(flags.options, sender.sensor);
  if (flags.output.ouster_profile && !is_ouster(sender.sensor)) {
    throw Error({"--ouster-profile", "the packets of " + sender.sensor.name, "an Ouster sensor",
                 "leave it out"});
  }
  PacketOptions options;
  options.ouster.profile = flags.output.ouster_profile;
  with_option_name("--sensor",
                   [&] { sender.decoder = make_packet_decoder(sender.sensor, options); });
  return sender;
}

/// Whether the bag has clouds, not packets.
bool has_clouds(const DecodeFlags& flags, const bags::BagReader& bag) {
  for (const bags::StoredTopic& topic : bag.topics()) {
    if (!flags.topic.empty() && topic.name != flags.topic) continue;
    const ros::MessageType* type = bags::type_of(topic);
    if (type == &ros::message_type<ros::PointCloud2>() ||
        type == &ros::message_type<ros::CustomMsg>())
      return true;
  }
  const auto has_packets = [&](const bags::StoredTopic& topic) {
    const ros::MessageType* type = bags::type_of(topic);
    return type == &ros::message_type<ros::VelodyneScan>() ||
           type == &ros::message_type<ros::PacketMsg>();
  };
  return std::none_of(bag.topics().begin(), bag.topics().end(), has_packets);
}

/// Counts the frames and prints the summary.
class Written {
 public:
  explicit Written(const DecodeFlags& flags) : flags_(flags) {}
  [[nodiscard]] bool is_enough() const { return flags_.frames && count_ >= *flags_.frames; }
  [[nodiscard]] std::uint32_t next() const { return static_cast<std::uint32_t>(count_); }
  void add() { ++count_; }
  void finish() const {
    if (count_ == 0) {
      throw Error(
          {flags_.input, "it has no frame", "a file with packets of the sensor, or clouds"});
    }
    if (flags_.quiet) return;
    print("{} frame{} of {}\nwrote", count_, count_ == 1 ? "" : "s", flags_.input);
    for (const std::string& path : numbered(flags_.output, 0).paths) print(" {}", path);
    print("{}\n", count_ == 1 ? "" : " ...");
  }

 private:
  const DecodeFlags& flags_;
  std::uint64_t count_ = 0;
};

/// `packets` are open before the sensor is sought, so that a missing file is reported as such.
void decode_packets(const DecodeFlags& flags, std::unique_ptr<PacketSource> packets,
                    Console& console, Written& written) {
  Sender sender = sender_of(flags);
  for (const std::string& note : sender.sensor.notes) console.info(note);
  PacketFrames frames(std::move(packets), std::move(sender.decoder));
  if (flags.output.frame == "world" || flags.output.deskew) {
    throw Error({"--frame world and --deskew", "given for packets", "the axes of the sensor",
                 "leave them out: packets have no poses"});
  }
  sender.sensor.doppler.reset();  // packets have no velocities
  check_columns(sender.sensor, flags.output.columns);
  const Scene nothing;
  FrameFileRequest request = static_cast<const FrameFileRequest&>(flags.output);
  if (request.frame.empty()) request.frame = "sensor";
  request.input = flags.input;
  DecodedFrame decoded;
  OutputRig rig{.scene = nothing, .sensors = {}};
  rig.sensors.push_back({.sensor = sender.sensor, .beams = decoded.beams});
  FrameFiles files(std::move(request), true, rig, Report{console.report().log, {}});
  while (!written.is_enough() && frames.next(decoded)) {
    files.write({.frame = decoded.frame, .beams = decoded.beams, .index = written.next()});
    written.add();
  }
  if (frames.malformed() == 0) return;
  if (written.next() == 0)
    throw Error({flags.input, "no packet is valid: " + frames.first_error()});
  console.warn(fmt::format("{} packets are not valid; the first one: {}", frames.malformed(),
                           frames.first_error()));
}

/// Options that need what only a measurement has.
void check_cloud_options(const DecodeFlags& flags) {
  const OutputFlags& output = flags.output;
  if (!output.columns.empty() || !output.sink.layout.empty() || !output.frame.empty() ||
      output.deskew) {
    throw Error({"--columns, --layout, --frame and --deskew", "given for clouds of a bag",
                 "the columns and axes of the messages", "leave them out"});
  }
  for (const std::string& path : output.paths) {
    if (format_of(output, path).takes_more) continue;
    throw Error({"--output, " + path, "a format without the columns of a message",
                 suffixes_with_columns(), "choose one of these"});
  }
}

/// Formats expect intensities as float32.
void convert_intensity(PointCloud& cloud) {
  for (Column& column : cloud.columns) {
    if (column.name != "intensity") continue;
    column.values = std::visit(
        [](const auto& values) { return std::vector<float>(values.begin(), values.end()); },
        column.values);
  }
}

void decode_clouds(const DecodeFlags& flags, std::unique_ptr<bags::BagReader> bag, Console& console,
                   Written& written) {
  check_cloud_options(flags);
  bags::BagClouds clouds(std::move(bag), flags.input, flags.topic);
  const Scene nothing;
  const Sensor unknown;
  const Beams beams;
  const SidecarContext context{.scene = nothing, .sensor = unknown, .beams = beams, .renderer = ""};
  bags::BagCloud found;
  Frame frame;
  while (!written.is_enough() && clouds.next(found)) {
    frame.stamp_ns = found.stamp_ns;
    convert_intensity(found.cloud);
    for (const std::string& path : numbered(flags.output, written.next()).paths) {
      make_file_sink(path, flags.output.sink, context, console.report())->write(found.cloud, frame);
    }
    written.add();
  }
}

void check_recordings(const DecodeFlags& flags) {
  if (flags.output.recording_paths.empty()) return;
  throw Error({"--output, " + flags.output.recording_paths.front(), "a recording of all sensors",
               "files of clouds: " + suffixes_with_columns(), "choose one of these"});
}

int run_decode(DecodeFlags flags) {
  Console console(flags.quiet);
  flags.output.sink.sidecar = false;  // there is no measurement to describe
  flags.output.per_frame = true;      // and no motion that joins the frames
  std::unique_ptr<bags::BagReader> bag;
  if (bags::is_bag_path(flags.input)) bag = bags::open_bag(flags.input);
  const bool are_clouds = bag != nullptr && has_clouds(flags, *bag);
  if (!are_clouds && flags.output.columns.empty()) flags.output.columns = kDecodedColumns;
  check_recordings(flags);
  if (flags.output.paths.empty()) {
    throw Error({"--output", "there is no -o, so nothing would be written",
                 "files of clouds: " + suffixes_with_columns(), "add -o cloud.pcd, for example"});
  }
  check_layout(flags.output);
  Written written(flags);
  if (are_clouds) {
    decode_clouds(flags, std::move(bag), console, written);
  } else {
    auto packets = bag != nullptr ? packets_of(std::move(bag), flags.input, flags.topic)
                                  : open_packets(flags.input);
    decode_packets(flags, std::move(packets), console, written);
  }
  written.finish();
  return kDone;
}

}  // namespace

Command add_decode(CLI::App& program) {
  CLI::App& command =
      *program.add_subcommand("decode", "Write the clouds of packet captures and bags");
  const auto flags = std::make_shared<DecodeFlags>();
  command.footer(kDecodeExamples);
  command.add_option("FILE", flags->input, "Packet capture or bag")->required()->type_name("");
  const OptionGroup input(command, "Input");
  input.add("--sensor", "NAME|FILE", "Preset or file of the sensor that sent the packets",
            flags->sensor);
  input.add("--mode", "NAME", "Mode of the sensor, for example 2048x10 [its default mode]",
            flags->mode);
  add_calibration_option(input, flags->options.calibration_files);
  input.add("--metadata", "FILE", "Metadata of an Ouster sensor [FILE.json, or of the bag]",
            flags->metadata);
  input.add("--topic", "NAME", "Topic of a bag [the first one with clouds or packets]",
            flags->topic);
  input.add("--frames", "N", "End after N frames [all]", flags->frames,
            whole<std::uint64_t>(1, std::numeric_limits<std::uint32_t>::max()));
  forbid_together(command, {"--sensor"}, {"--metadata"});
  require_option(command, {"--mode", "--calibration"}, "--sensor");
  add_output_options(command, flags->output);
  hide_standard_output(command);
  command.remove_option(command.get_option("--no-sidecar"));
  command.remove_option(command.get_option("--livox-data-type"));
  remove_message_options(command);
  OptionGroup(command, "Run").add_flag("-q,--quiet", "No summary, only warnings", flags->quiet);
  return [flags] { return run_decode(*flags); };
}

}  // namespace glidar::app
