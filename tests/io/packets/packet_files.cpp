// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Packets for readers in Python (packet_consumers_test.py):
//   packet_files write FOLDER: packets of every model, with the returns that they contain
//   packet_files decode PCAP PRESET|METADATA OUT [dual] [still]: the returns of a capture file;
//   still: no rotation between a block's azimuth and a firing

#include "packet_fixture.hpp"

#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai.hpp>
#include <glidar/io/packets/sensor_packets.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

namespace glidar::testing {
namespace {

/// x y z stamp ring range of every return as doubles; the stamp counts from kPacketEpoch_ns.
void write_returns(const std::filesystem::path& path, const std::vector<FlatReturn>& flat) {
  std::ofstream file(path, std::ios::binary);
  for (const FlatReturn& one : flat) {
    const double row[6] = {one.xyz_m.x(),
                           one.xyz_m.y(),
                           one.xyz_m.z(),
                           static_cast<double>(one.stamp_ns - kPacketEpoch_ns),
                           static_cast<double>(one.ring),
                           one.range_m};
    file.write(reinterpret_cast<const char*>(row), sizeof row);
  }
}

void write_stream(const std::filesystem::path& base, const Sensor& sensor,
                  const PacketOptions& options, std::uint32_t frames = 3) {
  PacketWriter writer(base.string() + ".pcap", sensor, options);
  std::vector<FlatReturn> flat;
  for (std::uint32_t number = 0; number < frames; ++number) {
    const DecodedFrame made = room_frame(sensor, number);
    writer.write(made.frame, made.beams);
    flatten(made, flat);
  }
  writer.finish();
  sort_returns(flat);
  write_returns(base.string() + ".returns", flat);
}

/// The sensor as velodyne-decoder 3.1.0 places its beams: the HDL-64E's vert_offset is a height,
/// while ros-drivers turn it with the beam: -vert_offset sin(elevation) outwards, times cos up.
Sensor consumer_sensor(const std::string& model, bool is_dual) {
  Sensor sensor = packet_sensor(model, is_dual);
  for (SpinningChannel& channel : std::get<Spinning>(sensor.optics).channels)
    channel.origin_m = {0.0, channel.origin_m.y(),
                        channel.origin_m.z() / std::cos(channel.elevation_rad)};
  return sensor;
}

void write_all(const std::filesystem::path& folder) {
  const PacketOptions fixed{.position = GeoPosition{37.3875, -121.9723}, .ouster = {}};
  for (const char* model :
       {"VLP-16", "Puck-Hi-Res", "VLP-32C", "HDL-32E", "HDL-64E-S3", "VLS-128"}) {
    write_stream(folder / model, consumer_sensor(model, false), fixed);
    write_stream(folder / (std::string(model) + "-dual"), consumer_sensor(model, true), fixed);
  }
  // its status bytes state the calibration within 1.2 s
  write_stream(folder / "HDL-64E-S3-calibration", packet_sensor("HDL-64E-S3", false), fixed, 13);
  for (const std::string_view& profile : ouster_profile_names()) {
    PacketOptions options;
    options.ouster.profile = static_cast<OusterProfile>(&profile - ouster_profile_names().data());
    const bool is_dual = ouster_returns(*options.ouster.profile) == 2;
    write_stream(folder / ("OS1-128-" + std::string(profile)), packet_sensor("OS1-128", is_dual),
                 options);
  }
}

std::unique_ptr<PacketDecoder> decoder_for(const std::string& source,
                                           const std::set<std::string>& options) {
  if (source.ends_with(".json")) return make_ouster_decoder(load_ouster_source(source));
  const Sensor sensor = packet_sensor(source, options.count("dual") > 0);
  if (options.count("still") > 0) return make_hesai_decoder(sensor, false);
  return make_packet_decoder(sensor);
}

void decode_capture(const std::filesystem::path& capture, PacketDecoder& decoder,
                    const std::filesystem::path& target) {
  PcapReader reader(capture);
  std::vector<DecodedFrame> frames;
  for (UdpPacket packet; reader.next(packet);) decoder.decode(packet, frames);
  decoder.finish(frames);
  std::vector<FlatReturn> flat;
  for (const DecodedFrame& frame : frames) flatten(frame, flat);
  write_returns(target, flat);
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 2 && arguments[0] == "write") {
    write_all(arguments[1]);
    return 0;
  }
  if (arguments.size() < 4 || arguments[0] != "decode") return 2;
  const auto decoder = decoder_for(arguments[2], {arguments.begin() + 4, arguments.end()});
  decode_capture(arguments[1], *decoder, arguments[3]);
  return 0;
}

}  // namespace
}  // namespace glidar::testing

int main(int argc, char** argv) {
  try {
    return glidar::testing::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
