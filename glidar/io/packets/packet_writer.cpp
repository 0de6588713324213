// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/packet_writer.hpp>

#include <glidar/io/packets/ouster_codec.hpp>

#include <utility>

namespace glidar {
bool is_capture_name(const std::filesystem::path& path) {
  return path.extension() == ".pcap";
}

PacketWriter::PacketWriter(const std::filesystem::path& path, const Sensor& sensor,
                           const PacketOptions& options, PacketImuSampler imu_samples)
    : packets_(sensor, options, std::move(imu_samples)),
      pcap_(path),
      path_(path),
      metadata_(is_ouster(sensor) ? ouster_metadata(sensor, options.ouster) : "") {}

void PacketWriter::write(const Frame& frame, const Beams& beams) {
  packets_.encode(frame, beams, made_);
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
  packets_.finish(made_);
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
