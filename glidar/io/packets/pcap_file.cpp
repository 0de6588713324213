// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/pcap_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/packets/packet_bytes.hpp>

#include <string>
#include <utility>

namespace glidar {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::size_t kMaxRecordBytes = 262'144;

}  // namespace

PcapWriter::PcapWriter(const std::filesystem::path& path, const UdpRoute& route)
    : file_(path), route_(route) {
  Bytes head;
  put_little(head, 0xA1B2C3D4, 4);
  put_little(head, 2, 2);
  put_little(head, 4, 2);
  put_zeros(head, 8);
  put_little(head, kMaxRecordBytes, 4);
  put_little(head, static_cast<std::uint64_t>(LinkType::ethernet), 4);
  file_.write(head);
}

void PcapWriter::write(const UdpPacket& packet) {
  const std::int64_t seconds = packet.stamp_ns / kSecond;
  if (packet.stamp_ns < 0 || seconds > std::int64_t{UINT32_MAX}) {
    throw Error({file_.path().string(), "a packet at " + std::to_string(packet.stamp_ns) + " ns",
                 "times from 1970 to 2106", "let the simulation start at 0 or later"});
  }
  for (const Bytes& frame : ethernet_frames(packet, route_, id_)) {
    Bytes head;
    put_little(head, static_cast<std::uint64_t>(seconds), 4);
    put_little(head, static_cast<std::uint64_t>(packet.stamp_ns % kSecond / 1000), 4);
    put_little(head, frame.size(), 4);
    put_little(head, frame.size(), 4);
    file_.write(head);
    file_.write(frame);
  }
  ++id_;
}

bool PcapReader::next(UdpPacket& packet) {
  CaptureRecord record;
  while (records_.next(record)) {
    if (std::optional<UdpPacket> found = datagrams_.add(record)) {
      packet = std::move(*found);
      return true;
    }
  }
  return false;
}

}  // namespace glidar
