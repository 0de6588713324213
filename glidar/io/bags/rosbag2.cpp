// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/bags/bag_formats.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/bag_storage.hpp>
#include <glidar/io/bags/sqlite.hpp>
#include <glidar/io/bags/sqlite_bag_reader.hpp>
#include <glidar/io/config/yaml_reader.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/input_file.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

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

/// A folder that appears under its name only when all its files are complete. Until commit() they
/// are in a temporary folder beside it, which the destructor removes.
class StagedFolder {
 public:
  /// Throws Error when `path` exists and is no bag, or no folder can be created beside it.
  explicit StagedFolder(const fs::path& path);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// The path of a new file in the temporary folder, which a signal removes.
  fs::path add_file(const std::string& name);
  /// Gives the folder its name; a folder of this name is replaced and removed. Throws Error.
  void commit();
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  fs::path temporary_;      ///< empty once committed
  std::vector<int> slots_;  ///< of the list of unfinished files
};

[[noreturn]] void fail_folder(const fs::path& path, const char* what, int code) {
  throw Error({path.string(),
               fmt::format("cannot {}: {}", what, std::generic_category().message(code)), "",
               code == ENOENT ? "create the folder above it first" : ""});
}

StagedFolder::StagedFolder(const fs::path& path) : path_(path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !(fs::is_directory(path, ignored) && is_rosbag2_folder(path))) {
    throw Error({path.string(), "exists and is no bag", "a new name, or a bag to replace",
                 "remove it, or write to another path"});
  }
  const fs::path folder = fs::absolute(path).parent_path();
  for (unsigned attempt = 0;; ++attempt) {
    fs::path name = folder / fmt::format(".glidar-{}-{}.folder.tmp", ::getpid(), attempt);
    const int slot = list_unfinished(name.native());
    constexpr mode_t kDefault = 0777;
    if (::mkdir(name.c_str(), kDefault) == 0) {
      slots_.push_back(slot);
      temporary_ = std::move(name);
      return;
    }
    const int code = errno;
    unlist_unfinished(slot);
    if (code != EEXIST) fail_folder(path, "create a folder here", code);
  }
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  for (const int slot : slots_) unlist_unfinished(slot);
}

fs::path StagedFolder::add_file(const std::string& name) {
  fs::path file = temporary_ / name;
  slots_.push_back(list_unfinished(file.native()));
  return file;
}

void StagedFolder::commit() {
  if (::rename(temporary_.c_str(), path_.c_str()) == 0) {
    temporary_.clear();
    return;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) fail_folder(path_, "rename", errno);
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0)
    fail_folder(path_, "replace the bag of this name", errno);
  // The temporary name is now that of the old bag, which the destructor removes.
}

/// Version of metadata.yaml (ros2/rosbag2, rosbag2_storage/bag_metadata.hpp): the last one that
/// stores QoS as text, which all readers of versions 7 to 9 accept.
constexpr int kMetadataVersion = 8;

/// As rosbag2 spells a distribution that it does not know.
constexpr const char* kRosDistro = "unknown";

/// Writes the SQLite storage of rosbag2, with the tables of schema version 4, directly to `path`.
class SqliteBagWriter : public BagWriter {
 public:
  explicit SqliteBagWriter(const fs::path& path);

  std::size_t add_topic(const ros::Topic& topic) override;
  void write(std::size_t topic, std::int64_t time_ns, std::span<const std::byte> message) override;
  void finish() override;
  /// The content of metadata.yaml, which the database stores too; before finish().
  void put_metadata(const std::string& yaml);

 private:
  Database database_;
  std::optional<Statement> insert_message_;
  std::size_t topics_ = 0;
  std::set<const ros::MessageType*> defined_;
};

/// ros2/rosbag2, rosbag2_storage_sqlite3/src/rosbag2_storage_sqlite3/sqlite_storage.cpp.
constexpr const char* kTables =
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,"
    "metadata TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL);"
    "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY,topic_type TEXT NOT NULL,"
    "encoding TEXT NOT NULL,encoded_message_definition TEXT NOT NULL,"
    "type_description_hash TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
    "timestamp INTEGER NOT NULL,data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);";
constexpr int kSchemaVersion = 4;

SqliteBagWriter::SqliteBagWriter(const fs::path& path) : database_(path) {
  database_.execute("BEGIN");
  database_.execute(kTables);
  Statement version(database_, "INSERT INTO schema VALUES(?,?)");
  version.bind(1, kSchemaVersion);
  version.bind(2, std::string_view(kRosDistro));
  version.step();
  insert_message_.emplace(database_, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)");
}

std::size_t SqliteBagWriter::add_topic(const ros::Topic& topic) {
  Statement insert(database_, "INSERT INTO topics VALUES(?,?,?,'cdr',?,?)");
  insert.bind(1, static_cast<std::int64_t>(topics_ + 1));
  insert.bind(2, topic.name);
  insert.bind(3, topic.type->name);
  insert.bind(4, ros::qos_yaml(topic.qos));
  insert.bind(5, topic.type->type_hash);
  insert.step();
  if (defined_.insert(topic.type).second) {
    Statement define(database_,
                     "INSERT INTO message_definitions(topic_type,encoding,"
                     "encoded_message_definition,type_description_hash) "
                     "VALUES(?,'ros2msg',?,?)");
    define.bind(1, topic.type->name);
    define.bind(2, ros::definition_text(*topic.type));
    define.bind(3, topic.type->type_hash);
    define.step();
  }
  return topics_++;
}

void SqliteBagWriter::write(std::size_t topic, std::int64_t time_ns,
                            std::span<const std::byte> message) {
  insert_message_->bind(1, static_cast<std::int64_t>(topic + 1));
  insert_message_->bind(2, time_ns);
  insert_message_->bind(3, message);
  insert_message_->step();
}

void SqliteBagWriter::put_metadata(const std::string& yaml) {
  Statement insert(database_, "INSERT INTO metadata(metadata_version,metadata) VALUES(?,?)");
  insert.bind(1, kMetadataVersion);
  insert.bind(2, yaml);
  insert.step();
}

void SqliteBagWriter::finish() {
  database_.execute("COMMIT");
  insert_message_.reset();
  database_.close();
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
      : folder_(path),
        topics_(path.string()),
        file_name_(path.stem().string() + (options.mcap_storage ? "_0.mcap" : "_0.db3")) {
    with_name([&] { open_storage(options); });
  }

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
