// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/bags/bag_records.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/trajectory_file.hpp>

#include <io/ros/sample_messages.hpp>
#include <support/error_text.hpp>
#include <support/source_folder.hpp>
#include <support/test_folder.hpp>

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>

namespace glidar::bags {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::filesystem::path kRosbag1Corpus = std::filesystem::path(kCorpusFolder) / "rosbag1";
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

/// One kind of bag.
struct Kind {
  const char* name;
  const char* file;
  BagOptions options;
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {
      {"mcap", "run.mcap", {}},
      {"mcap_lz4", "run.mcap", {.compression = Compression::lz4}},
      {"mcap_zstd", "run.mcap", {.compression = Compression::zstd}},
      {"rosbag2", "run.rosbag2", {}},
      {"rosbag2_mcap", "run.rosbag2", {.mcap_storage = true}},
  };
  return kKinds;
}

/// Two topics of all kinds of bags; 20 messages, two of them late.
void write_run(const std::filesystem::path& path, const BagOptions& options) {
  const auto bag = create_bag(path, options);
  const std::size_t tf = bag->add_topic(ros::make_topic<ros::TFMessage>("/tf"));
  const std::size_t clouds = bag->add_topic(ros::make_topic<ros::PointCloud2>("/points"));
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::int64_t late_ns = i == 5 ? 25'000'000 : 0;
    const std::int64_t time_ns = kStart_ns + i * 10'000'000 - late_ns;
    ros::write_message(*bag, tf, time_ns, ros::sample<ros::TFMessage>(i));
    ros::write_message(*bag, clouds, time_ns, ros::sample<ros::PointCloud2>(i));
  }
  bag->finish();
}

class EveryBag : public ::testing::TestWithParam<Kind> {
 protected:
  std::filesystem::path write() {
    const std::filesystem::path path = folder_ / GetParam().file;
    write_run(path, GetParam().options);
    return path;
  }
  testing::TestFolder folder_;
};

