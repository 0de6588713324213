// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/ros/cloud_message.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/formats/cloud_layout.hpp>
#include <glidar/io/ros/codec.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>

namespace glidar::ros {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// 4 rows of 5 beams; the columns fire from right to left, the first 100 ns after the frame's
/// start.
CloudFixture scan_fixture() {
  CloudFixture made = make_fixture();
  fixture::add_scan_columns(made.cloud);
  made.frame.stamp_ns = 1'000'000'000;
  made.frame.range_m.assign(made.cloud.size(), 5.0);
  for (std::size_t i = 0; i < made.cloud.size(); ++i)
    if (is_miss(i)) made.frame.range_m[i] = kNaN;
  made.beams.rows = made.rows;
  made.beams.cols = made.cols;
  const std::size_t count = made.cloud.size();
  made.beams.directions.assign(count, Eigen::Vector3d::UnitX());
  std::vector<std::uint32_t> times(count);
  for (std::size_t i = 0; i < count; ++i)
    times[i] = 100 + 1000 * (made.cols - 1 - static_cast<std::uint32_t>(i % made.cols));
  made.beams.times_ns = times;
  for (Column& column : made.cloud.columns) {
    if (column.name == "time") column.values = times;
  }
  return made;
}

CloudSource source_of(const CloudFixture& made) {
  return {made.frame, made.sensor, made.beams};
}

template <class T>
std::vector<T> values(const PointCloud& cloud, const char* name) {
  return std::get<std::vector<T>>(find_column(cloud, name)->values);
}

PointCloud sent(const PointCloud2& message) {
  return to_point_cloud(deserialize<PointCloud2>(serialize(message)));
}

TEST(CloudMessage, IsDenseAndInFiringOrderWithTheStampOfTheFirstFiring) {
  const CloudFixture made = scan_fixture();
  const PointCloud2 message = to_point_cloud2(made.cloud, source_of(made), {.layout = "ouster"});
  EXPECT_EQ(to_ns(message.header.stamp), 1'000'000'100);
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_TRUE(message.is_dense);
  EXPECT_EQ(message.height, 1U);
  EXPECT_EQ(message.width, 14U);  // every third of 20 misses
  const PointCloud cloud = sent(message);
  const auto times = values<std::uint32_t>(cloud, "t");
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(times.front(), 0U);
  EXPECT_EQ(times.back(), 4000U);
  // Hits of the last column: beams 4, 9 and 19, in the order of their rows
  const auto rings = values<std::uint16_t>(cloud, "ring");
  EXPECT_THAT(std::vector(rings.begin(), rings.begin() + 3), ElementsAre(4000, 9000, 19000));
}

TEST(CloudMessage, KeepsRowsAndColumnsOnRequest) {
  const CloudFixture made = scan_fixture();
  const PointCloud2 message = to_point_cloud2(made.cloud, source_of(made),
                                              {.layout = "velodyne",
                                               .frame_id = "lidar",
                                               .misses = Misses::nan,
                                               .order = PointOrder::rows});
  EXPECT_EQ(message.height, 4U);
  EXPECT_EQ(message.width, 5U);
  EXPECT_FALSE(message.is_dense);
  EXPECT_EQ(message.header.frame_id, "lidar");
  const PointCloud cloud = sent(message);
  EXPECT_TRUE(std::isnan(values<double>(cloud, "xyz")[6]));
  EXPECT_EQ(values<std::uint16_t>(cloud, "ring")[19], 19000);
}

TEST(CloudMessage, IsStampedWithTheFirstPointThatIsWritten) {
  CloudFixture made = scan_fixture();
  auto& xyz = std::get<std::vector<double>>(made.cloud.columns.front().values);
  for (std::size_t i = 0; i < made.cloud.size(); ++i) {
    if (i % made.cols < 3) continue;  // the last columns, which fire first, have no return
    made.frame.range_m[i] = kNaN;
    std::fill_n(xyz.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, kNaN);
  }
  for (const char* layout : {"ouster", "livox"}) {
    const PointCloud2 message = to_point_cloud2(made.cloud, source_of(made), {.layout = layout});
    EXPECT_EQ(to_ns(message.header.stamp), 1'000'002'100) << layout;
  }
  const PointCloud2 relative = to_point_cloud2(made.cloud, source_of(made), {.layout = "ouster"});
  EXPECT_EQ(values<std::uint32_t>(sent(relative), "t").front(), 0U);
  EXPECT_EQ(to_custom_msg(made.cloud, source_of(made)).timebase, 1'000'002'100U);
  EXPECT_EQ(cloud_stamp_ns(source_of(made), {.misses = Misses::zero}), 1'000'000'100);
  EXPECT_EQ(cloud_stamp_ns(source_of(made), {.stamp = StampRule::first_firing}), 1'000'000'100);
}

TEST(CloudMessage, PointsOfAPacketWithoutABeamKeepTheirOwnTime) {
  CloudFixture made = scan_fixture();
  made.beams.directions.assign(made.cloud.size(), Eigen::Vector3d::Constant(kNaN));
  const auto stamps = [&](bool of_packets) {
    return values<std::uint32_t>(
        sent(to_point_cloud2(made.cloud, source_of(made), {.packet_stamps = of_packets})),
        "stamp_nsec");
  };
  EXPECT_EQ(stamps(true), stamps(false));
  made.beams.directions[0] = Eigen::Vector3d::UnitX();
  EXPECT_NE(stamps(true), stamps(false));
}

TEST(CloudMessage, CanHaveTheColumnsOfAScannerAsRows) {
  const CloudFixture made = scan_fixture();
  const PointCloud2 message =
      to_point_cloud2(made.cloud, source_of(made),
                      {.layout = "velodyne", .misses = Misses::nan, .order = PointOrder::columns});
  EXPECT_EQ(message.height, 5U);
  EXPECT_EQ(message.width, 4U);
  EXPECT_FALSE(message.is_dense);
  const auto rings = values<std::uint16_t>(sent(message), "ring");
  EXPECT_THAT(std::vector(rings.begin(), rings.begin() + 5),
              ElementsAre(0, 5000, 10000, 15000, 1000));
}

TEST(CloudMessage, KeepsMissesAsZerosOnRequest) {
  const CloudFixture made = scan_fixture();
  const PointCloud2 message =
      to_point_cloud2(made.cloud, source_of(made), {.layout = "velodyne", .misses = Misses::zero});
  EXPECT_EQ(message.width, 20U);
  EXPECT_TRUE(message.is_dense);
  const auto xyz = values<double>(sent(message), "xyz");
  EXPECT_EQ(std::count(xyz.begin(), xyz.end(), 0.0) >= 18, true);
  EXPECT_TRUE(std::none_of(xyz.begin(), xyz.end(), [](double v) { return std::isnan(v); }));
}

TEST(CloudMessage, CanHavePaddingBetweenItsFields) {
  const CloudFixture made = scan_fixture();
  const CloudMessageOptions padded = {
      .layout = "velodyne", .offsets = {0, 4, 8, 16, 20, 24}, .point_step = 32};
  const PointCloud2 message = to_point_cloud2(made.cloud, source_of(made), padded);
  EXPECT_EQ(message.point_step, 32U);
  EXPECT_EQ(message.row_step, 32U * message.width);
  const PointCloud packed =
      sent(to_point_cloud2(made.cloud, source_of(made), {.layout = "velodyne"}));
  const PointCloud cloud = sent(message);
  for (const char* name : {"xyz", "intensity", "ring", "time"})
    EXPECT_TRUE(find_column(cloud, name)->values == find_column(packed, name)->values) << name;
}

TEST(CloudMessage, OfALayoutWithItsOwnAxesIsTurned) {
  CloudFixture made = scan_fixture();
  made.cloud.frame_id = "lidar_frame";
  made.beams.frame_id = "lidar_frame";
  const auto plain = values<double>(
      sent(to_point_cloud2(made.cloud, source_of(made), {.layout = "velodyne"})), "xyz");
  const auto turned = values<double>(
      sent(to_point_cloud2(made.cloud, source_of(made), {.layout = "hesai"})), "xyz");
  ASSERT_EQ(plain.size(), turned.size());
  for (std::size_t i = 0; i < plain.size(); i += 3) {
    EXPECT_EQ(turned[i], -plain[i + 1]);
    EXPECT_EQ(turned[i + 1], plain[i]);
    EXPECT_EQ(turned[i + 2], plain[i + 2]);
  }
  const PointCloud laid = apply_layout(made.cloud, "hesai", made.sensor, made.beams);
  const Pose turned_back = laid.world_from_cloud * quarter_turned(1);
  EXPECT_TRUE(turned_back.isApprox(made.cloud.world_from_cloud, 1e-12));
}

TEST(CloudMessage, LayoutsHaveTheOffsetsOfTheirDrivers) {
  const CloudFixture made = scan_fixture();
  const auto offsets = [&](const char* layout, std::uint32_t step) {
    const PointCloud2 message = to_point_cloud2(made.cloud, source_of(made), {.layout = layout});
    EXPECT_EQ(message.point_step, step) << layout;
    std::vector<std::uint32_t> found;
    for (const PointField& field : message.fields) found.push_back(field.offset);
    return found;
  };
  EXPECT_THAT(offsets("velodyne", 22), ElementsAre(0, 4, 8, 12, 16, 18));
  EXPECT_THAT(offsets("livox", 26), ElementsAre(0, 4, 8, 12, 16, 17, 18));
  EXPECT_THAT(offsets("autoware", 32), ElementsAre(0, 4, 8, 12, 13, 14, 16, 20, 24, 28));
  EXPECT_THAT(offsets("hesai", 26), ElementsAre(0, 4, 8, 12, 16, 18));
  EXPECT_THAT(offsets("robosense", 26), ElementsAre(0, 4, 8, 12, 16, 18));
  EXPECT_THAT(offsets("ouster-2022", 29), ElementsAre(0, 4, 8, 12, 16, 20, 22, 23, 25));
  EXPECT_THAT(offsets("ouster-fast-lio", 29), ElementsAre(0, 4, 8, 12, 16, 20, 22, 23, 25));
  EXPECT_THAT(offsets("ouster-rgb", 34), ElementsAre(0, 4, 8, 12, 16, 20, 22, 24, 26, 30));
  EXPECT_THAT(offsets("robosense-xyzi", 16), ElementsAre(0, 4, 8, 12));
  EXPECT_THAT(offsets("livox-custom", 19), ElementsAre(0, 4, 8, 12, 16, 17, 18));
}

TEST(CloudMessage, WithoutALayoutHasAllColumns) {
  const CloudFixture made = scan_fixture();
  const PointCloud cloud = sent(to_point_cloud2(made.cloud, source_of(made)));
  EXPECT_EQ(cloud.size(), 14U);
  EXPECT_FLOAT_EQ(static_cast<float>(values<double>(cloud, "depth")[0]), 1.0F + 4.0F / 3.0F);
  EXPECT_EQ(values<std::uint32_t>(cloud, "stamp_sec")[0], 1700000000U);
  EXPECT_EQ(values<std::uint32_t>(cloud, "stamp_nsec")[0], 123456789U + 4 * 55296);
  EXPECT_EQ(values<std::uint32_t>(cloud, "time")[0], 0U);
  EXPECT_NE(find_column(cloud, "rgb"), nullptr);
  EXPECT_NE(find_column(cloud, "normal_x"), nullptr);
}

TEST(CloudMessage, CustomMsgHasTimesFromItsTimebase) {
  const CloudFixture made = scan_fixture();
  const CustomMsg message = to_custom_msg(made.cloud, source_of(made));
  EXPECT_EQ(message.timebase, 1'000'000'100U);
  EXPECT_EQ(message.point_num, 14U);
  ASSERT_EQ(message.points.size(), 14U);
  EXPECT_EQ(message.points.front().offset_time, 0U);
  EXPECT_EQ(message.points.back().offset_time, 4000U);
  EXPECT_EQ(message.points.front().line, 255);  // ring 4000
  const PointCloud cloud = to_point_cloud(message);
  EXPECT_EQ(values<std::uint32_t>(cloud, "offset_time").back(), 4000U);
}

TEST(CloudMessage, CloudsWithoutTimesCannotBeSorted) {
  CloudFixture made = scan_fixture();
  PointCloud dense;
  drop_column(made.cloud, "time");
  remove_invalid_points(made.cloud, dense);
  EXPECT_THAT(error_text([&] { to_point_cloud2(dense, source_of(made)); }),
              HasSubstr("the cloud has no column time"));
}

TEST(FiringOrder, SortsStablyByAllBitsOfTheTime) {
  const std::vector<std::uint32_t> times = {4'000'000'000, 5, 2048, 5, 0, 4'194'304, 2047};
  std::vector<std::uint32_t> points(times.size());
  std::iota(points.begin(), points.end(), 0U);
  sort_by_time(times, points);
  EXPECT_THAT(points, ElementsAre(4, 1, 3, 6, 2, 5, 0));
}

/// Fields of all types at odd offsets, with padding behind points and rows.
PointCloud2 mixed_message(bool is_bigendian) {
  PointCloud2 m;
  m.height = 2;
  m.width = 2;
  m.fields = {{"z", 1, PointField::float64, 1},  {"x", 9, PointField::float32, 1},
              {"y", 13, PointField::float32, 1}, {"a", 17, PointField::int8, 1},
              {"b", 18, PointField::int16, 2},   {"c", 22, PointField::int32, 1}};
  m.point_step = 30;
  m.row_step = 64;
  m.is_bigendian = is_bigendian;
  std::vector<std::byte> data(2 * 64);
  const auto put = [&](std::size_t at, auto value) {
    std::array<std::byte, sizeof value> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (is_bigendian) std::reverse(bytes.begin(), bytes.end());
    std::copy(bytes.begin(), bytes.end(), data.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = i / 2 * 64 + i % 2 * 30;
    put(at + 1, 3.25 + static_cast<double>(i));
    put(at + 9, 1.5F);
    put(at + 13, 2.5F);
    put(at + 17, std::int8_t{-1});
    put(at + 18, std::int16_t{-300});
    put(at + 20, std::int16_t{300});
    put(at + 22, std::int32_t{-70000});
  }
  m.data = Payload(std::move(data));
  return m;
}

TEST(CloudFromMessage, ReadsAllTypesOffsetsStepsAndByteOrders) {
  for (const bool is_bigendian : {false, true}) {
    const PointCloud cloud = to_point_cloud(mixed_message(is_bigendian));
    EXPECT_EQ(cloud.rows, 2U);
    EXPECT_THAT(values<double>(cloud, "xyz"),
                ElementsAre(1.5, 2.5, 3.25, 1.5, 2.5, 4.25, 1.5, 2.5, 5.25, 1.5, 2.5, 6.25));
    EXPECT_THAT(values<std::int64_t>(cloud, "a"), ElementsAre(-1, -1, -1, -1));
    EXPECT_THAT(values<std::int64_t>(cloud, "b"),
                ElementsAre(-300, 300, -300, 300, -300, 300, -300, 300));
    EXPECT_THAT(find_column(cloud, "b")->components, ElementsAre("b_0", "b_1"));
    EXPECT_EQ(values<std::int64_t>(cloud, "c")[3], -70000);
  }
}

TEST(CloudFromMessage, NamesAreColumnNamesAndUnique) {
  PointCloud2 message = mixed_message(false);
  message.fields[3].name = "../../evil";
  message.fields[4].name = "..evil";
  message.fields[5].name = "xyz";
  message.header.frame_id = "map\nelement face 9";
  const PointCloud cloud = to_point_cloud(message);
  std::vector<std::string> names;
  for (const Column& column : cloud.columns)
    names.insert(names.end(), column.components.begin(), column.components.end());
  EXPECT_THAT(names, ElementsAre("x", "y", "z", "_evil", "_evil_2_0", "_evil_2_1", "xyz_2"));
  EXPECT_EQ(cloud.frame_id, "map?element face 9");
  message.fields[3].name = "b_0";
  message.fields[4].name = "b";
  message.fields[5].name = "world_from_sensor";
  names.clear();
  for (const Column& column : to_point_cloud(message).columns) names.push_back(column.name);
  EXPECT_THAT(names, ElementsAre("xyz", "b_0", "b_2", "world_from_sensor_2"));
}

TEST(CloudFromMessage, ManyNamesThatBecomeOneTakeLittleTime) {
  constexpr std::uint32_t kFields = 4000;  // of at most 4096
  PointCloud2 message;
  message.height = 1;
  message.fields = {{"x", 0, PointField::float32, 1},
                    {"y", 4, PointField::float32, 1},
                    {"z", 8, PointField::float32, 1}};
  for (std::uint32_t i = 0; i < kFields; ++i) {
    std::string name;
    for (std::uint32_t rest = i + 1; rest > 0; rest /= 8) name += "!#$%&()*"[rest % 8];
    message.fields.push_back({name, 12 + i, PointField::uint8, 1});
  }
  message.point_step = 12 + kFields;
  const PointCloud cloud = to_point_cloud(message);
  EXPECT_EQ(cloud.columns.back().name, "__" + std::to_string(kFields));
}

/// `count` fields of one byte with these names, then x, y, z and a field of `count` bytes.
PointCloud2 with_many_names(std::uint32_t count, const std::function<std::string(unsigned)>& name) {
  PointCloud2 message;
  message.height = message.width = 1;
  for (std::uint32_t i = 0; i < count; ++i)
    message.fields.push_back({name(i), i, PointField::uint8, 1});
  std::uint32_t at = count;
  for (const char* axis : {"x", "y", "z"}) {
    message.fields.push_back({axis, at, PointField::float32, 1});
    at += 4;
  }
  message.fields.push_back({"a", at, PointField::uint8, count});
  message.point_step = message.row_step = at + count;
  message.data = Payload(std::vector<std::byte>(message.point_step));
  return message;
}

TEST(CloudFromMessage, NamesThatCollideWithThoseOfComponentsTakeLittleTime) {
  constexpr std::uint32_t kCount = 30'000;
  const PointCloud cloud = to_point_cloud(
      with_many_names(kCount, [](unsigned i) { return "a_" + std::to_string(i + 2); }));
  EXPECT_EQ(cloud.columns.back().name, "a_" + std::to_string(kCount + 2));
  // each number for the column is found to be in use at its last component only
  const PointCloud2 hostile = with_many_names(kCount, [](unsigned i) {
    const std::string number = i == 0 ? "" : std::to_string(i + 1) + "_";
    return "a_" + number + std::to_string(kCount - 1);
  });
  EXPECT_THAT([&] { to_point_cloud(hostile); },
              ThrowsMessage<Error>(HasSubstr("names of fields that collide")));
}

TEST(CloudFromMessage, RowsWithoutPointsTakeNoTime) {
  PointCloud2 message = mixed_message(false);
  message.width = 0;
  message.height = 0xFFFFFFFF;
  message.data = Payload();
  const PointCloud cloud = to_point_cloud(message);
  EXPECT_EQ(cloud.rows, 1U);
  EXPECT_EQ(cloud.size(), 0U);
  message.height = 0;
  message.width = 0xFFFFFFFF;
  EXPECT_EQ(to_point_cloud(message).size(), 0U);
}

TEST(CloudFromMessage, NumbersOfAPointAreLimitedWithoutPoints) {
  PointCloud2 message = mixed_message(false);
  message.width = message.height = 0;
  message.data = Payload();
  message.point_step = 0xFFFFFFFF;
  message.fields.push_back({"d", 30, PointField::uint8, 1U << 28U});
  EXPECT_THAT(error_text([&] { to_point_cloud(message); }),
              HasSubstr("PointCloud2: more than 4096 numbers of a point"));
  message.fields.back() = {std::string(4000, 'n'), 30, PointField::uint8, 4000};
  EXPECT_THAT(error_text([&] { to_point_cloud(message); }), HasSubstr("bytes of names"));
  message.fields.back() = {"d", 30, PointField::uint8, 4000};
  EXPECT_EQ(to_point_cloud(message).columns.back().components.size(), 4000U);
}

TEST(CloudFromMessage, ContradictingSizesAreErrors) {
  const auto refused = [](const auto& change) {
    PointCloud2 message = mixed_message(false);
    change(message);
    return error_text([&] { to_point_cloud(message); });
  };
  EXPECT_THAT(refused([](PointCloud2& m) { m.height = 3; }), HasSubstr("bytes of points"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.height = m.width = m.row_step = 0xFFFFFFFF; }),
              HasSubstr("PointCloud2"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.point_step = 0; }), HasSubstr("rows that hold"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.row_step = 1; }), HasSubstr("rows that hold"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[5].offset = 27; }),
              HasSubstr("fields within the 30 bytes"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[5].offset = 21; }), HasSubstr("overlap"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[5].count = 0xFFFFFFFF; }),
              HasSubstr("numbers of a point"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[5].datatype = 9; }), HasSubstr("types 1 to 8"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[5].name = "a"; }), HasSubstr("two fields 'a'"));
  EXPECT_THAT(refused([](PointCloud2& m) { m.fields[0].name = "w"; }), HasSubstr("no x, y and z"));
  EXPECT_THAT(refused([](PointCloud2& m) {
                m.fields[3].name = "x";
                m.fields[1].name = "w";
              }),
              HasSubstr("float32 or float64"));
}

}  // namespace
}  // namespace glidar::ros
