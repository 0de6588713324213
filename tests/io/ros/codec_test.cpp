// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/codec.hpp>

#include <glidar/core/error.hpp>

#include <io/ros/sample_messages.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

namespace glidar::ros {
namespace {

using ::testing::HasSubstr;

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[std::to_integer<unsigned>(byte) >> 4U];
    text += kDigits[std::to_integer<unsigned>(byte) & 15U];
  }
  return text;
}

TEST(CdrCodec, AlignsEachNumberBehindTheEncapsulationHeader) {
  const Header header{9, {1, 2}, "ab"};
  EXPECT_EQ(hex(serialize(header)),
            "00010000"  // CDR, little-endian
            "01000000"  // sec
            "02000000"  // nanosec
            "03000000"  // size of the text with its zero byte
            "616200");
  const PointField field{"x", 4, PointField::float32, 1};
  EXPECT_EQ(hex(serialize(field)),
            "00010000"
            "02000000"
            "7800"
            "0000"  // padding to 4
            "04000000"
            "07"
            "000000"  // padding to 4
            "01000000");
  const PoseStamped pose{{0, {1, 2}, ""}, {{1.0, 0.0, 0.0}, {}}};
  // 12 bytes of stamp and size, a zero byte, padding to 16, then doubles
  EXPECT_EQ(hex(serialize(pose)).substr(8, 48),
            "0100000002000000"
            "0100000000000000"
            "000000000000f03f");
}

TEST(Ros1Codec, ReadsPackedMembersAndTheSequenceNumber) {
  const auto bytes = [](std::initializer_list<unsigned> numbers) {
    std::vector<std::byte> all;
    for (const unsigned number : numbers) all.push_back(static_cast<std::byte>(number));
    return all;
  };
  const auto header = deserialize<Header>(
      bytes({9, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 'a', 'b'}), Wire::ros1);
  EXPECT_EQ(header.seq, 9U);
  EXPECT_EQ(header.stamp, (Time{1, 2}));
  EXPECT_EQ(header.frame_id, "ab");
  std::vector<std::byte> packed = bytes({1, 0, 0, 0, 'x', 4, 0, 0, 0, 7, 1, 0, 0, 0});
  const auto field = deserialize<PointField>(packed, Wire::ros1);
  EXPECT_EQ(field.offset, 4U);
  EXPECT_EQ(field.datatype, PointField::float32);
  EXPECT_EQ(field.count, 1U);
  for (std::size_t size = 0; size < packed.size(); ++size) {
    const auto cut = std::span<const std::byte>(packed).first(size);
    EXPECT_THROW(deserialize<PointField>(cut, Wire::ros1), Error) << size;
  }
  packed.emplace_back();
  EXPECT_THAT(error_text([&] { deserialize<PointField>(packed, Wire::ros1); }),
              HasSubstr("bytes behind the last member"));
  // MarkerArray of ROS 1 lacks the members that ROS 2 added: 4 + 144 bytes in all
  std::vector<std::byte> markers(4 + 4 + 8 + 4 + 4 + 12 + 56 + 24 + 16 + 8 + 1 + 8 + 8 + 1);
  markers[0] = std::byte{1};
  EXPECT_EQ(deserialize<MarkerArray>(markers, Wire::ros1).markers.size(), 1U);
}

TEST(RosCodec, EveryMessageReadsBackTheSame) {
  for_all_messages(3, [&](const auto& message) {
    using Message = std::decay_t<decltype(message)>;
    const std::vector<std::byte> bytes = serialize(message);
    EXPECT_EQ(serialize(deserialize<Message>(bytes)), bytes) << message_type<Message>().name;
  });
}

TEST(RosCodec, TruncatedAndLongerMessagesAreErrors) {
  for_all_messages(3, [&](const auto& message) {
    using Message = std::decay_t<decltype(message)>;
    std::vector<std::byte> bytes = serialize(message);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const auto cut = std::span<const std::byte>(bytes).first(size);
      EXPECT_THROW(deserialize<Message>(cut), Error) << size;
    }
    bytes.resize(bytes.size() + 4);
    EXPECT_THAT(error_text([&] { deserialize<Message>(bytes); }),
                HasSubstr("bytes behind the last member"));
  });
}

