// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/packet_frames.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_topics.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/velodyne_packet.hpp>

#include <algorithm>
#include <array>

namespace glidar::app {
namespace {

class CaptureSource final : public PacketSource {
 public:
  explicit CaptureSource(const std::filesystem::path& path) : reader_(path) {}
  bool next(UdpPacket& packet) override { return reader_.next(packet); }

 private:
  PcapReader reader_;
};

/// The packets of velodyne_msgs/VelodyneScan.
class ScanSource final : public PacketSource {
 public:
  ScanSource(const std::filesystem::path& path, const std::string& topic)
      : bag_(bags::open_bag(path)) {
    const std::array types = {&ros::message_type<ros::VelodyneScan>()};
    const std::size_t found = bags::find_topic(*bag_, topic, types, path);
    wire_ = bag_->topics()[found].wire;
    bag_->select({&found, 1});
  }

  bool next(UdpPacket& packet) override {
    while (next_ == scan_.packets.size()) {
      bags::BagMessage message;
      if (!bag_->next(message)) return false;
      scan_ = ros::deserialize<ros::VelodyneScan>(message.data, wire_);
      next_ = 0;
    }
    const ros::VelodynePacket& stored = scan_.packets[next_++];
    const auto bytes = std::as_bytes(std::span(stored.data));
    packet = {ros::to_ns(stored.stamp), kVelodynePort, kVelodynePort, {bytes.begin(), bytes.end()}};
    return true;
  }

 private:
  std::unique_ptr<bags::BagReader> bag_;
  ros::Wire wire_ = ros::Wire::cdr;
  ros::VelodyneScan scan_;
  std::size_t next_ = 0;  ///< packet of the scan
};

/// Encoders fill the last packet with firings without returns, which may begin a revolution.
bool is_padding(const DecodedFrame& decoded) {
  const auto is_hit = [](Status status) { return status == Status::hit; };
  return std::none_of(decoded.frame.status.begin(), decoded.frame.status.end(), is_hit);
}

}  // namespace

std::unique_ptr<PacketSource> open_packets(const std::filesystem::path& path,
                                           const std::string& topic) {
  if (bags::is_bag_path(path)) return std::make_unique<ScanSource>(path, topic);
  return std::make_unique<CaptureSource>(path);
}

bool PacketFrames::next(DecodedFrame& frame) {
  while (next_ == decoded_.size()) {
    if (is_over_) return false;
    read();
  }
  frame = std::move(decoded_[next_++]);
  return true;
}

/// Reads packets until they complete a frame.
void PacketFrames::read() {
  decoded_.clear();
  next_ = 0;
  UdpPacket packet;
  while (decoded_.empty()) {
    if (!packets_->next(packet)) {
      is_over_ = true;
      decoder_->finish(decoded_);
      std::erase_if(decoded_, is_padding);
      return;
    }
    try {
      decoder_->decode(packet, decoded_);
    } catch (const Error& error) {
      if (malformed_++ == 0) first_error_ = error.what();
    }
  }
}

}  // namespace glidar::app
