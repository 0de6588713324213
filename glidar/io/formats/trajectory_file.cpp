// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/formats/trajectory_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/time_text.hpp>
#include <glidar/io/bags/bag.hpp>
#include <glidar/io/bags/bag_contents.hpp>
#include <glidar/io/files/input_file.hpp>
#include <glidar/math/elementary.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glidar {
namespace {

/// A word and the column of its first character, from 1.
struct Word {
  std::string_view text;
  std::size_t column = 1;
};

/// The rows of a text, without blank lines and comments ('#' to the end of the line).
class TextRowReader {
 public:
  /// `content` must outlive the rows.
  TextRowReader(std::string file, std::string_view content);

  /// Reads the next row; false at the end.
  bool next();

  /// The parts of the row, separated by commas and trimmed, or by blanks if there is no comma. At
  /// most 64; a longer row has 65.
  [[nodiscard]] const std::vector<Word>& words() const { return words_; }
  [[nodiscard]] bool has_commas() const { return has_commas_; }
  [[nodiscard]] std::size_t line() const { return line_; }

  /// Throws Error at this word: "file:line:column: found; allowed: ...".
  [[noreturn]] void reject(const Word& word, std::string found, std::string allowed,
                           std::string remedy = "") const;

  /// The word as a finite number; throws Error when it is not one.
  [[nodiscard]] double number(const Word& word) const;

  /// Seconds as nanoseconds, exact for up to nine decimals; throws Error when the word is
  /// not a number or beyond 290 years.
  [[nodiscard]] std::int64_t time_ns(const Word& word) const;

  /// Nanoseconds; throws Error when the word is not a whole number.
  [[nodiscard]] std::int64_t whole_ns(const Word& word) const;

 private:
  void split(std::string_view row);

  std::string file_;
  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<Word> words_;
  bool has_commas_ = false;
};

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kMaxWords = 64;

TextRowReader::TextRowReader(std::string file, std::string_view content)
    : file_(std::move(file)), rest_(content) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool TextRowReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view row = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    row = row.substr(0, row.find('#'));
    if (row.find_first_not_of(kBlanks) == std::string_view::npos) continue;
    split(row);
    return true;
  }
  return false;
}

void TextRowReader::split(std::string_view row) {
  words_.clear();
  has_commas_ = row.find(',') != std::string_view::npos;
  std::size_t at = 0;
  while (at <= row.size() && words_.size() <= kMaxWords) {
    at = std::min(row.find_first_not_of(kBlanks, at), row.size());
    if (!has_commas_ && at == row.size()) return;
    const std::size_t end =
        std::min(has_commas_ ? row.find(',', at) : row.find_first_of(kBlanks, at), row.size());
    std::string_view text = row.substr(at, end - at);
    text = text.substr(0, text.find_last_not_of(kBlanks) + 1);  // npos + 1 is 0
    words_.push_back({text, at + 1});
    at = end + 1;
  }
}

void TextRowReader::reject(const Word& word, std::string found, std::string allowed,
                           std::string remedy) const {
  const std::string place = file_ + ":" + std::to_string(line_) + ":" + std::to_string(word.column);
  throw Error({place, std::move(found), std::move(allowed), std::move(remedy)});
}

double TextRowReader::number(const Word& word) const {
  std::string_view text = word.text;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = !text.empty() && end == text.data() + text.size();
  if (whole && error == std::errc() && std::isfinite(value)) return value;
  reject(word, "'" + shown(word.text) + "'", "a finite number");
}

std::int64_t TextRowReader::time_ns(const Word& word) const {
  (void)number(word);
  const std::optional<std::int64_t> exact = parse_seconds_ns(word.text);
  if (exact) return *exact;
  reject(word, "'" + shown(word.text) + "'", "seconds from -9.2e9 to 9.2e9",
         "nanoseconds are allowed in CSV files with a column 'timestamp [ns]'");
}

std::int64_t TextRowReader::whole_ns(const Word& word) const {
  std::int64_t value = 0;
  const auto [end, error] =
      std::from_chars(word.text.data(), word.text.data() + word.text.size(), value);
  if (error == std::errc() && end == word.text.data() + word.text.size()) return value;
  reject(word, "'" + shown(word.text) + "' in a column of nanoseconds", "whole numbers",
         "a column of seconds is called 't'");
}

