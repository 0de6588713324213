// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/packets/packet_records.hpp>

#include <glidar/io/packets/pcap_file.hpp>

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

}  // namespace glidar
