// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/recording.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_error.hpp>
#include <glidar/io/files/recorded_path.hpp>
#include <glidar/io/formats/sidecar.hpp>

#include <limits>
#define JSON_DIAGNOSTICS 1  // error messages contain the key
#include <glidar/io/config/json_text.hpp>
#include <utility>

namespace glidar::link {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kFormat = 1;
constexpr std::size_t kMaxLine_bytes = std::size_t{1} << 28U;      // half a million objects
constexpr std::uintmax_t kMaxFile_mib = std::uintmax_t{1} << 24U;  // read line by line
const InputFileKind kRecording = {"a recording by glidar stream --record", kMaxFile_mib, ""};
constexpr std::size_t kPoseNumbers = 12;
constexpr std::size_t kBodyNumbers = kPoseNumbers + 6;

[[noreturn]] void refuse(std::string where, std::string found) {
  throw Error({std::move(where), std::move(found), "a recording by glidar stream --record",
               "copy the file again, or record again"});
}

std::string line_of(const Json& json) {
  return json.dump() + "\n";
}

/// Three rows of four numbers; rate and velocity only for moving bodies.
Json json_of(const lockstep::Body& body) {
  Json numbers = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) numbers.push_back(body.world_from_body(row, col));
  }
  if (body.rate_rad_s.isZero(0.0) && body.velocity_m_s.isZero(0.0)) return numbers;
  for (const double x : body.rate_rad_s) numbers.push_back(x);
  for (const double x : body.velocity_m_s) numbers.push_back(x);
  return numbers;
}

/// Throws an exception that names the key of the value.
[[noreturn]] void refuse_value(const Json& json, const std::string& found) {
  throw Json::other_error::create(502, found, &json);
}

lockstep::Body body_of(const Json& json) {
  const auto numbers = json.get<std::vector<double>>();
  if (numbers.size() != kPoseNumbers && numbers.size() != kBodyNumbers) {
    refuse_value(json,
                 "a body of " + std::to_string(numbers.size()) + " numbers, instead of 12 or 18");
  }
  lockstep::Body body;
  for (std::size_t i = 0; i < kPoseNumbers; ++i) {
    body.world_from_body(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
        numbers[i];
  }
  if (!is_rigid(body.world_from_body)) {
    refuse_value(json, "a body whose matrix is not a rigid transform");
  }
  if (numbers.size() == kBodyNumbers) {
    body.rate_rad_s = Eigen::Map<const Eigen::Vector3d>(numbers.data() + kPoseNumbers);
    body.velocity_m_s = Eigen::Map<const Eigen::Vector3d>(numbers.data() + kPoseNumbers + 3);
  }
  return body;
}

/// A count that is an integer and fits its type.
template <class Count>
Count count_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  const bool fits =
      value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<Count>::max();
  if (fits) return value.get<Count>();
  refuse_value(json, std::string(key) + ": " + shown_json(value) + " is not a count");
}

RecordingHead head_of(const Json& json, const std::filesystem::path& path) {
  if (count_of<std::uint64_t>(json, "recording") != kFormat) {
    refuse_value(json, "a recording of format " + shown_json(json.at("recording")) +
                           ", this program reads format 1");
  }
  RecordingHead head;
  head.version = json.at("glidar").get<std::string>();
  const Json& command = json.at("command");
  check_recorded_path(path.string() + ":1", "folder", command.at("folder").get<std::string>());
  head.command = {.arguments = command.at("arguments").get<std::vector<std::string>>(),
                  .folder = resolve_folder(path, command.at("folder").get<std::string>())};
  for (const std::string& argument : head.command.arguments) {
    check_recorded_argument(path.string() + ":1", argument);
  }
  for (const Json& file : json.at("files")) {
    head.files.push_back({file.at("path").get<std::string>(), file.at("hash").get<std::string>()});
    check_recorded_path(path.string() + ":1", "files, path", head.files.back().path);
  }
  return head;
}

