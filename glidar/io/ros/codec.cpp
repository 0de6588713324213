// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/codec.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/ros/message_types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

namespace glidar::ros {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are copied in memory order");

/// CDR_LE: OMG DDSI-RTPS 2.5, 10.5, representation identifier {0, 1}, options {0, 0}.
constexpr std::array<std::byte, 4> kCdrLittleEndian = {std::byte{0}, std::byte{1}, std::byte{0},
                                                       std::byte{0}};
constexpr std::size_t kMaxMessage = std::numeric_limits<std::uint32_t>::max();

std::size_t first_byte(Wire wire) {
  return wire == Wire::cdr ? kCdrLittleEndian.size() : 0;
}

/// Bytes before the next number of this size.
std::size_t padding(Wire wire, std::size_t position, std::size_t size) {
  return wire == Wire::cdr ? (size - (position - first_byte(wire)) % size) % size : 0;
}

/// Writes members of a serialized message over the bytes of an earlier one, which are not set to
/// zero before.
class MemberWriter {
 public:
  explicit MemberWriter(std::vector<std::byte>& to) : to_(to) {
    std::copy(kCdrLittleEndian.begin(), kCdrLittleEndian.end(), grow(kCdrLittleEndian.size(), 1));
  }

  /// Removes what is left of the earlier message.
  void finish() { to_.resize(size_); }

  template <class... Members>
  void operator()(Members&&... members) {
    (write(members), ...);
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void write(const Number& number) {
    std::memcpy(grow(sizeof number, sizeof number), &number, sizeof number);
  }

  void write(const std::string& text) {
    const std::size_t size = text.size() + 1;  // with a zero byte
    write_size(size);
    std::memcpy(grow(size, 1), text.c_str(), size);
  }

  void write(const FileText& text) { write(text.bytes()); }

  void write(const Payload& payload) {
    write_size(payload.size());
    std::byte* place = grow(payload.size(), 1);
    payload.write_to({place, payload.size()});
  }

  template <class Element>
  void write(const std::vector<Element>& elements) {
    write_size(elements.size());
    write_elements(std::span<const Element>(elements));
  }

  template <class Element, std::size_t kCount>
  void write(const std::array<Element, kCount>& elements) {
    write_elements(std::span<const Element>(elements));
  }

  template <class Member>
  void write(const Ros1Only<Member>& /*member*/) {}

  template <class Member>
  void write(const Ros2Only<Member>& member) { write(member.value); }

  template <class Member>
  requires std::is_class_v<Member>
  void write(const Member& member) { visit_members(member, *this); }

  template <class Element>
  void write_elements(std::span<const Element> elements) {
    if (elements.empty()) return;
    if constexpr (std::is_arithmetic_v<Element>) {
      std::memcpy(grow(elements.size_bytes(), sizeof(Element)), elements.data(),
                  elements.size_bytes());
    } else {
      for (const Element& element : elements) write(element);
    }
  }

  void write_size(std::size_t size) {
    if (size > kMaxMessage - size_) {
      throw Error({"ROS message", fmt::format("{} bytes in one array", size), "less than 4 GiB",
                   "use fewer points"});
    }
    write(static_cast<std::uint32_t>(size));
  }

  /// Space for `size` bytes behind the padding to `alignment`, which is zero.
  std::byte* grow(std::size_t size, std::size_t alignment) {
    const std::size_t at = size_ + (size_ == 0 ? 0 : padding(Wire::cdr, size_, alignment));
    if (at + size > to_.size()) to_.resize(at + size);
    std::fill(to_.data() + size_, to_.data() + at, std::byte{0});
    size_ = at + size;
    return to_.data() + at;
  }

  std::vector<std::byte>& to_;
  std::size_t size_ = 0;  ///< of what was written
};

/// Reads members from a serialized message; trusts no size.
class MemberReader {
 public:
  MemberReader(Wire wire, std::span<const std::byte> bytes, std::string_view type)
      : wire_(wire), bytes_(bytes), type_(type) {
    if (wire_ == Wire::ros1) return;
    const auto head = bytes_.first(std::min(bytes_.size(), kCdrLittleEndian.size()));
    if (head.size() < kCdrLittleEndian.size() || head[0] != kCdrLittleEndian[0] ||
        head[1] != kCdrLittleEndian[1]) {
      reject("an encapsulation header other than 00 01",
             "CDR, little-endian (00 01), as ROS 2 writes it");
    }
    position_ = kCdrLittleEndian.size();
  }

  template <class... Members>
  void operator()(Members&&... members) {
    (read(members), ...);
  }

