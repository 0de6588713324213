// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/rosbag2_writer.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/bags/mcap_writer.hpp>
#include <glidar/io/bags/sqlite_bag_writer.hpp>
#include <glidar/io/bags/staged_folder.hpp>
#include <glidar/io/bags/written_topics.hpp>
#include <glidar/io/files/atomic_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace glidar::bags {
namespace {

namespace fs = std::filesystem;

/// A folder that contains only the files of a bag, or nothing.
bool is_rosbag2_folder(const fs::path& path) {
  std::error_code error;
  const fs::directory_iterator files(path, error);
  if (error) return false;
  return std::all_of(begin(files), end(files), [](const fs::directory_entry& file) {
    const fs::path suffix = file.path().extension();
    return file.is_regular_file() &&
           (file.path().filename() == "metadata.yaml" || suffix == ".db3" || suffix == ".mcap");
  });
}

/// A text in double quotes, for YAML.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string topic_yaml(const WrittenTopic& topic) {
  return fmt::format(
      "    - topic_metadata:\n        name: {}\n        type: {}\n"
      "        serialization_format: cdr\n        offered_qos_profiles: {}\n"
      "        type_description_hash: {}\n      message_count: {}\n",
      topic.name, topic.type->name, quoted(ros::qos_yaml(topic.qos)), topic.type->type_hash,
      topic.messages);
}

/// ros2/rosbag2, rosbag2_storage/yaml.hpp.
std::string metadata_yaml(const WrittenTopics& topics, const std::string& storage,
                          const std::string& file) {
  const std::uint64_t duration_ns = topics.last_ns() - topics.first_ns();
  std::string yaml = fmt::format(
      "rosbag2_bagfile_information:\n  version: {}\n  storage_identifier: {}\n"
      "  duration:\n    nanoseconds: {}\n"
      "  starting_time:\n    nanoseconds_since_epoch: {}\n  message_count: {}\n"
      "  topics_with_message_count:{}\n",
      kMetadataVersion, storage, duration_ns, topics.first_ns(), topics.messages(),
      topics.all().empty() ? " []" : "");
  for (const WrittenTopic& topic : topics.all()) yaml += topic_yaml(topic);
  return yaml + fmt::format(
                    "  compression_format: \"\"\n  compression_mode: \"\"\n"
                    "  relative_file_paths:\n    - {0}\n"
                    "  files:\n    - path: {0}\n"
                    "      starting_time:\n        nanoseconds_since_epoch: {1}\n"
                    "      duration:\n        nanoseconds: {2}\n      message_count: {3}\n"
                    "  custom_data: ~\n  ros_distro: {4}\n",
                    quoted(file), topics.first_ns(), duration_ns, topics.messages(), kRosDistro);
}

class Rosbag2Writer : public BagWriter {
 public:
  Rosbag2Writer(const fs::path& path, const BagOptions& options)
      : folder_(path, is_rosbag2_folder),
        topics_(path.string()),
        file_name_(path.stem().string() + (options.mcap_storage ? "_0.mcap" : "_0.db3")) {
    with_name([&] { open_storage(options); });
  }

  [[nodiscard]] ros::Wire wire() const override { return ros::Wire::cdr; }

  std::size_t add_topic(const ros::Topic& topic) override {
    topics_.add(topic);
    std::size_t number = 0;
    with_name([&] { number = storage_->add_topic(topic); });
    return number;
  }

  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override {
    topics_.count(topic, time_ns);
    with_name([&] { storage_->write(topic, time_ns, message); });
  }

  void finish() override {
    with_name([&] { finish_files(); });
    folder_.commit();
  }

 private:
  /// Errors about files of the hidden folder name the bag.
  template <class Step>
  void with_name(const Step& step) const {
    try {
      step();
    } catch (const Error& error) {
      ErrorParts parts = error.parts();
      parts.where = folder_.path().string();
      throw Error(parts);
    }
  }

  void open_storage(const BagOptions& options) {
    const fs::path file = folder_.add_file(file_name_);
    if (options.mcap_storage) {
      storage_ = std::make_unique<McapWriter>(file, options);
      return;
    }
    auto sqlite = std::make_unique<SqliteBagWriter>(file);
    sqlite_ = sqlite.get();
    storage_ = std::move(sqlite);
  }

  void finish_files() {
    const std::string yaml =
        metadata_yaml(topics_, sqlite_ != nullptr ? "sqlite3" : "mcap", file_name_);
    if (sqlite_ != nullptr) sqlite_->put_metadata(yaml);
    storage_->finish();
    AtomicFile metadata(folder_.add_file("metadata.yaml"));
    metadata.write(yaml);
    metadata.commit();
  }

  StagedFolder folder_;
  WrittenTopics topics_;
  std::string file_name_;
  std::unique_ptr<BagWriter> storage_;
  SqliteBagWriter* sqlite_ = nullptr;  ///< the storage, if it is one
};

}  // namespace

std::unique_ptr<BagWriter> create_rosbag2(const fs::path& path, const BagOptions& options) {
  if (!options.mcap_storage && options.compression != Compression::none) {
    throw Error({path.string(), "compression with SQLite storage", "none",
                 "use MCAP storage, or write .mcap"});
  }
  return std::make_unique<Rosbag2Writer>(path, options);
}

}  // namespace glidar::bags