TEST_P(EveryBag, ReadsBackItsMessagesInOrderOfTime) {
  const auto bag = open_bag(write());
  ASSERT_EQ(bag->topics().size(), 2U);
  const StoredTopic points = bag->topics()[1];
  EXPECT_EQ(points.name, "/points");
  EXPECT_EQ(ros::find_message_type(points.type.bytes()), &ros::message_type<ros::PointCloud2>());
  std::int64_t last_ns = 0;
  std::vector<std::uint32_t> seen;
  BagMessage message;
  while (bag->next(message)) {
    EXPECT_GE(message.time_ns, last_ns);
    last_ns = message.time_ns;
    if (message.topic != 1) continue;
    const auto cloud = ros::deserialize<ros::PointCloud2>(message.data, points.wire);
    const auto number = static_cast<std::uint32_t>(cloud.header.stamp.sec - 1'700'000'000);
    seen.push_back(number);
    const auto expected = ros::serialize(ros::sample<ros::PointCloud2>(number));
    EXPECT_TRUE(std::ranges::equal(message.data, expected));
  }
  EXPECT_THAT(seen, ElementsAre(0, 1, 2, 5, 3, 4, 6, 7, 8, 9));
  EXPECT_FALSE(bag->next(message));
}

TEST_P(EveryBag, ReadsSelectedTopicsOnly) {
  const auto bag = open_bag(write());
  const std::size_t tf = 0;
  bag->select({&tf, 1});
  BagMessage message;
  int count = 0;
  while (bag->next(message)) {
    EXPECT_EQ(message.topic, tf);
    ++count;
  }
  EXPECT_EQ(count, 10);
}

TEST_P(EveryBag, AppearsOnlyWhenItIsFinished) {
  const std::filesystem::path path = folder_ / GetParam().file;
  {
    const auto bag = create_bag(path, GetParam().options);
    const std::size_t clock = bag->add_topic(ros::make_topic<ros::Clock>("/clock"));
    ros::write_message(*bag, clock, 5, ros::Clock{});
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_THAT(folder_.names(), ElementsAre());
  write();
  EXPECT_THAT(folder_.names(), ElementsAre(GetParam().file));
}

TEST_P(EveryBag, ReplacesABagOfTheSameName) {
  const std::filesystem::path path = folder_ / GetParam().file;
  create_bag(path, GetParam().options)->finish();
  EXPECT_EQ(open_bag(path)->topics().size(), 0U);
  write();
  EXPECT_EQ(open_bag(path)->topics().size(), 2U);
  EXPECT_THAT(folder_.names(), ElementsAre(GetParam().file));
}

TEST_P(EveryBag, GivesPosesAndClouds) {
  const std::filesystem::path path = write();
  const std::vector<TimedPose> poses = read_bag_poses(path);
  ASSERT_EQ(poses.size(), 10U);
  EXPECT_EQ(poses[2].position_m.y(), 4.0);
  EXPECT_EQ(poses[2].t_ns, 1'700'000'002'123'456'789);
  BagClouds clouds(path);
  BagCloud cloud;
  int count = 0;
  while (clouds.next(cloud)) {
    EXPECT_EQ(cloud.cloud.size(), 3U);
    ++count;
  }
  EXPECT_EQ(count, 10);
  const TimedPoses trajectory = load_trajectory_file(path, {.start_ns = 0, .child_frame = "lidar"});
  EXPECT_EQ(trajectory.last_ns(), 9'000'000'000);
  EXPECT_EQ(trajectory.poses()[0].position_m.x(), 0.1);
}

TEST_P(EveryBag, LargeMessagesAndManyChunksReadBack) {
  const std::filesystem::path path = folder_ / GetParam().file;
  std::vector<std::byte> data(5'000'000);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::byte>(i * i >> 7U);
  const ros::CompressedImage image{ros::sample_header(1), "jpeg", ros::Payload(data)};
  const auto bag = create_bag(path, GetParam().options);
  const std::size_t topic = bag->add_topic(ros::make_topic<ros::CompressedImage>("/image"));
  for (int i = 0; i < 4; ++i) ros::write_message(*bag, topic, 100 - i, image);
  bag->finish();
  const auto reader = open_bag(path);
  BagMessage message;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(reader->next(message));
    EXPECT_EQ(message.time_ns, 97 + i);
    const auto read =
        ros::deserialize<ros::CompressedImage>(message.data, reader->topics()[0].wire);
    EXPECT_TRUE(std::ranges::equal(read.data.bytes(), data));
  }
  EXPECT_FALSE(reader->next(message));
}

TEST_P(EveryBag, BadTopicsAndTimesAreErrors) {
  const auto bag = create_bag(folder_ / GetParam().file, GetParam().options);
  const std::size_t topic = bag->add_topic(ros::make_topic<ros::Clock>("/clock"));
  EXPECT_THAT(error_text([&] { bag->add_topic(ros::make_topic<ros::Clock>("/clock")); }),
              HasSubstr("the topic /clock a second time"));
  for (const char* name : {"", "/", "clock", "/a//b", "/a/", "/a b", "/a\n"}) {
    EXPECT_THAT(error_text([&] { bag->add_topic(ros::make_topic<ros::Clock>(name)); }),
                HasSubstr("a topic '"))
        << name;
  }
  EXPECT_THAT(error_text([&] { ros::write_message(*bag, topic, -1, ros::Clock{}); }),
              HasSubstr("times since 1970"));
  EXPECT_THAT(error_text([&] { ros::write_message(*bag, 7, 1, ros::Clock{}); }),
              HasSubstr("a message of topic 7"));
}

INSTANTIATE_TEST_SUITE_P(Bags, EveryBag, ::testing::ValuesIn(kinds()),
                         [](const auto& test) { return std::string(test.param.name); });

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads everything; the text of the Error, if any.
std::string read_all(const std::filesystem::path& path) {
  return error_text([&] {
    const auto bag = open_bag_unconfined(path);
    BagMessage message;
    while (bag->next(message)) {
    }
  });
}

/// A bag that is one file, and its bytes.
struct WholeFile {
  std::string name;
  std::string bytes;
};

void PrintTo(const WholeFile& file, std::ostream* out) {
  *out << file.name;
}

/// Those of MCAP in every compression, and those of ROS 1 in the fuzzers' corpus.
std::vector<WholeFile> whole_files() {
  std::vector<WholeFile> files;
  for (const char* name : {"chunk", "lz4"})
    files.push_back({std::string("rosbag1_") + name + ".bag", bytes_of(kRosbag1Corpus / name)});
  for (const Kind& kind : kinds()) {
    const testing::TestFolder folder;
    if (std::string_view(kind.file) != "run.mcap") continue;
    write_run(folder / kind.file, kind.options);
    files.push_back({std::string(kind.name) + ".mcap", bytes_of(folder / kind.file)});
  }
  return files;
}

class EveryFile : public ::testing::TestWithParam<WholeFile> {};

TEST_P(EveryFile, CutAnywhereIsAnError) {
  const testing::TestFolder folder;
  const std::string& whole = GetParam().bytes;
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 3 : 211) {
    const auto cut = folder.write("cut_" + GetParam().name, whole.substr(0, size));
    EXPECT_THAT(read_all(cut), AllOf(Not("no error"), HasSubstr("cut_"))) << size;
  }
}

TEST_P(EveryFile, AnyChangedByteIsReadOrAnError) {
  const testing::TestFolder folder;
  const std::string& whole = GetParam().bytes;
  for (std::size_t at = 0; at < whole.size(); at += 61) {
    for (const char value : {'\x00', '\xff'}) {
      std::string changed = whole;
      changed[at] = value;
      read_all(folder.write("changed_" + GetParam().name, changed));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bags, EveryFile, ::testing::ValuesIn(whole_files()), [](const auto& test) {
  return test.param.name.substr(0, test.param.name.find('.'));
});

TEST(Rosbag1, IsReadInTheOrderOfTimeAndNotWritten) {
  for (const char* name : {"chunk", "lz4"}) {
    const testing::TestFolder folder;
    const auto bag = open_bag(folder.write("run.bag", bytes_of(kRosbag1Corpus / name)));
    ASSERT_EQ(bag->topics().size(), 1U);
    EXPECT_EQ(bag->topics()[0].name, "/clock");
    std::vector<std::uint32_t> nanoseconds;
    BagMessage message;
    while (bag->next(message)) {
      const auto clock = ros::deserialize<ros::Clock>(message.data, bag->topics()[0].wire);
      EXPECT_EQ(message.time_ns, ros::to_ns(clock.clock));
      nanoseconds.push_back(clock.clock.nanosec);
    }
    EXPECT_THAT(nanoseconds, ElementsAre(5, 9));  // which are stored as 9, 5
    EXPECT_THAT(error_text([&] { create_bag(folder / "new.bag"); }),
                HasSubstr("`rosbags-convert --src new.rosbag2 --dst new.bag`"));
  }
}

TEST(Mcap, AChangedChunkFailsItsChecksum) {
  const testing::TestFolder folder;
  write_run(folder / "run.mcap", {});
  std::string bytes = bytes_of(folder / "run.mcap");
  const std::size_t at = bytes.find("lidar_frame");
  bytes[at] = 'x';
  EXPECT_THAT(read_all(folder.write("bad.mcap", bytes)), HasSubstr("checksum does not match"));
}

TEST(Rosbag2, DamagedMetadataAndDatabasesAreErrors) {
  const testing::TestFolder folder;
  const std::filesystem::path bag = folder / "run.rosbag2";
  write_run(bag, {});
  const std::string yaml = bytes_of(bag / "metadata.yaml");
  const std::string database = bytes_of(bag / "run_0.db3");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = yaml;
    changed.replace(changed.find(from), from.size(), to);
    folder.write("run.rosbag2/metadata.yaml", changed);
    return read_all(bag);
  };
  EXPECT_THAT(with("sqlite3", "tape"), HasSubstr("storage 'tape'; allowed: sqlite3 or mcap"));
  EXPECT_THAT(with("compression_mode: \"\"", "compression_mode: FILE"),
              HasSubstr("compression of each FILE"));
  EXPECT_THAT(with("run_0.db3", "../run_1.db3"), HasSubstr("run_1.db3"));
  EXPECT_THAT(with("rosbag2_bagfile_information", "other"), HasSubstr("metadata.yaml"));
  EXPECT_THAT(with("version: 8", "version: [8"), HasSubstr("metadata.yaml"));
  folder.write("run.rosbag2/metadata.yaml", yaml);
  folder.write("run.rosbag2/run_0.db3", database.substr(0, 100));
  EXPECT_THAT(read_all(bag), HasSubstr("run_0.db3"));
  folder.write("run.rosbag2/run_0.db3", "no database");
  EXPECT_THAT(read_all(bag), HasSubstr("no SQLite database"));
  for (std::size_t at = 100; at < database.size(); at += 1009) {
    std::string changed = database;
    changed[at] = '\xff';
    folder.write("run.rosbag2/run_0.db3", changed);
    read_all(bag);
  }
}

TEST(Rosbag2, AFolderThatIsNoBagIsNotReplaced) {
  const testing::TestFolder folder;
  folder.write("run.rosbag2/thesis.txt", "text");
  EXPECT_THAT(error_text([&] { create_bag(folder / "run.rosbag2"); }),
              HasSubstr("exists and is no bag"));
  EXPECT_TRUE(std::filesystem::exists(folder / "run.rosbag2/thesis.txt"));
}

TEST(Rosbag2, UnfinishedFoldersAreRemovedBySignals) {
  const testing::TestFolder folder;
  const auto bag = create_bag(folder / "run.rosbag2");
  const auto other = create_bag(folder / "other.rosbag2", {.mcap_storage = true});
  EXPECT_EQ(folder.names().size(), 2U);
  remove_unfinished_files();
  EXPECT_THAT(folder.names(), ElementsAre());
}

TEST(BagPaths, AreKnownByTheirSuffixes) {
  EXPECT_TRUE(is_bag_path("a/run.mcap"));
  EXPECT_TRUE(is_bag_path("run.rosbag2/"));
  EXPECT_FALSE(is_bag_path("run.tum"));
  EXPECT_EQ(bag_format_for("run.rosbag2/"), BagFormat::rosbag2);
  EXPECT_THAT(error_text([] { bag_format_for("run.bags"); }),
              HasSubstr("allowed: .mcap .rosbag2 .bag"));
  const testing::TestFolder folder;
  EXPECT_THAT(error_text([&] { open_bag(folder / "none.mcap"); }), HasSubstr("none.mcap"));
  EXPECT_THAT(error_text([&] { open_bag(folder.path()); }), HasSubstr("metadata.yaml"));
}

TEST(BagOptions, ThatDoNotFitTheFormatAreErrors) {
  const testing::TestFolder folder;
  EXPECT_THAT(
      error_text([&] { create_bag(folder / "a.rosbag2", {.compression = Compression::lz4}); }),
      HasSubstr("compression with SQLite"));
}

/// A bag with a moving pair of frames behind a static one, and with odometry.
std::filesystem::path write_poses(const testing::TestFolder& folder) {
  const std::filesystem::path path = folder / "poses.mcap";
  const auto bag = create_bag(path);
  const std::size_t tf = bag->add_topic(ros::make_topic<ros::TFMessage>("/tf"));
  const std::size_t odom = bag->add_topic(ros::make_topic<ros::Odometry>("/odom"));
  bag->add_topic(ros::make_topic<ros::Clock>("/clock"));
  for (std::int32_t i = 0; i < 3; ++i) {
    ros::TransformStamped fixed{{0, {5, 0}, "/base"}, "lidar", {{0.5, 0.0, 0.0}, {}}};
    ros::TransformStamped moving{{0, {10 - i, 0}, "map"}, "base", {{1.0 * i, 0.0, 0.0}, {}}};
    moving.transform.rotation = {0.0, 0.0, 1.0, 0.0};  // half a turn
    ros::write_message(*bag, tf, i, ros::TFMessage{{fixed, moving, moving}});
    auto odometry = ros::sample<ros::Odometry>(static_cast<std::uint32_t>(i));
    ros::write_message(*bag, odom, i, odometry);
  }
  bag->finish();
  return path;
}

TEST(BagPoses, AreThoseOfTheFirstPairThatMovesSortedByStamp) {
  const testing::TestFolder folder;
  const auto path = write_poses(folder);
  const auto poses = read_bag_poses(path);
  ASSERT_EQ(poses.size(), 3U);  // repeated stamps are omitted
  EXPECT_EQ(poses[0].t_ns, 8'000'000'000);
  EXPECT_EQ(poses[0].position_m.x(), 2.0);
  EXPECT_EQ(read_bag_poses(path, {.child_frame = "lidar"}).size(), 1U);
}

TEST(BagPoses, AreInvertedWhenTheFramesAreNamedInReverse) {
  const testing::TestFolder folder;
  const auto poses =
      read_bag_poses(write_poses(folder), {.parent_frame = "base", .child_frame = "map"});
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].position_m.x(), 2.0);  // half a turn about z
}

TEST(BagPoses, OfOdometryAreSelectedByTopic) {
  const testing::TestFolder folder;
  const auto poses = read_bag_poses(write_poses(folder), {.topic = "/odom"});
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[2].position_m.x(), 2.0);
}

