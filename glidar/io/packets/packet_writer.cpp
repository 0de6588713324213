// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/packet_writer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/hesai_codec.hpp>

namespace glidar {
namespace {

[[noreturn]] void fail_of_maker(const Sensor& sensor) {
  throw Error({"packets of " + sensor.name, "no manufacturer's packets are known for this sensor",
               "the presets of Velodyne, Ouster and Hesai sensors", "write clouds"});
}

}  // namespace

std::unique_ptr<PacketEncoder> make_packet_encoder(const Sensor& sensor,
                                                   const PacketOptions& options) {
  if (is_velodyne(sensor)) return make_velodyne_encoder(sensor, options.position);
  if (is_ouster(sensor)) return make_ouster_encoder(sensor, options.ouster);
  if (is_hesai(sensor)) return make_hesai_encoder(sensor);
  fail_of_maker(sensor);
}

std::unique_ptr<PacketDecoder> make_packet_decoder(const Sensor& sensor,
                                                   const PacketOptions& options) {
  if (is_velodyne(sensor)) return make_velodyne_decoder(sensor);
  if (is_ouster(sensor)) return make_ouster_decoder(sensor, options.ouster);
  if (is_hesai(sensor)) return make_hesai_decoder(sensor);
  fail_of_maker(sensor);
}

bool is_capture_name(const std::filesystem::path& path) {
  return path.extension() == ".pcap";
}

PacketWriter::PacketWriter(const std::filesystem::path& path, const Sensor& sensor,
                           const PacketOptions& options)
    : encoder_(make_packet_encoder(sensor, options)),
      pcap_(path),
      path_(path),
      metadata_(is_ouster(sensor) ? ouster_metadata(sensor, options.ouster) : "") {}

void PacketWriter::write(const Frame& frame, const Beams& beams) {
  encoder_->encode(frame, beams, made_);
  write_packets();
}

void PacketWriter::write_packets() {
  for (const UdpPacket& packet : made_) pcap_.write(packet);
  count_ += made_.size();
  made_.clear();
}

std::vector<std::filesystem::path> PacketWriter::files() const {
  if (metadata_.empty()) return {path_};
  return {path_, std::filesystem::path(path_).replace_extension(".json")};
}

void PacketWriter::finish() {
  encoder_->finish(made_);
  write_packets();
  pcap_.finish();
  if (!metadata_.empty()) {
    AtomicFile json(files().back());
    json.write(metadata_);
    json.finish();
    pcap_.commit();
    json.commit();
    return;
  }
  pcap_.commit();
}

}  // namespace glidar