/// Five million poses of a hundred characters.
constexpr std::uintmax_t kMaxTrajectoryFile_mib = 512;
constexpr std::array<const char*, 8> kNames = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::size_t kTum = kNames.size();
constexpr std::size_t kKitti = 12;

/// The columns of a file.
struct Columns {
  std::array<std::size_t, kTum> at = {0, 1, 2, 3, 4, 5, 6, 7};  ///< the position of each of kNames
  std::size_t count = kTum;                                     ///< in a row
  bool has_ns = false;                                          ///< times in nanoseconds
};

TextFileKind file_kind() {
  return {"a trajectory file", kMaxTrajectoryFile_mib, "shorten it, or reduce the number of poses"};
}

void require_count(const TextRowReader& rows, std::size_t count, const char* what) {
  const std::vector<Word>& words = rows.words();
  if (words.size() == count) return;
  const Word& at = words.size() > count ? words[count] : words.back();
  rows.reject(at, std::to_string(words.size()) + (words.size() == 1 ? " column" : " columns"),
              std::to_string(count) + " in every row" + what);
}

/// Appends the pose; throws Error at the word of an invalid part.
void append(const TextRowReader& rows, const TimedPose& pose, const std::array<Word, 3>& parts,
            std::vector<TimedPose>& poses) {
  const auto error = find_error(poses.empty() ? nullptr : &poses.back(), pose);
  if (error)
    rows.reject(parts[static_cast<std::size_t>(error->part)], error->found, error->allowed);
  poses.push_back(pose);
}

void read_quaternion_row(const TextRowReader& rows, const Columns& columns,
                         std::vector<TimedPose>& poses) {
  require_count(rows, columns.count, "");
  const auto word = [&](std::size_t name) { return rows.words()[columns.at[name]]; };
  const auto number = [&](std::size_t name) { return rows.number(word(name)); };
  TimedPose pose{.t_ns = columns.has_ns ? rows.whole_ns(word(0)) : rows.time_ns(word(0)),
                 .position_m = {number(1), number(2), number(3)}};
  pose.orientation = Eigen::Quaterniond(number(7), number(4), number(5), number(6));
  append(rows, pose, {word(0), word(1), word(4)}, poses);
}

/// The name of a column: its index in kNames; kTum for another quantity of EuRoC files; empty for
/// an unknown one. Names of EuRoC files have a unit behind: "p_RS_R_x [m]", "q_RS_w []".
std::optional<std::size_t> name_of_column(std::string_view text) {
  const std::string_view name = text.substr(0, text.find_first_of(" ["));
  const auto find = [](std::string_view wanted) {
    return static_cast<std::size_t>(std::find(kNames.begin(), kNames.end(), wanted) -
                                    kNames.begin());
  };
  if (const std::size_t at = find(name); at < kTum) return at;
  if (name == "timestamp") return 0;
  const bool has_axis = name.size() >= 3 && name[name.size() - 2] == '_' && name[1] == '_';
  if (!has_axis) return std::nullopt;
  if (name[0] == 'p') return find(name.substr(name.size() - 1));
  if (name[0] == 'q') return find("q" + std::string(name.substr(name.size() - 1)));
  constexpr std::string_view kOthers = "vbwa";  // velocity, biases, rate and acceleration
  return kOthers.find(name[0]) < kOthers.size() ? std::optional<std::size_t>(kTum) : std::nullopt;
}

/// Whether the column of times is in nanoseconds: by its unit, else by its name, as in EuRoC files.
bool has_nanoseconds(const TextRowReader& rows, const Word& word) {
  const std::size_t bracket = word.text.find('[');
  if (bracket == std::string_view::npos) return word.text == "timestamp";
  const std::string_view unit = word.text.substr(bracket);
  if (unit == "[ns]" || unit == "[s]") return unit == "[ns]";
  rows.reject(word, "the unit " + shown(unit) + " of times", "[s] or [ns]");
}

