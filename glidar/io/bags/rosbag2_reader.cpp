// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/rosbag2_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/excerpt.hpp>
#include <glidar/io/bags/byte_reader.hpp>
#include <glidar/io/bags/mcap_reader.hpp>
#include <glidar/io/bags/sqlite_bag_reader.hpp>
#include <glidar/io/config/yaml_budget.hpp>
#include <glidar/io/files/text_file.hpp>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <utility>

namespace glidar::bags {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 1000;  // all are open together

struct Metadata {
  std::string storage;
  std::vector<std::string> files;
};

std::string text_of(const YAML::Node& node) {
  return node.IsDefined() && node.IsScalar() ? node.Scalar() : std::string();
}

Metadata parse_metadata(const YAML::Node& root, const std::string& place) {
  if (!root.IsMap() || !root["rosbag2_bagfile_information"].IsMap())
    reject_bag(place, "no rosbag2_bagfile_information");
  const YAML::Node information = root["rosbag2_bagfile_information"];
  const std::string mode = text_of(information["compression_mode"]);
  if (!mode.empty() && mode != "NONE" && mode != "none") {
    throw Error({place, "compression of each " + excerpt(mode), "none",
                 "convert the bag with `ros2 bag convert`"});
  }
  Metadata metadata{text_of(information["storage_identifier"]), {}};
  const YAML::Node files = information["relative_file_paths"];
  if (!files.IsSequence() || files.size() == 0 || files.size() > kMaxFiles)
    reject_bag(place, "no list of files", fmt::format("1 to {} relative_file_paths", kMaxFiles));
  for (const YAML::Node& file : files) {
    // Very old bags name the folder too.
    const std::string name = fs::path(text_of(file)).filename().string();
    if (name.empty() || name == "." || name == "..") reject_bag(place, "a file without a name");
    metadata.files.push_back(name);
  }
  return metadata;
}

Metadata read_metadata(const fs::path& folder) {
  const fs::path file = folder / "metadata.yaml";
  const std::string text =
      read_text_file(file, {"the metadata of a bag", 16, "see that it is a bag of ROS 2"});
  try {
    check_yaml_budget(file.string(), text);
    return parse_metadata(YAML::Load(text), file.string());
  } catch (const YAML::Exception& error) {
    reject_bag(file.string(), error.what());
  }
}

/// Merges several bags by time. Topics of the same name and type are one.
class MergedReader : public BagReader {
 public:
  explicit MergedReader(std::vector<std::unique_ptr<BagReader>> readers) {
    for (std::unique_ptr<BagReader>& reader : readers) {
      Part part;
      for (const StoredTopic& topic : reader->topics()) part.topics.push_back(index_of(topic));
      part.reader = std::move(reader);
      parts_.push_back(std::move(part));
    }
  }

  [[nodiscard]] std::span<const StoredTopic> topics() const override { return topics_; }

  void select(std::span<const std::size_t> topics) override {
    for (Part& part : parts_) {
      std::vector<std::size_t> own;
      for (std::size_t i = 0; i < part.topics.size(); ++i) {
        if (std::find(topics.begin(), topics.end(), part.topics[i]) != topics.end())
          own.push_back(i);
      }
      part.reader->select(own);
    }
  }

  bool next(BagMessage& message) override {
    for (Part& part : parts_) {
      if (!part.is_pending && !part.has_ended) advance(part);
    }
    Part* first = nullptr;
    for (Part& part : parts_) {
      if (part.is_pending && (first == nullptr || part.message.time_ns < first->message.time_ns))
        first = &part;
    }
    if (first == nullptr) return false;
    message = first->message;
    message.topic = first->topics[message.topic];
    first->is_pending = false;
    return true;
  }

 private:
  struct Part {
    std::unique_ptr<BagReader> reader;
    std::vector<std::size_t> topics;  ///< from its numbers to ours
    BagMessage message;
    bool is_pending = false;
    bool has_ended = false;
  };

  static void advance(Part& part) {
    part.is_pending = part.reader->next(part.message);
    part.has_ended = !part.is_pending;
  }

  std::size_t index_of(const StoredTopic& topic) {
    const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const StoredTopic& other) {
      return other.name == topic.name && other.type == topic.type;
    });
    if (known == topics_.end()) {
      topics_.push_back(topic);
      return topics_.size() - 1;
    }
    return static_cast<std::size_t>(known - topics_.begin());
  }

  std::vector<StoredTopic> topics_;
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<BagReader> open_rosbag2(const fs::path& path) {
  const Metadata metadata = read_metadata(path);
  std::vector<std::unique_ptr<BagReader>> readers;
  for (const std::string& file : metadata.files) {
    if (metadata.storage == "mcap") {
      readers.push_back(open_mcap(path / file));
    } else if (metadata.storage == "sqlite3") {
      readers.push_back(open_sqlite_bag(path / file));
    } else {
      throw Error({path.string(), "storage '" + excerpt(metadata.storage) + "'", "sqlite3 or mcap",
                   "convert the bag with `ros2 bag convert`"});
    }
  }
  if (readers.size() == 1) return std::move(readers.front());
  return std::make_unique<MergedReader>(std::move(readers));
}

}  // namespace glidar::bags
