// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/packet_frames.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/packets/ouster.hpp>
#include <glidar/io/packets/pcap_file.hpp>
#include <glidar/io/packets/velodyne.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace glidar {
namespace {

/// Checks that the file can be opened: the sandboxed process cannot look for one of a similar name.
const std::filesystem::path& checked_capture(const std::filesystem::path& capture) {
  open_capture_file(capture);
  return capture;
}

}  // namespace

void send_packets(const std::filesystem::path& capture, RecordWriter& to) {
  PcapReader reader(capture);
  for (UdpPacket packet; reader.next(packet);) {
    const std::uint32_t ports = std::uint32_t{packet.source_port} << 16U | packet.port;
    to.write({RecordKind::item, ports, packet.stamp_ns, packet.payload});
  }
  to.write({RecordKind::end, 0, 0, {}});
  to.flush();
}

CapturedPackets::CapturedPackets(const std::filesystem::path& capture)
    : CapturedPackets(start_decoder(kCaptureDecoder, checked_capture(capture))) {}

bool CapturedPackets::next(UdpPacket& packet) {
  if (has_ended_) return false;
  const Record record = run_.records.next();
  has_ended_ = record.kind == RecordKind::end;
  if (has_ended_) return false;
  if (record.kind != RecordKind::item || record.payload.size() > kMaxUdpPayload)
    run_.records.reject("no datagram");
  constexpr std::uint64_t kMinHead_bytes = 16;  // of a datagram in a file
  if (!budget_.try_take(Budget::decompressed_bytes, kMinHead_bytes + record.payload.size()))
    run_.records.reject("more datagrams than the capture has bytes");
  packet.stamp_ns = record.stamp_ns;
  packet.source_port = static_cast<std::uint16_t>(record.index >> 16U);
  packet.port = static_cast<std::uint16_t>(record.index);
  packet.payload.assign(record.payload.begin(), record.payload.end());
  return true;
}

namespace {

class CaptureSource final : public PacketSource {
 public:
  explicit CaptureSource(const std::filesystem::path& path) : reader_(path) {}
  bool next(UdpPacket& packet) override { return reader_.next(packet); }

 private:
  CapturedPackets reader_;
};

/// The packets of velodyne_msgs/VelodyneScan.
class ScanSource final : public PacketSource {
 public:
  ScanSource(std::unique_ptr<bags::BagReader> bag, const std::filesystem::path& path,
             const std::string& topic)
      : bag_(std::move(bag)) {
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

/// The packets of ouster_sensor_msgs/PacketMsg.
class OusterMessageSource final : public PacketSource {
 public:
  OusterMessageSource(std::unique_ptr<bags::BagReader> bag, const std::filesystem::path& path,
                      const std::string& topic)
      : bag_(std::move(bag)) {
    const std::array types = {&ros::message_type<ros::PacketMsg>()};
    const std::size_t found =
        bags::find_topic(*bag_, topic.empty() ? lidar_topic() : topic, types, path);
    wire_ = bag_->topics()[found].wire;
    bag_->select({&found, 1});
  }

  bool next(UdpPacket& packet) override {
    bags::BagMessage message;
    if (!bag_->next(message)) return false;
    const auto stored = ros::deserialize<ros::PacketMsg>(message.data, wire_);
    const auto bytes = std::as_bytes(std::span(stored.buf));
    packet = {message.time_ns, kOusterLidarPort, kOusterLidarPort, {bytes.begin(), bytes.end()}};
    return true;
  }

 private:
  /// Samples of the IMU have the same type.
  [[nodiscard]] std::string lidar_topic() const {
    for (const bags::StoredTopic& topic : bag_->topics()) {
      if (topic.name.bytes().ends_with("lidar_packets")) return topic.name.bytes();
    }
    return {};
  }

  std::unique_ptr<bags::BagReader> bag_;
  ros::Wire wire_ = ros::Wire::cdr;
};

/// Whether the bag, or this topic of it, has the messages of Ouster's driver.
bool has_ouster_messages(const bags::BagReader& bag, const std::string& topic) {
  return std::any_of(bag.topics().begin(), bag.topics().end(),
                     [&](const bags::StoredTopic& stored) {
                       return (topic.empty() || stored.name == topic) &&
                              bags::type_of(stored) == &ros::message_type<ros::PacketMsg>();
                     });
}

/// Encoders fill the last packet with firings without returns, which may begin a revolution.
bool is_padding(const DecodedFrame& decoded) {
  const auto is_hit = [](Status status) { return status == Status::hit; };
  return std::none_of(decoded.frame.status.begin(), decoded.frame.status.end(), is_hit);
}

}  // namespace

std::unique_ptr<PacketSource> open_packets(const std::filesystem::path& path) {
  return std::make_unique<CaptureSource>(path);
}

std::unique_ptr<PacketSource> packets_of(std::unique_ptr<bags::BagReader> bag,
                                         const std::filesystem::path& path,
                                         const std::string& topic) {
  if (has_ouster_messages(*bag, topic))
    return std::make_unique<OusterMessageSource>(std::move(bag), path, topic);
  return std::make_unique<ScanSource>(std::move(bag), path, topic);
}

std::string ouster_metadata_of(const std::filesystem::path& path) {
  return bags::is_bag_path(path) ? ouster_metadata_of(*bags::open_bag(path)) : std::string();
}

std::string ouster_metadata_of(bags::BagReader& bag) {
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const bags::StoredTopic topic = bag.topics()[i];
    if (bags::type_of(topic) != &ros::message_type<ros::String>() ||
        !topic.name.bytes().ends_with("metadata"))
      continue;
    bag.select({&i, 1});
    bags::BagMessage message;
    if (!bag.next(message)) return {};
    return ros::deserialize<ros::String>(message.data, topic.wire).data;
  }
  return {};
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

}  // namespace glidar
