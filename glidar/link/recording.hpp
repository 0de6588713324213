// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/line_file.hpp>
#include <glidar/link/lockstep/messages.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A recording keeps all that the frames of a stream depend on, one line of JSON each; docs/link.md
/// tells every key.
namespace glidar::link {

/// A file that the stream was made from.
struct RecordedFile {
  std::string path;  ///< as seen from the command's folder
  std::string hash;  ///< of its content; empty: it could not be read
};

/// The first line.
struct RecordingHead {
  std::string version;    ///< of the program
  CommandRecord command;  ///< with an absolute folder
  std::vector<RecordedFile> files = {};
};

/// A line for each frame. Poses are kept as matrices, whose every bit counts.
struct RecordedFrame {
  std::uint32_t sensor = 0;      ///< place among those that measured
  lockstep::Moment moment = {};  ///< its bodies count where the frame was placed
  bool is_placed = false;  ///< by bodies; else by the command's motion at the time of its number
  std::string frame_hash;  ///< of what the frame reports
};

/// Whether a finished recording is synced to the disk.
enum class Durability : std::uint8_t { none, synced };

/// Writes a recording; it appears under its name when it is whole.
class RecordingWriter {
 public:
  /// Throws Error when no file can be made there.
  explicit RecordingWriter(const std::filesystem::path& path) : file_(path) {}
  /// Once, before the first frame.
  void begin(const RecordingHead& head);
  void write(const RecordedFrame& frame);
  /// Once, after the last frame. Durably: the file survives a loss of power from then on, and an
  /// Error is thrown also when the disk does not confirm that.
  void commit(Durability durability = Durability::none);

 private:
  AtomicFile file_;
  std::uint64_t frames_ = 0;
};

/// Reads a recording line by line. Throws Error naming the line when it is not what it should be.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  [[nodiscard]] const RecordingHead& head() const { return head_; }
  /// The next frame; nothing: there is no more.
  std::optional<RecordedFrame> next();

 private:
  [[nodiscard]] std::string where() const;
  bool take_line(std::string& line);

  std::filesystem::path path_;
  LineFile file_;
  std::uint64_t line_ = 0;
  std::uint64_t frames_ = 0;  ///< read so far
  RecordingHead head_;
};

}  // namespace glidar::link