/// The columns of EuRoC files, from their first row of numbers: nanoseconds, position, qw qx qy qz,
/// and in files with 17 columns velocities and biases.
Columns euroc_columns(const TextRowReader& rows) {
  constexpr std::size_t kMinDigits = 16;  // of nanoseconds since 1970, from its twelfth day on
  constexpr std::size_t kWithBiases = 17;
  const std::string_view time = rows.words()[0].text;
  const std::size_t count = rows.words().size();
  const bool has_ns =
      time.size() >= kMinDigits && time.find_first_not_of("0123456789") == std::string_view::npos;
  if (has_ns && (count == kTum || count == kWithBiases))
    return {.at = {0, 1, 2, 3, 5, 6, 7, 4}, .count = count, .has_ns = true};
  rows.reject(rows.words()[0], "numbers in the first row, which names the columns of CSV files",
              "a row of names; without it, rows of EuRoC files: nanoseconds with 16 digits or "
              "more, x, y, z, qw, qx, qy, qz, 8 or 17 columns",
              "add the row 't,x,y,z,qx,qy,qz,qw', in the order of the columns");
}

/// The header of a CSV file.
Columns named_columns(const TextRowReader& rows) {
  const std::string allowed =
      "t, x, y, z, qw, qx, qy, qz, each once, in any order, or the names of EuRoC files";
  Columns columns{.count = rows.words().size()};
  std::array<bool, kTum> seen{};
  for (std::size_t i = 0; i < rows.words().size(); ++i) {
    const Word& word = rows.words()[i];
    const std::optional<std::size_t> at = name_of_column(word.text);
    if (!at) {
      rows.reject(word, "the column '" + shown(word.text) + "'", allowed,
                  "the first row names the columns");
    }
    if (*at == kTum) continue;
    if (seen[*at])
      rows.reject(word, "the column '" + std::string(kNames[*at]) + "' again", allowed);
    seen[*at] = true;
    columns.at[*at] = i;
    if (*at == 0) columns.has_ns = has_nanoseconds(rows, word);
  }
  const auto missing = std::find(seen.begin(), seen.end(), false);
  if (missing == seen.end()) return columns;
  rows.reject(
      rows.words().back(),
      "no column '" + std::string(kNames[static_cast<std::size_t>(missing - seen.begin())]) + "'",
      allowed);
}

/// The header of EuRoC files is a comment: "#timestamp [ns],p_RS_R_x [m], ...".
void uncomment_header(std::string& content) {
  const std::size_t first = content.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || content[first] != '#') return;
  const std::string_view row =
      std::string_view(content).substr(first, content.find('\n', first) - first);
  const std::size_t name = row.find_first_not_of("# ");
  if (row.find(',') == std::string_view::npos || name == std::string_view::npos ||
      !row.substr(name).starts_with("timestamp"))
    return;
  std::fill_n(content.begin() + static_cast<std::ptrdiff_t>(first), name, ' ');
}

/// The times of a KITTI sequence.
std::vector<std::int64_t> read_times(const std::filesystem::path& path) {
  const std::string content = read_text_file(path, file_kind());
  TextRowReader rows(path.string(), content);
  std::vector<std::int64_t> times;
  while (rows.next()) {
    require_count(rows, 1, ": a time in seconds");
    const Word& word = rows.words()[0];
    const std::int64_t t_ns = rows.time_ns(word);
    if (!times.empty() && t_ns <= times.back()) {
      rows.reject(word, "a time not after the one before", "times that increase");
    }
    times.push_back(t_ns);
  }
  return times;
}

/// The times of the poses of a KITTI file, from the options.
class KittiClock {
 public:
  KittiClock(const std::string& file, const TrajectoryFileOptions& options)
      : rate_hz_(options.rate_hz.value_or(0.0)), times_file_(options.times_file.string()) {
    if (options.rate_hz.has_value() == !options.times_file.empty()) {
      throw Error({file,
                   options.rate_hz ? "a KITTI file with a rate and a file of times"
                                   : "a KITTI file, whose rows have no times",
                   "a rate or a file of times", "give one of them"});
    }
    if (options.rate_hz) return;
    times_ = read_times(options.times_file);
  }

