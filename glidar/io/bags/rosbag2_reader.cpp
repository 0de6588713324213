// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/rosbag2_reader.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/byte_reader.hpp>
#include <glidar/io/bags/mcap_reader.hpp>
#include <glidar/io/bags/sqlite_bag_reader.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/input_file.hpp>

#include <fmt/format.h>
#include <sys/stat.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
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
  std::set<std::string> names;
  for (const YAML::Node& file : files) {
    // Very old bags name the folder too.
    const std::string name = fs::path(text_of(file)).filename().string();
    if (name.empty() || name == "." || name == "..") reject_bag(place, "a file without a name");
    if (!names.insert(name).second)
      reject_bag(place, "the file " + excerpt(name) + " twice", "each file once");
    metadata.files.push_back(name);
  }
  return metadata;
}

TextFileKind metadata_kind() {
  return {"the metadata of a bag", 16, "see that it is a bag of ROS 2"};
}

Metadata read_metadata(const fs::path& folder) {
  const fs::path file = folder / "metadata.yaml";
  const std::string text = read_text_file(file, metadata_kind());
  try {
    check_yaml_budget(file.string(), text);
    return parse_metadata(YAML::Load(text), file.string());
  } catch (const YAML::Exception& error) {
    reject_bag(file.string(), error.what());
  }
}

/// The bytes of all files together. Throws Error when two names are the same file, by a link.
std::uint64_t checked_bytes(const fs::path& folder, const std::vector<std::string>& files) {
  std::set<std::pair<dev_t, ino_t>> known;
  std::uint64_t size = 0;
  for (const std::string& file : files) {
    struct stat info {};
    if (::stat((folder / file).c_str(), &info) != 0) continue;  // its reader reports it
    if (!known.emplace(info.st_dev, info.st_ino).second)
      reject_bag((folder / file).string(), "a link to another file of the bag", "each file once");
    size += static_cast<std::uint64_t>(info.st_size);
  }
  return size;
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
    std::vector<bool> selected(topics_.size(), false);
    for (const std::size_t topic : topics) selected.at(topic) = true;
    for (Part& part : parts_) {
      std::vector<std::size_t> own;
      for (std::size_t i = 0; i < part.topics.size(); ++i) {
        if (selected[part.topics[i]]) own.push_back(i);
      }
      part.reader->select(own);
    }
  }

  void leave_in_file() override {
    for (Part& part : parts_) part.reader->leave_in_file();
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
    const auto [known, is_new] =
        numbers_.try_emplace(std::pair(topic.name, topic.type), topics_.size());
    if (is_new) topics_.push_back(topic);
    return known->second;
  }

  std::vector<StoredTopic> topics_;
  std::map<std::pair<FileText, FileText>, std::size_t> numbers_;  ///< in topics_
  std::vector<Part> parts_;
};

}  // namespace

void require_metadata(const fs::path& path) {
  open_input_file(path / "metadata.yaml", metadata_kind());
}

std::unique_ptr<BagReader> open_rosbag2(const fs::path& path) {
  const Metadata metadata = read_metadata(path);
  const auto budget = std::make_shared<InputBudget>(checked_bytes(path, metadata.files));
  std::vector<std::unique_ptr<BagReader>> readers;
  for (const std::string& file : metadata.files) {
    if (metadata.storage == "mcap") {
      readers.push_back(open_mcap(path / file, budget));
    } else if (metadata.storage == "sqlite3") {
      readers.push_back(open_sqlite_bag(path / file, budget));
    } else {
      throw Error({path.string(), "storage '" + excerpt(metadata.storage) + "'", "sqlite3 or mcap",
                   "convert the bag with `ros2 bag convert`"});
    }
  }
  if (readers.size() == 1) return std::move(readers.front());
  return std::make_unique<MergedReader>(std::move(readers));
}

}  // namespace glidar::bags
