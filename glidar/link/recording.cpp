// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/recording.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/config/json_value.hpp>
#include <glidar/io/files/paths.hpp>
#include <glidar/io/formats/sidecar.hpp>

#include <utility>
#include <vector>

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

lockstep::Body body_of(const JsonValue& json) {
  const std::vector<double> numbers = json.numbers();
  if (numbers.size() != kPoseNumbers && numbers.size() != kBodyNumbers) {
    json.refuse("a body of " + std::to_string(numbers.size()) + " numbers, instead of 12 or 18");
  }
  lockstep::Body body;
  for (std::size_t i = 0; i < kPoseNumbers; ++i) {
    body.world_from_body(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
        numbers[i];
  }
  if (!is_rigid(body.world_from_body)) json.refuse("a body whose matrix is not a rigid transform");
  if (numbers.size() == kBodyNumbers) {
    body.rate_rad_s = Eigen::Map<const Eigen::Vector3d>(numbers.data() + kPoseNumbers);
    body.velocity_m_s = Eigen::Map<const Eigen::Vector3d>(numbers.data() + kPoseNumbers + 3);
  }
  return body;
}

RecordingHead head_of(const JsonValue& json, const std::filesystem::path& path) {
  const JsonValue format = json.at("recording");
  if (format.count<std::uint64_t>() != kFormat) {
    format.refuse("format " + format.shown() + ", this program reads format 1");
  }
  RecordingHead head;
  head.version = json.at("glidar").text();
  const JsonValue command = json.at("command");
  const std::string folder = command.at("folder").text();
  check_recorded_path(path.string() + ":1", "folder", folder);
  head.command = {.arguments = command.at("arguments").texts(),
                  .folder = resolve_folder(path, folder)};
  for (const std::string& argument : head.command.arguments) {
    check_recorded_argument(path.string() + ":1", argument);
  }
  for (const JsonValue& file : json.at("files").items()) {
    head.files.push_back({file.at("path").text(), file.at("hash").text()});
    check_recorded_path(path.string() + ":1", "files, path", head.files.back().path);
  }
  return head;
}

RecordedFrame frame_of(const JsonValue& json) {
  RecordedFrame frame;
  constexpr std::size_t kHashDigits = 32;
  frame.sensor = json.at("sensor").count<std::uint32_t>();
  frame.moment.number = json.at("number").count<std::uint32_t>();
  frame.moment.seed = json.at("seed").count<std::uint64_t>();
  frame.moment.t_ns = json.at("stamp_ns").integer();
  const JsonValue hash = json.at("frame_hash");
  frame.frame_hash = hash.text();
  if (frame.frame_hash.size() != kHashDigits) hash.refuse("not 32 digits");
  frame.is_placed = json.contains("rig");
  if (!frame.is_placed) return frame;
  frame.moment.sensor = body_of(json.at("rig"));
  for (const JsonValue& object : json.at("objects").items()) {
    frame.moment.objects.push_back(body_of(object));
  }
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
  const RefuseJson refuse_here = [&](const std::string& found) { refuse(where(), found); };
  const nlohmann::json json = parse_own_json(where(), line, refuse_here);
  head_ = head_of(JsonValue(json, refuse_here), path);
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
  const RefuseJson refuse_here = [&](const std::string& found) { refuse(where(), found); };
  const nlohmann::json parsed = parse_own_json(where(), line, refuse_here);
  const JsonValue json(parsed, refuse_here);
  if (!json.contains("frames")) {
    ++frames_;
    return frame_of(json);
  }
  const JsonValue count = json.at("frames");
  if (count.count<std::uint64_t>() == frames_) return std::nullopt;
  refuse(where(), std::to_string(frames_) + " frames, but its last line states " + count.shown());
}

}  // namespace glidar::link