  [[nodiscard]] std::int64_t time_ns(const TextRowReader& rows, std::size_t pose) const {
    if (times_file_.empty()) {
      return std::llround(static_cast<double>(pose) * 1e9 / rate_hz_);
    }
    if (pose < times_.size()) return times_[pose];
    rows.reject(rows.words()[0], "pose " + std::to_string(pose + 1),
                "one per time; " + times_file_ + " has " + std::to_string(times_.size()));
  }

  void require_end(const std::string& file, std::size_t poses) const {
    if (times_file_.empty() || poses == times_.size()) return;
    throw Error({file, std::to_string(poses) + " poses",
                 "one per time; " + times_file_ + " has " + std::to_string(times_.size())});
  }

 private:
  double rate_hz_;
  std::string times_file_;
  std::vector<std::int64_t> times_;
};

void read_matrix_row(const TextRowReader& rows, std::int64_t t_ns, std::vector<TimedPose>& poses) {
  require_count(rows, kKitti, "");
  Eigen::Matrix<double, 3, 4> matrix;
  for (Eigen::Index i = 0; i < 12; ++i) {
    matrix(i / 4, i % 4) = rows.number(rows.words()[static_cast<std::size_t>(i)]);
  }
  Pose pose = Pose::Identity();
  pose.linear() = matrix.leftCols<3>();
  constexpr double kTolerance = 1e-3;  // accepts files with four decimals
  if (!is_rigid(pose, kTolerance)) {
    rows.reject(rows.words()[0], "a matrix whose first three columns are not a rotation",
                "a rotation to within 0.001");
  }
  const TimedPose timed{.t_ns = t_ns,
                        .position_m = matrix.col(3),
                        .orientation = Eigen::Quaterniond(pose.linear()).normalized()};
  append(rows, timed, {rows.words()[0], rows.words()[3], rows.words()[0]}, poses);
}

std::vector<TimedPose> read_kitti(TextRowReader& rows, const std::string& file,
                                  const TrajectoryFileOptions& options) {
  const KittiClock clock(file, options);
  std::vector<TimedPose> poses;
  do {
    read_matrix_row(rows, clock.time_ns(rows, poses.size()), poses);
  } while (rows.next());
  clock.require_end(file, poses.size());
  return poses;
}

void require_no_times(const std::string& file, const TrajectoryFileOptions& options) {
  if (!options.rate_hz && options.times_file.empty()) return;
  throw Error({file, "a file that has times of its own", "a rate or times with KITTI files only",
               "omit them"});
}

std::vector<TimedPose> read_quaternions(TextRowReader& rows, const std::string& file,
                                        const TrajectoryFileOptions& options) {
  require_no_times(file, options);
  const bool has_names =
      rows.has_commas() && rows.words()[0].text.find_first_of("+-.0123456789") != 0;
  Columns columns;
  if (rows.has_commas()) columns = has_names ? named_columns(rows) : euroc_columns(rows);
  std::vector<TimedPose> poses;
  if (!has_names) read_quaternion_row(rows, columns, poses);
  while (rows.next()) read_quaternion_row(rows, columns, poses);
  return poses;
}

std::vector<TimedPose> read_text(const std::filesystem::path& path,
                                 const TrajectoryFileOptions& options) {
  const std::string file = path.string();
  if (!options.topic.empty() || !options.parent_frame.empty() || !options.child_frame.empty()) {
    throw Error({file, "a topic or coordinate frames of a text file", "a bag with them",
                 "omit them, or name a bag"});
  }
  std::string content = read_text_file(path, file_kind());
  uncomment_header(content);
  TextRowReader rows(file, content);
  if (!rows.next()) throw Error({file, "no pose", "at least one", "see docs/files.md"});
  const std::size_t width = rows.words().size();
  if (!rows.has_commas() && width != kTum && width != kKitti) {
    rows.reject(rows.words()[0], std::to_string(width) + " columns",
                "8 (TUM: t x y z qx qy qz qw), 12 (KITTI), or names with commas between (CSV)");
  }
  const bool kitti = !rows.has_commas() && width == kKitti;
  return kitti ? read_kitti(rows, file, options) : read_quaternions(rows, file, options);
}