RecordedFrame frame_of(const Json& json) {
  RecordedFrame frame;
  constexpr std::size_t kHashDigits = 32;
  frame.sensor = count_of<std::uint32_t>(json, "sensor");
  frame.moment.number = count_of<std::uint32_t>(json, "number");
  frame.moment.seed = count_of<std::uint64_t>(json, "seed");
  if (!json.at("stamp_ns").is_number_integer()) {
    refuse_value(json, "stamp_ns: not a whole number");
  }
  frame.moment.t_ns = json.at("stamp_ns").get<std::int64_t>();
  frame.frame_hash = json.at("frame_hash").get<std::string>();
  if (frame.frame_hash.size() != kHashDigits) {
    refuse_value(json, "frame_hash: not 32 digits");
  }
  frame.is_placed = json.contains("rig");
  if (!frame.is_placed) return frame;
  frame.moment.sensor = body_of(json.at("rig"));
  for (const Json& object : json.at("objects")) frame.moment.objects.push_back(body_of(object));
  return frame;
}

}  // namespace

void RecordingWriter::begin(const RecordingHead& head) {
  Json files = Json::array();
  for (const RecordedFile& file : head.files) {
    files.push_back({{"path", file.path}, {"hash", file.hash}});
  }
  const Json json = {{"recording", kFormat},
                     {"glidar", head.version},
                     {"command",
                      {{"arguments", head.command.arguments},
                       {"folder", relative_folder(file_.path(), head.command.folder)}}},
                     {"files", files}};
  try {
    file_.write(line_of(json));
  } catch (const Json::type_error&) {
    throw Error({.where = file_.path().string(),
                 .found = "an option or a file name that is not UTF-8",
                 .allowed = "UTF-8, the encoding of recordings",
                 .remedy = "rename the file or its folder"});
  }
}

void RecordingWriter::write(const RecordedFrame& frame) {
  Json json = {{"sensor", frame.sensor},
               {"number", frame.moment.number},
               {"stamp_ns", frame.moment.t_ns},
               {"seed", frame.moment.seed},
               {"frame_hash", frame.frame_hash}};
  if (frame.is_placed) {
    Json objects = Json::array();
    for (const lockstep::Body& object : frame.moment.objects) objects.push_back(json_of(object));
    json["rig"] = json_of(frame.moment.sensor);
    json["objects"] = std::move(objects);
  }
  file_.write(line_of(json));
  ++frames_;
}

void RecordingWriter::commit(Durability durability) {
  file_.write(line_of({{"frames", frames_}}));
  if (durability == Durability::synced) return file_.commit_durably();
  file_.commit();
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : path_(path), file_(path, kRecording, kMaxLine_bytes) {
  std::string line;
  if (!read_line(line)) refuse(path.string(), "it is empty or cannot be read");
  try {
    head_ = head_of(parse_json<Json>(where(), line), path);
  } catch (const Json::exception& error) {
    refuse(where(), json_error_text(error.id, error.what()));
  }
}

std::string RecordingReader::where() const {
  return path_.string() + ":" + std::to_string(line_);
}

bool RecordingReader::read_line(std::string& line) {
  while (file_.next(line)) {
    ++line_;
    // ignores blank lines of edited files
    if (line.find_first_not_of(" \t\r") != std::string::npos) return true;
  }
  return false;
}

std::optional<RecordedFrame> RecordingReader::next() {
  std::string line;
  if (!read_line(line)) refuse(where(), "it ends before its last line, which contains \"frames\"");
  try {
    const Json json = parse_json<Json>(where(), line);
    if (!json.contains("frames")) {
      ++frames_;
      return frame_of(json);
    }
    if (count_of<std::uint64_t>(json, "frames") == frames_) return std::nullopt;
    refuse(where(), std::to_string(frames_) + " frames, but its last line states " +
                        shown_json(json["frames"]));
  } catch (const Json::exception& error) {
    refuse(where(), json_error_text(error.id, error.what()));
  }
}

}  // namespace glidar::link