  /// DDS may pad a message to a multiple of 4.
  void require_end() const {
    const std::size_t left = bytes_.size() - position_;
    if (left <= (wire_ == Wire::cdr ? 3U : 0U)) return;
    reject(fmt::format("{} bytes behind the last member", left), "a message of this type");
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void read(Number& number) {
    const std::byte* from = take(sizeof number, sizeof number);
    if constexpr (std::is_same_v<Number, bool>) {
      number = *from != std::byte{0};
    } else {
      std::memcpy(&number, from, sizeof number);
    }
  }

  void read(std::string& text) {
    const std::size_t size = read_size(1);
    const auto* from = reinterpret_cast<const char*>(take(size, 1));
    text.assign(from, size);
    if (wire_ == Wire::ros1 || size == 0) return;
    if (text.back() != '\0') reject("a text without a zero byte at its end", "a CDR string");
    text.pop_back();
  }

  void read(FileText& text) {
    std::string bytes;
    read(bytes);
    text = std::move(bytes);
  }

  void read(Payload& payload) {
    const std::size_t size = read_size(1);
    const std::byte* from = take(size, 1);
    payload = Payload(std::vector<std::byte>(from, from + size));
  }

  template <class Element>
  void read(std::vector<Element>& elements) {
    const std::size_t count = read_size(std::is_arithmetic_v<Element> ? sizeof(Element) : 1);
    elements.clear();
    if constexpr (std::is_arithmetic_v<Element>) {
      elements.resize(count);
      read_elements(std::span(elements));
    } else {
      // No more memory than for what the bytes contain.
      for (std::size_t i = 0; i < count; ++i) read(elements.emplace_back());
    }
  }

  template <class Element, std::size_t kCount>
  void read(std::array<Element, kCount>& elements) {
    read_elements(std::span<Element>(elements));
  }

  template <class Member>
  void read(Ros1Only<Member>& member) {
    if (wire_ == Wire::ros1) read(member.value);
  }

  template <class Member>
  void read(Ros2Only<Member>& member) {
    if (wire_ == Wire::cdr) read(member.value);
  }

  template <class Member>
  requires std::is_class_v<Member>
  void read(Member& member) { visit_members(member, *this); }

  template <class Number>
  void read_elements(std::span<Number> elements) {
    if (elements.empty()) return;
    std::memcpy(elements.data(), take(elements.size_bytes(), sizeof(Number)),
                elements.size_bytes());
  }

  /// A count of elements that take at least `element_bytes` each.
  std::size_t read_size(std::size_t element_bytes) {
    std::uint32_t size = 0;
    read(size);
    if (size > (bytes_.size() - position_) / element_bytes) {
      reject(fmt::format("an array of {} elements with {} bytes left", size,
                         bytes_.size() - position_),
             "arrays that end within the message");
    }
    return size;
  }

  const std::byte* take(std::size_t size, std::size_t alignment) {
    const std::size_t skipped = padding(wire_, position_, alignment);
    const std::size_t left = bytes_.size() - position_;
    if (skipped > left || size > left - skipped) {
      reject(fmt::format("{} bytes, which end within a member", bytes_.size()), "a whole message");
    }
    position_ += skipped + size;
    return bytes_.data() + position_ - size;
  }

  [[noreturn]] void reject(const std::string& found, const char* allowed) const {
    throw Error({fmt::format("message {}, byte {}", type_, position_), found, allowed,
                 "it is damaged, or of another type"});
  }

  Wire wire_;
  std::span<const std::byte> bytes_;
  std::string_view type_;
  std::size_t position_ = 0;
};

/// Bytes of the large array of a message, so that its memory is allocated once.
template <class Message>
std::size_t payload_size(const Message& message) {
  if constexpr (requires { message.data.size(); }) return message.data.size();
  if constexpr (requires { message.buf.size(); }) return message.buf.size();
  return 0;
}

}  // namespace

template <class Message>
void serialize_to(const Message& message, std::vector<std::byte>& to) {
  constexpr std::size_t kOthers = 1024;
  to.reserve(payload_size(message) + kOthers);
  MemberWriter writer(to);
  visit_members(message, writer);
  writer.finish();
}

template <class Message>
std::vector<std::byte> serialize(const Message& message) {
  std::vector<std::byte> bytes;
  serialize_to(message, bytes);
  return bytes;
}

template <class Message>
Message deserialize(std::span<const std::byte> bytes, Wire wire) {
  Message message;
  MemberReader reader(wire, bytes, message_type<Message>().name);
  visit_members(message, reader);
  reader.require_end();
  return message;
}

#define GLIDAR_ROS_CODEC(Message)                                      \
  template void serialize_to(const Message&, std::vector<std::byte>&); \
  template std::vector<std::byte> serialize(const Message&);           \
  template Message deserialize<Message>(std::span<const std::byte>, Wire);

GLIDAR_ROS_CODEC(Header)
GLIDAR_ROS_CODEC(PointField)
GLIDAR_ROS_CODEC(PointCloud2)
GLIDAR_ROS_CODEC(LaserScan)
GLIDAR_ROS_CODEC(Image)
GLIDAR_ROS_CODEC(CompressedImage)
GLIDAR_ROS_CODEC(CameraInfo)
GLIDAR_ROS_CODEC(Imu)
GLIDAR_ROS_CODEC(TFMessage)
GLIDAR_ROS_CODEC(PoseStamped)
GLIDAR_ROS_CODEC(Clock)
GLIDAR_ROS_CODEC(Odometry)
GLIDAR_ROS_CODEC(CustomMsg)
GLIDAR_ROS_CODEC(VelodyneScan)
GLIDAR_ROS_CODEC(PacketMsg)
GLIDAR_ROS_CODEC(String)
GLIDAR_ROS_CODEC(MarkerArray)

#undef GLIDAR_ROS_CODEC

}  // namespace glidar::ros