std::vector<TimedPose> read_bag(const std::filesystem::path& path,
                                const TrajectoryFileOptions& options) {
  require_no_times(path.string(), options);
  return bags::read_bag_poses(path, {options.topic, options.parent_frame, options.child_frame});
}

/// A row of load_poses(); its number takes the place of a time.
void read_untimed_row(const TextRowReader& rows, std::size_t width, std::vector<TimedPose>& poses) {
  const auto t_ns = static_cast<std::int64_t>(poses.size());
  if (width == kKitti) return read_matrix_row(rows, t_ns, poses);
  require_count(rows, width, "");
  const auto number = [&](std::size_t i) { return rows.number(rows.words()[i]); };
  TimedPose pose{.t_ns = t_ns,
                 .position_m = {number(0), number(1), number(2)},
                 .orientation = Eigen::Quaterniond::Identity()};
  if (width == 4) {
    const SineCosine half = sincos_turns(number(3) / 720.0);
    pose.orientation = Eigen::Quaterniond(half.cosine, 0.0, 0.0, half.sine);
  }
  if (width == 7) pose.orientation = Eigen::Quaterniond(number(6), number(3), number(4), number(5));
  append(rows, pose, {rows.words()[0], rows.words()[0], rows.words()[width > 3 ? 3 : 0]}, poses);
}

/// Whether a row has the names of the columns of load_poses().
bool is_header(const TextRowReader& rows) {
  constexpr std::array<std::string_view, 7> kColumns = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  const std::vector<Word>& words = rows.words();
  if (words.size() == 4 && words[3].text == "yaw_deg" && words[0].text == "x") return true;
  return words.size() <= kColumns.size() &&
         std::equal(words.begin(), words.end(), kColumns.begin(),
                    [](const Word& word, std::string_view name) { return word.text == name; });
}

/// The poses were checked; only their spline may not exist.
TimedPoses interpolated(std::vector<TimedPose> poses, Interpolation interpolation,
                        const std::string& file) {
  try {
    return TimedPoses(std::move(poses), interpolation);
  } catch (const Error& error) {
    ErrorParts parts = error.parts();
    parts.where = file + ", " + parts.where;
    throw Error(parts);
  }
}

}  // namespace

TimedPoses load_trajectory_file(const std::filesystem::path& path,
                                const TrajectoryFileOptions& options) {
  const std::string file = path.string();
  if (options.rate_hz && !(*options.rate_hz >= 0.01 && *options.rate_hz <= 1e9)) {
    throw Error(
        {file, "a rate of " + std::to_string(*options.rate_hz) + " Hz", "from 0.01 to 1e9 Hz"});
  }
  std::vector<TimedPose> poses =
      bags::is_bag_path(path) ? read_bag(path, options) : read_text(path, options);
  if (poses.empty()) throw Error({file, "no pose", "at least one", "see docs/files.md"});
  TimedPoses timed = interpolated(std::move(poses), options.interpolation, file);
  if (options.start_ns) timed.shift_times(timed.first_ns(), *options.start_ns);
  return timed;
}

std::vector<Pose> load_poses(const std::filesystem::path& path) {
  const std::string content = read_text_file(path, file_kind());
  TextRowReader rows(path.string(), content);
  std::vector<TimedPose> read;
  std::size_t width = 0;
  while (rows.next()) {
    const bool is_first = width == 0;
    if (is_first) width = rows.words().size();
    if (is_first && width != 3 && width != 4 && width != 7 && width != kKitti) {
      rows.reject(rows.words()[0], std::to_string(width) + " columns",
                  "3 (x y z), 4 (x y z yaw_deg), 7 (x y z qx qy qz qw) or 12 (a matrix)");
    }
    if (!is_first || !is_header(rows)) read_untimed_row(rows, width, read);
  }
  if (read.empty()) throw Error({path.string(), "no pose", "at least one", ""});
  std::vector<Pose> poses;
  poses.reserve(read.size());
  for (const TimedPose& pose : read) poses.push_back(make_pose(pose.position_m, pose.orientation));
  return poses;
}

}  // namespace glidar