TEST(BagPoses, UnknownTopicsAndFramesAreErrorsThatListTheOthers) {
  const testing::TestFolder folder;
  const auto path = write_poses(folder);
  EXPECT_THAT(error_text([&] { read_bag_poses(path, {.topic = "/odm"}); }),
              AllOf(HasSubstr("/tf /odom"), HasSubstr("did you mean '/odom'")));
  EXPECT_THAT(error_text([&] { read_bag_poses(path, {.topic = "/clock"}); }),
              HasSubstr("no topic '/clock' that fits"));
  EXPECT_THAT(error_text([&] { read_bag_poses(path, {.child_frame = "foot"}); }),
              AllOf(HasSubstr("no pose of foot in any frame"), HasSubstr("map > base")));
  EXPECT_THAT(error_text([&] { BagClouds clouds(path); }), HasSubstr("no topic that fits"));
  EXPECT_THAT(error_text([&] { load_trajectory_file(path, {.rate_hz = 10.0}); }),
              HasSubstr("times of its own"));
  EXPECT_THAT(error_text([&] {
                load_trajectory_file(folder.write("a.tum", "0 0 0 0 0 0 0 1\n"), {.topic = "/tf"});
              }),
              HasSubstr("a topic or coordinate frames of a text file"));
}

}  // namespace
}  // namespace glidar::bags
