// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/formats/file_sink.hpp>
#include <glidar/io/formats/line_file.hpp>
#include <glidar/link/lockstep.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A recording contains everything that the frames of a stream depend on, one line of JSON per
/// frame.
namespace glidar::link {

/// An input file of the stream.
struct RecordedFile {
  std::string path;  ///< relative to the command's folder
  std::string hash;  ///< of its content; empty: not readable
};

/// The first line of a recording.
struct RecordingHead {
  std::string version;    ///< of the program
  CommandRecord command;  ///< with an absolute folder
  std::vector<RecordedFile> files = {};
};

/// The line of a frame. Poses are stored as matrices, so that they stay bit-identical.
struct RecordedFrame {
  std::uint32_t sensor = 0;      ///< index among the sensors that measure
  lockstep::Moment moment = {};  ///< its bodies are used if is_placed
  bool is_placed = false;        ///< poses from the bodies; else from the command's motion
  std::string frame_hash;        ///< hash of the frame's reported values
};

/// Whether a finished recording is synchronised to the disk.
enum class Durability : std::uint8_t { none, synced };

/// Writes a recording, which gets its name when it is complete.
class RecordingWriter {
 public:
  /// Throws Error if the file cannot be created.
  explicit RecordingWriter(const std::filesystem::path& path) : file_(path) {}
  /// Once, before the first frame.
  void begin(const RecordingHead& head);
  void write(const RecordedFrame& frame);
  /// Once, after the last frame. If durable, the file survives a power failure from then on, and
  /// Error is thrown also if the disk does not confirm it.
  void commit(Durability durability = Durability::none);

 private:
  AtomicFile file_;
  std::uint64_t frames_ = 0;
};

/// Reads a recording line by line. Throws Error with the number of an invalid line.
class RecordingReader {
 public:
  explicit RecordingReader(const std::filesystem::path& path);
  [[nodiscard]] const RecordingHead& head() const { return head_; }
  /// The next frame; empty at the end.
  std::optional<RecordedFrame> next();

 private:
  [[nodiscard]] std::string where() const;
  bool read_line(std::string& line);

  std::filesystem::path path_;
  LineFile file_;
  std::uint64_t line_ = 0;
  std::uint64_t frames_ = 0;  ///< read so far
  RecordingHead head_;
};

}  // namespace glidar::link