TEST(RosCodec, SizesBeyondTheMessageAreRefusedWithoutMemory) {
  std::vector<std::byte> bytes = serialize(sample<LaserScan>(0));
  // the size of `ranges`, behind the encapsulation, the header of 12 + 12 bytes and seven floats
  const std::size_t at = 4 + 12 + 12 + 28;
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::byte{0xFF};
  EXPECT_THAT(error_text([&] { deserialize<LaserScan>(bytes); }),
              HasSubstr("an array of 4294967295 elements"));
}

TEST(CdrCodec, OtherEncapsulationsAreRefused) {
  std::vector<std::byte> bytes = serialize(sample<Clock>(0));
  bytes[1] = std::byte{0};  // big-endian
  EXPECT_THAT(error_text([&] { deserialize<Clock>(bytes); }),
              HasSubstr("message rosgraph_msgs/msg/Clock, byte 0: an encapsulation header other"));
}

TEST(CdrCodec, TextsNeedTheirZeroByte) {
  std::vector<std::byte> bytes = serialize(sample<Header>(0));
  bytes.back() = std::byte{'x'};
  EXPECT_THAT(error_text([&] { deserialize<Header>(bytes); }),
              HasSubstr("a text without a zero byte"));
}

TEST(RosCodec, PayloadsAreWrittenStraightIntoTheMessage) {
  PointCloud2 cloud = sample<PointCloud2>(1);
  const std::vector<std::byte> expected = serialize(cloud);
  int calls = 0;
  cloud.data = Payload(42, [&calls](std::span<std::byte> to) {
    ++calls;
    ASSERT_EQ(to.size(), 42U);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::byte>(i * 7);
  });
  EXPECT_EQ(serialize(cloud), expected);
  EXPECT_EQ(calls, 1);
}

TEST(RosCodec, NothingIsLeftOfAnEarlierMessageInItsMemory) {
  for_all_messages(3, [&]<class Message>(const Message& message) {
    std::vector<std::byte> bytes(10'000, std::byte{0xAA});
    serialize_to(message, bytes);
    EXPECT_EQ(bytes, serialize(message)) << message_type<Message>().name;
  });
}

TEST(RosTime, StampsAreFlooredAndLimitedToTheRangeOfRos) {
  EXPECT_EQ(time_from_ns(1'700'000'000'123'456'789), (Time{1'700'000'000, 123'456'789}));
  EXPECT_EQ(time_from_ns(-1), (Time{-1, 999'999'999}));
  EXPECT_EQ(to_ns(time_from_ns(-1)), -1);
  EXPECT_THAT(error_text([] { time_from_ns(std::int64_t{1} << 62U); }),
              HasSubstr("the years 1901 to 2038"));
}

TEST(MessageTypes, AreFoundByTheirNamesInBothVersions) {
  for (const MessageType& type : message_types()) {
    EXPECT_EQ(find_message_type(type.name), &type);
    EXPECT_EQ(find_message_type(type.ros1_name), &type);
  }
  EXPECT_EQ(find_message_type("livox_ros_driver/CustomMsg"), &message_type<CustomMsg>());
  EXPECT_EQ(find_message_type("std_msgs/msg/Int8"), nullptr);
  EXPECT_EQ(dds_type_name(message_type<PointCloud2>()), "sensor_msgs::msg::dds_::PointCloud2_");
}

TEST(MessageTypes, DefinitionsContainThoseOfTheirParts) {
  const std::string text = definition_text(message_type<Clock>());
  EXPECT_EQ(text, "builtin_interfaces/Time clock\n" + std::string(80, '=') +
                      "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

}  // namespace
}  // namespace glidar::ros
